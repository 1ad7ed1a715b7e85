// molfile_bridge.cpp: the functions that VMD calls, and their registration for each version of the interface.
#include "molfile_bridge.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "boundary.h"
#include "io/grids/grid_checks.h"
#include "io/grids/read_dx.h"
#include "molfile_vti.h"

namespace espdiff {
namespace {

using molfile::kError;
using molfile::kSuccess;

std::atomic<int>& accepted_version() {
  static std::atomic<int> version{0};
  return version;
}

/// The file types of one version. VMD keeps pointers into it, and sets each plugin's print_to_console.
template <int Version>
struct FileTypes {
  molfile::Plugin<Version> writer, map_reader, vti_reader;

  FileTypes();
  static FileTypes& instance() {
    static FileTypes types;
    return types;
  }
};

/// VMD shows the reason of a refused file nowhere else.
template <int Version>
void say(const molfile::Plugin<Version>& plugin, const Failure& failure) {
  const std::string line = "espdiff) " + failure.message.plain() + "\n";
  constexpr int kErrorLevel = 3;  // of VMD's console
  if (plugin.timesteps.print_to_console != nullptr) {
    plugin.timesteps.print_to_console(kErrorLevel, line.c_str());
  } else {
    std::fputs(line.c_str(), stderr);
  }
}

std::string text_or_empty(const char* text) { return text != nullptr ? text : ""; }

// Writing: the handle is a name in a list that only grows, since VMD does not always close a file.

struct WriteNames {
  std::mutex mutex;
  std::map<std::string, std::string> names;

  static WriteNames& instance() {
    static WriteNames the_names;
    return the_names;
  }
  std::string* open(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex);
    return &names.emplace(name, name).first->second;
  }
};

template <int Version>
void* open_for_writing(const char* path, const char*, int) {
  return boundary(
      [&]() -> void* {
        const std::string name = text_or_empty(path);
        take_volume(name);
        return WriteNames::instance().open(name);
      },
      [](const Failure& failure) -> void* {
        say(FileTypes<Version>::instance().writer, failure);
        return nullptr;
      });
}

template <int Version>
Grid grid_of(const molfile::Volume<Version>& metadata, const float* values, const std::string& shown) {
  Grid grid;
  grid.name = shown;
  Lattice& lattice = grid.lattice;
  lattice.size = check_counts({metadata.xsize, metadata.ysize, metadata.zsize}, shown, 0);
  lattice.origin = {metadata.origin[0], metadata.origin[1], metadata.origin[2]};
  const float* const edges[] = {metadata.xaxis, metadata.yaxis, metadata.zaxis};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3d edge{edges[axis][0], edges[axis][1], edges[axis][2]};
    lattice.step[axis] = 1.0 / (lattice.size[axis] - 1) * edge;
  }
  check_axes(lattice, shown, 0);
  allocate_values(grid);
  std::copy_n(values, grid.values.size(), grid.values.data());
  return grid;
}

template <int Version>
int write_volume(void* handle, molfile::Volume<Version>* metadata, float* values, float*) {
  return boundary(
      [&] {
        if (handle == nullptr) throw InputError("VMD wrote a volume without opening a name; nothing was kept");
        const std::string& name = *static_cast<const std::string*>(handle);
        if (metadata == nullptr || values == nullptr) {
          throw InputError("volume '" + name + "': VMD gave no values; load the volume again");
        }
        const std::string dataname(metadata->dataname, strnlen(metadata->dataname, sizeof metadata->dataname));
        Grid grid = grid_of(*metadata, values, dataname.empty() ? "volume '" + name + "'" : dataname);
        grid.unit = find_potential_unit(dataname);
        put_volume(name, std::move(grid), dataname);
        return kSuccess;
      },
      [](const Failure& failure) {
        say(FileTypes<Version>::instance().writer, failure);
        return kError;
      });
}

void close_written(void*) {}

// Reading: the handle owns the volumes, so that they survive their removal from the store.

template <int Version>
struct OpenVolumes {
  std::vector<std::shared_ptr<const StoredVolume>> volumes;
  std::vector<molfile::Volume<Version>> metadata;

  void add(std::shared_ptr<const StoredVolume> volume) {
    metadata.push_back(describe(*volume));
    volumes.push_back(std::move(volume));
  }

  static molfile::Volume<Version> describe(const StoredVolume& volume) {
    molfile::Volume<Version> description{};
    const std::size_t length = std::min(volume.dataname.size(), sizeof description.dataname - 1);
    std::memcpy(description.dataname, volume.dataname.data(), length);
    const Lattice& lattice = volume.grid.lattice;
    float* const edges[] = {description.xaxis, description.yaxis, description.zaxis};
    int* const sizes[] = {&description.xsize, &description.ysize, &description.zsize};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int row = static_cast<int>(axis);
      description.origin[axis] = static_cast<float>(lattice.origin[row]);
      *sizes[axis] = lattice.size[axis];
      const Vec3d edge = static_cast<double>(lattice.size[axis] - 1) * lattice.step[axis];
      for (int i = 0; i < 3; ++i) edges[axis][i] = static_cast<float>(edge[i]);
    }
    description.mark_as_scalar();
    return description;
  }
};

template <int Version>
std::unique_ptr<OpenVolumes<Version>> open_stored(const std::string& name) {
  auto volume = find_volume(name);
  if (volume == nullptr) {
    std::string there;
    for (const std::string& other : volume_names()) there += (there.empty() ? "'" : ", '") + other + "'";
    throw InputError("no volume '" + name + "' is in memory (there: " + (there.empty() ? "none" : there) +
                     "); 'espdiff map' puts one there");
  }
  auto opened = std::make_unique<OpenVolumes<Version>>();
  opened->add(std::move(volume));
  return opened;
}

template <int Version>
std::unique_ptr<OpenVolumes<Version>> open_vti(const std::string& path) {
  auto opened = std::make_unique<OpenVolumes<Version>>();
  for (StoredVolume& volume : read_vti_volumes(path)) {
    opened->add(std::make_shared<const StoredVolume>(std::move(volume)));
  }
  return opened;
}

template <int Version>
void* open_for_reading(const char* path, const char* type, int* n_atoms) {
  FileTypes<Version>& types = FileTypes<Version>::instance();
  const bool is_vti = text_or_empty(type) == kVtiReader;
  return boundary(
      [&]() -> void* {
        if (n_atoms != nullptr) *n_atoms = molfile::kNoAtoms;
        const std::string name = text_or_empty(path);
        return (is_vti ? open_vti<Version>(name) : open_stored<Version>(name)).release();
      },
      [&](const Failure& failure) -> void* {
        say(is_vti ? types.vti_reader : types.map_reader, failure);
        return nullptr;
      });
}

template <int Version>
int read_metadata(void* handle, int* n_sets, molfile::Volume<Version>** metadata) {
  if (n_sets != nullptr) *n_sets = 0;  // VMD reads only the number
  if (handle == nullptr || n_sets == nullptr || metadata == nullptr) return kError;
  auto& opened = *static_cast<OpenVolumes<Version>*>(handle);
  *n_sets = static_cast<int>(opened.metadata.size());
  *metadata = opened.metadata.data();
  return kSuccess;
}

template <int Version>
int read_values(void* handle, int set, float* values, float*) {
  if (handle == nullptr || values == nullptr) return kError;
  const auto& volumes = static_cast<const OpenVolumes<Version>*>(handle)->volumes;
  if (set < 0 || static_cast<std::size_t>(set) >= volumes.size()) return kError;
  const std::vector<float>& stored = volumes[static_cast<std::size_t>(set)]->grid.values;
  std::copy(stored.begin(), stored.end(), values);
  return kSuccess;
}

template <int Version>
void close_read(void* handle) {
  delete static_cast<OpenVolumes<Version>*>(handle);
}

template <int Version>
FileTypes<Version>::FileTypes() {
  writer.head.name = kVolumeWriter;
  writer.head.prettyname = "espdiff: volume into memory";
  writer.file.open_file_write = open_for_writing<Version>;
  writer.file.close_file_write = close_written;
  writer.other.write_volumetric_data = write_volume<Version>;

  for (auto* reader : {&map_reader, &vti_reader}) {
    reader->file.open_file_read = open_for_reading<Version>;
    reader->file.close_file_read = close_read<Version>;
    reader->file.read_volumetric_metadata = read_metadata<Version>;
    reader->file.read_volumetric_data = read_values<Version>;
  }
  map_reader.head.name = kVolumeReader;
  map_reader.head.prettyname = "espdiff: map from memory";
  vti_reader.head.name = kVtiReader;
  vti_reader.head.prettyname = "VTK image (espdiff)";
  vti_reader.file.filename_extension = "vti";

  for (auto* plugin : {&writer, &map_reader, &vti_reader}) {
    plugin->head.abiversion = Version;
    plugin->head.author = "espdiff";
    std::sscanf(kVersion, "%d.%d", &plugin->head.majorv, &plugin->head.minorv);
  }
}

/// True if VMD accepts plugins of this version. Offers one plugin first: VMD prints a warning for each refused one.
template <int Version>
bool offer(void* registrar, molfile::RegisterCallback callback) {
  auto& types = FileTypes<Version>::instance();
  if (callback(registrar, &types.writer.head) != kSuccess) return false;
  callback(registrar, &types.map_reader.head);
  callback(registrar, &types.vti_reader.head);
  accepted_version() = Version;
  return true;
}

}  // namespace

int register_plugins(void* registrar, molfile::RegisterCallback callback) noexcept {
  accepted_version() = 0;
  if (callback == nullptr) return kError;
  return boundary(
      [&] {
        const bool accepted =
            offer<18>(registrar, callback) || offer<17>(registrar, callback) || offer<16>(registrar, callback);
        return accepted ? kSuccess : kError;
      },
      [](const Failure&) { return kError; });
}

int accepted_abi() { return accepted_version(); }

}  // namespace espdiff
