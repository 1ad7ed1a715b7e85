// hdf5_layout.cpp: lays files out by HDF5, and finds the parts again without it.
#include "ensemble/file/hdf5_layout.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "compare/template_mapping.h"
#include "ensemble/file/hdf5_reader.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

/// Two: of plan and template, and of every byte but the frames'.
constexpr const char* kHeadChecksum = "/espdiff/head_checksum";
constexpr const char* kTrusted = "/VTKHDF/PointData/trusted";
constexpr const char* kRemedy = "; begin anew with another output, or with ";

IoError not_written(const std::string& path) { return {path, "cannot be written; is the disk full?"}; }

/// An HDF5 identifier, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close_by)(hid_t), const std::string& path, const char* what)
      : id_(id), close_(close_by), path_(path) {
    if (id < 0)
      throw FormatError(path, 0, std::string(what) + " is missing or damaged" + kRemedy + switched_on("overwrite"));
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  /// What HDF5 kept back is written now. @throws IoError
  void close() {
    if (close_(std::exchange(id_, H5I_INVALID_HID)) < 0) throw not_written(path_);
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
  const std::string& path_;
};

/// HDF5 prints errors unless told not to, and ours name what matters. At the process' end it closes once more what it
/// could not close on a full disk, and crashes.
void be_silent() {
  static const herr_t no_cleanup = H5dont_atexit();
  static_cast<void>(no_cleanup);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Of everything that is written once.
std::uint64_t head_checksum(const std::string& plan, const std::vector<Vec3d>& positions,
                            const std::vector<Vec3f>& normals, const std::vector<Triangle>& triangles,
                            const std::vector<std::int32_t>& residue) {
  std::uint64_t sum = kChecksumStart;
  sum = add_to_checksum(sum, plan.data(), plan.size());
  sum = add_to_checksum(sum, positions.data(), positions.size() * sizeof(Vec3d));
  sum = add_to_checksum(sum, normals.data(), normals.size() * sizeof(Vec3f));
  sum = add_to_checksum(sum, triangles.data(), triangles.size() * sizeof(Triangle));
  return add_to_checksum(sum, residue.data(), residue.size() * sizeof(std::int32_t));
}

/// A dataset as it should be in the file.
struct Written {
  std::string name;
  std::uint64_t checksum;
};

/// Writes one file.
class Maker {
 public:
  Maker(hid_t file, std::string path) : file_(file), path_(std::move(path)) {}

  void group(const std::string& name) const {
    const Handle options(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, path_, "a property");
    H5Pset_obj_track_times(options, 0);
    Handle made(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, options, H5P_DEFAULT), H5Gclose, path_, "a group");
    made.close();
  }

  /// @param values null reserves the space only; chunk 0: contiguous
  void dataset(const std::string& name, hid_t type, const std::vector<hsize_t>& size, const void* values,
               hsize_t chunk = 0) const {
    const Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path_, "a property");
    H5Pset_obj_track_times(options, 0);
    H5Pset_alloc_time(options, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(options, H5D_FILL_TIME_NEVER);
    if (chunk > 0) H5Pset_chunk(options, 1, &chunk);
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, path_,
                       "a size");
    Handle made(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose, path_,
                name.c_str());
    if (values != nullptr && H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) throw not_written(path_);
    made.close();
    if (values == nullptr) return;
    std::uint64_t n_items = 1;
    for (const hsize_t n : size) n_items *= n;
    if (n_items > 0) written_.push_back({name, add_to_checksum(kChecksumStart, values, n_items * H5Tget_size(type))});
  }

  template <typename T>
  void dataset(const std::string& name, hid_t type, const std::vector<T>& values) const {
    dataset(name, type, {values.size()}, values.data());
  }

  void attribute(const std::string& object, const char* name, hid_t type, hsize_t n, const void* value) const {
    const Handle at(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose, path_, object.c_str());
    const Handle space(n == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, nullptr), H5Sclose, path_, "a size");
    Handle made(H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path_, name);
    if (H5Awrite(made, type, value) < 0) throw not_written(path_);
    made.close();
  }
  void text_attribute(const std::string& object, const char* name, const std::string& text) const {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, path_, "a type");
    H5Tset_size(type, text.size());
    attribute(object, name, type, 0, text.data());
  }
  /// The datasets with values so far.
  const std::vector<Written>& written() const { return written_; }

 private:
  hid_t file_;
  std::string path_;
  mutable std::vector<Written> written_;
};

/// The four kinds of cells of VTK's PolyData, of which only polygons are there.
void make_cells(const Maker& make, const std::vector<Triangle>& triangles) {
  for (const char* kind : {"Vertices", "Lines", "Strips", "Polygons"}) {
    const std::string group = std::string("/VTKHDF/") + kind + "/";
    make.group(group.substr(0, group.size() - 1));
    std::vector<std::int64_t> connectivity, offsets = {0};
    if (std::strcmp(kind, "Polygons") == 0) {
      for (const Triangle& t : triangles) {
        connectivity.insert(connectivity.end(), t.begin(), t.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
    }
    const std::vector<std::int64_t> n_ids = {static_cast<std::int64_t>(connectivity.size())},
                                    n_cells = {static_cast<std::int64_t>(offsets.size()) - 1};
    make.dataset(group + "NumberOfConnectivityIds", H5T_STD_I64LE, n_ids);
    make.dataset(group + "NumberOfCells", H5T_STD_I64LE, n_cells);
    make.dataset(group + "Connectivity", H5T_STD_I64LE, connectivity);
    make.dataset(group + "Offsets", H5T_STD_I64LE, offsets);
  }
}

/// Every step has the same surface, and its own stretch of the values.
void make_steps(const Maker& make, std::size_t n_frames, std::size_t n_vertices) {
  make.group("/VTKHDF/Steps");
  const auto n = static_cast<std::int64_t>(n_frames);
  make.attribute("/VTKHDF/Steps", "NSteps", H5T_STD_I64LE, 0, &n);
  std::vector<double> times;
  std::vector<std::int64_t> offsets;
  for (std::size_t f = 0; f < n_frames; ++f) {
    times.push_back(static_cast<double>(f));
    offsets.push_back(static_cast<std::int64_t>(f * n_vertices));
  }
  const std::vector<std::int64_t> zeros(n_frames, 0), ones(n_frames, 1), four(4 * n_frames, 0);
  make.dataset("/VTKHDF/Steps/Values", H5T_IEEE_F64LE, times);
  make.dataset("/VTKHDF/Steps/PartOffsets", H5T_STD_I64LE, zeros);
  make.dataset("/VTKHDF/Steps/NumberOfParts", H5T_STD_I64LE, ones);
  make.dataset("/VTKHDF/Steps/PointOffsets", H5T_STD_I64LE, zeros);
  make.dataset("/VTKHDF/Steps/CellOffsets", H5T_STD_I64LE, {n_frames, 4}, four.data());
  make.dataset("/VTKHDF/Steps/ConnectivityIdOffsets", H5T_STD_I64LE, {n_frames, 4}, four.data());
  make.group("/VTKHDF/Steps/PointDataOffsets");
  for (const char* name : {"potential", "trusted"})
    make.dataset(std::string("/VTKHDF/Steps/PointDataOffsets/") + name, H5T_STD_I64LE, offsets);
}

void make_surface(const Maker& make, const TemplateSurface& surface, std::size_t n_frames) {
  make.group("/VTKHDF");
  make.text_attribute("/VTKHDF", "Type", "PolyData");
  const std::array<std::int64_t, 2> version = {2, 0};
  make.attribute("/VTKHDF", "Version", H5T_STD_I64LE, 2, version.data());
  const std::size_t n = surface.positions.size();
  make.dataset("/VTKHDF/NumberOfPoints", H5T_STD_I64LE, std::vector<std::int64_t>{static_cast<std::int64_t>(n)});
  make.dataset("/VTKHDF/Points", H5T_IEEE_F64LE, {n, 3}, surface.positions.data());
  make_cells(make, surface.triangles);
  make_steps(make, n_frames, n);
  make.group("/VTKHDF/PointData");
}

/// The place of a dataset of `n` elements. @throws FormatError
std::uint64_t place_of(const Hdf5Reader& reader, const std::string& path, const std::string& name, std::uint64_t n,
                       std::size_t item_bytes) {
  const Hdf5Dataset set = reader.find(name);
  if (set.n == n && set.item_bytes == item_bytes && set.chunks.empty()) return set.address;
  throw FormatError(path, 0, name + " is of another size than the frames" + kRemedy + switched_on("overwrite"));
}

std::vector<Triangle> read_triangles(const Hdf5Reader& reader) {
  using Corners = std::array<std::int64_t, 3>;
  std::vector<Triangle> triangles;
  for (const Corners& t : reader.read<Corners>("/VTKHDF/Polygons/Connectivity", 'i', 3))
    triangles.push_back(
        {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
  return triangles;
}

/// Whether the template's parts fit each other: a checksum says that they are whole, not that they are ours.
bool holds_together(const EnsembleContents& contents) {
  const std::size_t n = contents.positions.size();
  const auto is_finite = [](const Vec3d& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  return contents.normals.size() == n && contents.residue.size() == n &&
         std::all_of(contents.triangles.begin(), contents.triangles.end(),
                     [n](const Triangle& t) { return t[0] < n && t[1] < n && t[2] < n; }) &&
         std::all_of(contents.positions.begin(), contents.positions.end(), is_finite);
}

}  // namespace

const std::vector<std::string>& frame_columns() {
  static const std::vector<std::string> columns = {"rmsd_A",     "unmatched_template",         "unmatched_frame",
                                                   "distance_A", "same_residue_area_fraction", "mean_potential",
                                                   "trustworthy"};
  return columns;
}

namespace {

/// @returns the datasets to find again
std::vector<Written> make_by_hdf5(const std::string& place, const std::string& path, const std::string& plan,
                                  const TemplateSurface& surface, const std::string& unit, std::size_t n_frames) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "a property");
  // The index of the chunks goes before the chunks, so that a file that lost its end can still be opened.
  H5Pset_meta_block_size(access, (hsize_t{1} << 20) + 256 * n_frames);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, false, true);  // the file is locked by who made it
#endif
  const hid_t id = H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (id < 0) throw IoError(path, "cannot be written");
  Handle file(id, H5Fclose, path, "the file");
  const Maker make(file, path);
  make.group("/espdiff");
  make.text_attribute("/espdiff", "written_by", std::string("espdiff ") + kVersion);
  make.dataset("/espdiff/plan", H5T_STD_U8LE, {plan.size()}, plan.data());
  make.dataset("/espdiff/normals", H5T_IEEE_F32LE, {surface.normals.size(), 3}, surface.normals.data());
  make.dataset("/espdiff/residue", H5T_STD_I32LE, surface.residue);
  make_surface(make, surface, n_frames);
  // Not written yet, they read as zeros.
  make.dataset("/espdiff/frame_checksums", H5T_STD_U64LE, {n_frames}, nullptr);
  make.dataset("/espdiff/frame_numbers", H5T_IEEE_F64LE, {n_frames, frame_columns().size()}, nullptr);
  make.dataset("/espdiff/frame_notes", H5T_STD_U8LE, {n_frames, kNoteBytes}, nullptr);
  const std::vector<std::uint64_t> sums = {
      head_checksum(plan, surface.positions, surface.normals, surface.triangles, surface.residue), 0};
  make.dataset(kHeadChecksum, H5T_STD_U64LE, sums);
  std::string names;
  for (const std::string& column : frame_columns()) names += (names.empty() ? "" : " ") + column;
  make.text_attribute("/espdiff/frame_numbers", "columns", names);
  const hsize_t n = surface.positions.size();
  make.dataset(kTrusted, H5T_STD_U8LE, {n * n_frames}, nullptr, n);  // before the values: an end that is lost costs few
  make.dataset("/VTKHDF/PointData/potential", H5T_IEEE_F32LE, {n * n_frames}, nullptr, n);
  make.text_attribute("/VTKHDF/PointData/potential", "unit", unit);
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) throw not_written(path);
  file.close();
  return make.written();
}

/// What was written must be read: HDF5 does not tell of every write that fails.
void read_back(const Hdf5Reader& reader, const std::string& path, const std::vector<Written>& written) {
  for (const Written& set : written) {
    const std::vector<char> bytes = reader.bytes_of(set.name);
    if (add_to_checksum(kChecksumStart, bytes.data(), bytes.size()) != set.checksum) throw not_written(path);
  }
}

/// Of all that is written once: every byte but those of the frames, and of this checksum.
std::uint64_t structure_checksum(const OpenFile& file, const std::string& path, const EnsembleLayout& layout,
                                 const Hdf5Dataset& own_place) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> left_out = {
      {layout.numbers, layout.n_frames * frame_columns().size() * sizeof(double)},
      {layout.notes, layout.n_frames * kNoteBytes},
      {layout.checksums, layout.n_frames * sizeof(std::uint64_t)},
      {own_place.address, own_place.n * sizeof(std::uint64_t)}};
  for (const std::uint64_t values : layout.values) left_out.emplace_back(values, layout.n_vertices * sizeof(float));
  for (const std::uint64_t trusted : layout.trusted) left_out.emplace_back(trusted, layout.n_vertices);
  left_out.emplace_back(file.size(), 0);
  std::sort(left_out.begin(), left_out.end());
  std::uint64_t sum = kChecksumStart, at = 0;
  std::vector<char> bytes(std::size_t{1} << 16);
  for (const auto& [begin, n] : left_out) {
    while (at < begin) {
      const std::size_t part = std::min<std::uint64_t>(bytes.size(), begin - at);
      read_file_at(file, path, at, bytes.data(), part);
      // Most of it is space that HDF5 reserved.
      const bool is_empty = bytes[0] == 0 && std::memcmp(bytes.data(), bytes.data() + 1, part - 1) == 0;
      sum = is_empty ? add_to_checksum(sum, &part, sizeof part) : add_to_checksum(sum, bytes.data(), part);
      at += part;
    }
    at = std::max(at, begin + n);
  }
  return sum;
}

/// The description of the run and the template, which stand before the frames.
EnsembleContents read_head(const Hdf5Reader& reader, const std::string& path) {
  if (!reader.has("/espdiff"))
    throw FormatError(
        path, 0, std::string("an HDF5 file, but not one of `espdiff ensemble`") + kRemedy + switched_on("overwrite"));
  EnsembleContents contents;
  const auto plan = reader.read<char>("/espdiff/plan", 'u');
  contents.plan.assign(plan.begin(), plan.end());
  contents.positions = reader.read<Vec3d>("/VTKHDF/Points", 'f', 3);
  contents.normals = reader.read<Vec3f>("/espdiff/normals", 'f', 3);
  contents.residue = reader.read<std::int32_t>("/espdiff/residue", 'i');
  contents.triangles = read_triangles(reader);
  const auto sum = reader.read<std::uint64_t>(kHeadChecksum, 'u');
  if (sum.empty() || sum.size() > 2 || !holds_together(contents) ||
      sum[0] !=
          head_checksum(contents.plan, contents.positions, contents.normals, contents.triangles, contents.residue))
    throw FormatError(path, 0,
                      std::string("the template or the description of the run in this file is damaged") + kRemedy +
                          switched_on("overwrite"));
  return contents;
}

EnsembleContents read_contents(const OpenFile& file, const std::string& path) {
  const Hdf5Reader reader(file, path);
  EnsembleContents contents = read_head(reader, path);
  EnsembleLayout& layout = contents.layout;
  layout.n_vertices = contents.positions.size();
  Hdf5Dataset values = reader.find("/VTKHDF/PointData/potential");
  layout.n_frames = values.chunks.size();
  if (values.kind != 'f' || values.item_bytes != sizeof(float) || values.chunk_items != layout.n_vertices)
    throw FormatError(path, 0,
                      values.name + " is of another size than the template" + kRemedy + switched_on("overwrite"));
  layout.values = std::move(values.chunks);
  if (reader.has(kTrusted)) {
    Hdf5Dataset trusted = reader.find(kTrusted);
    if (trusted.item_bytes != 1 || trusted.chunk_items != layout.n_vertices || trusted.chunks.size() != layout.n_frames)
      throw FormatError(path, 0,
                        trusted.name + " is of another size than the template" + kRemedy + switched_on("overwrite"));
    layout.trusted = std::move(trusted.chunks);
  }
  layout.checksums = place_of(reader, path, "/espdiff/frame_checksums", layout.n_frames, sizeof(std::uint64_t));
  layout.numbers =
      place_of(reader, path, "/espdiff/frame_numbers", layout.n_frames * frame_columns().size(), sizeof(double));
  layout.notes = place_of(reader, path, "/espdiff/frame_notes", layout.n_frames * kNoteBytes, 1);
  return contents;
}

}  // namespace

void make_hdf5_file(OpenFile& file, const std::string& place, const std::string& path, const std::string& plan,
                    const TemplateSurface& surface, const std::string& unit, std::size_t n_frames) {
  be_silent();
  const std::vector<Written> written = make_by_hdf5(place, path, plan, surface, unit, n_frames);
  const Hdf5Reader reader(file, path);
  read_back(reader, path, written);
  const EnsembleContents contents = read_contents(file, path);
  const Hdf5Dataset sums = reader.find(kHeadChecksum);
  const std::uint64_t sum = structure_checksum(file, path, contents.layout, sums);
  if (file.write_at(sums.address + sizeof sum, &sum, sizeof sum) != 0) throw not_written(path);
}

EnsembleContents open_hdf5_file(const OpenFile& file, const std::string& path) {
  EnsembleContents contents = read_contents(file, path);
  const Hdf5Reader reader(file, path);
  const auto sums = reader.read<std::uint64_t>(kHeadChecksum, 'u');
  // Files of earlier versions have the first one only.
  if (sums.size() == 2 && sums[1] != structure_checksum(file, path, contents.layout, reader.find(kHeadChecksum)))
    throw FormatError(path, 0,
                      std::string("something besides the frames was changed in this file, or is damaged") + kRemedy +
                          switched_on("overwrite"));
  return contents;
}

void check_ensemble_head(const OpenFile& file, const std::string& path) { read_head({file, path}, path); }

std::uint64_t add_to_checksum(std::uint64_t sum, const void* bytes, std::size_t n) {
  const auto* const b = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < n; i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, b + i, std::min<std::size_t>(4, n - i));
    sum = (sum ^ word) * 0x100000001b3ULL;
  }
  return sum;
}

std::uint64_t intended_size(const std::string& path) {
  // HDF5 file format specification, superblock version 0 with offsets of 8 bytes: the end of file is at byte 40.
  std::array<unsigned char, 48> head{};
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(head.data()), head.size())) return 0;
  if (std::memcmp(head.data(), "\x89HDF\r\n\x1a\n", 8) != 0 || head[8] != 0 || head[13] != 8) return 0;
  std::uint64_t size = 0;
  std::memcpy(&size, head.data() + 40, sizeof size);
  return size;
}

}  // namespace espdiff
