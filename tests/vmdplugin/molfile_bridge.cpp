// molfile_bridge.cpp: registration, volumes through memory in every version of the interface, and what is refused.
#include "vmdplugin/bridge/molfile_bridge.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "fake_vmd.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

template <int Version>
molfile::Volume<Version> some_volume() {
  molfile::Volume<Version> volume;
  std::memset(&volume, 0x55, sizeof volume);  // VMD leaves the flags as they are in memory
  std::strcpy(volume.dataname, "pme.dx : PME potential (kT/e, T=300K)");
  const float origin[] = {-1.5F, 2.25F, 3}, x[] = {6, 0, 0}, y[] = {1, 4, 0}, z[] = {0, 0.5F, 2};
  std::copy_n(origin, 3, volume.origin);
  std::copy_n(x, 3, volume.xaxis);
  std::copy_n(y, 3, volume.yaxis);
  std::copy_n(z, 3, volume.zaxis);
  volume.xsize = 4;
  volume.ysize = 3;
  volume.zsize = 2;
  return volume;
}

std::vector<float> some_values() {
  std::vector<float> values(24);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<float>(i)) * 1e-3F;
  values[5] = std::numeric_limits<float>::quiet_NaN();
  values[6] = -std::numeric_limits<float>::infinity();
  values[7] = std::numeric_limits<float>::denorm_min();
  return values;
}

template <int Version>
int write(const char* name, molfile::Volume<Version>* volume, std::vector<float> values) {
  auto& writer = plugin_named<Version>(kVolumeWriter);
  void* const handle = writer.file.open_file_write(name, kVolumeWriter, 0);
  REQUIRE(handle != nullptr);
  return writer.other.write_volumetric_data(handle, volume, values.empty() ? nullptr : values.data(), nullptr);
}

/// Writes and reads back as VMD does.
template <int Version>
void check_round_trip() {
  CAPTURE(Version);
  auto volume = some_volume<Version>();
  const std::vector<float> values = some_values();
  REQUIRE(write<Version>("w", &volume, values) == molfile::kSuccess);

  const auto description = describe_volume("w");
  REQUIRE(description);
  CHECK(description->dataname == "pme.dx : PME potential (kT/e, T=300K)");
  CHECK(description->unit == PotentialUnit::kKtPerE);
  CHECK(description->lattice.size == std::array<int, 3>{4, 3, 2});
  CHECK(description->lattice.origin == Vec3d{-1.5, 2.25, 3});
  CHECK(description->lattice.step[0] == Vec3d{2, 0, 0});
  CHECK(description->lattice.step[1] == Vec3d{0.5, 2, 0});
  CHECK(description->lattice.step[2] == Vec3d{0, 0.5, 2});

  auto& reader = plugin_named<Version>(kVolumeReader);
  int n_atoms = -7;
  void* const handle = reader.file.open_file_read("w", kVolumeReader, &n_atoms);
  REQUIRE(handle != nullptr);
  CHECK(n_atoms == 0);
  const auto grid = take_volume("w");  // before VMD has read it
  REQUIRE(grid);
  CHECK(same_bytes(grid->values, values));
  CHECK(grid->unit == PotentialUnit::kKtPerE);

  int n_sets = 0;
  molfile::Volume<Version>* metadata = nullptr;
  REQUIRE(reader.file.read_volumetric_metadata(handle, &n_sets, &metadata) == molfile::kSuccess);
  REQUIRE(n_sets == 1);
  CHECK(std::string(metadata->dataname) == volume.dataname);
  for (int i = 0; i < 3; ++i) {
    CHECK(metadata->origin[i] == volume.origin[i]);
    CHECK(metadata->xaxis[i] == volume.xaxis[i]);
    CHECK(metadata->yaxis[i] == volume.yaxis[i]);
    CHECK(metadata->zaxis[i] == volume.zaxis[i]);
  }
  CHECK(metadata->has_color == 0);
  if constexpr (Version > 16) {
    CHECK(metadata->has_scalar == 1);
    CHECK(metadata->has_gradient == 0);
    CHECK(metadata->has_variance == 0);
  }
  std::vector<float> read(24);
  CHECK(reader.file.read_volumetric_data(handle, 0, read.data(), nullptr) == molfile::kSuccess);
  CHECK(same_bytes(read, values));
  CHECK(reader.file.read_volumetric_data(handle, 1, read.data(), nullptr) == molfile::kError);
  CHECK(reader.file.read_volumetric_data(handle, -1, read.data(), nullptr) == molfile::kError);
  reader.file.close_file_read(handle);
  CHECK(printed().empty());
}

}  // namespace

TEST_CASE("register_plugins stays with the version that VMD accepts, newest first") {
  const std::size_t n_types = 3;
  for (const int version : molfile::kVersions) {
    CAPTURE(version);
    Registrar vmd{version, {}, {}};
    CHECK(register_plugins(&vmd, Registrar::take) == molfile::kSuccess);
    CHECK(accepted_abi() == version);
    CHECK(vmd.kept.size() == n_types);
    // One refusal a version, since VMD prints a warning for each.
    std::vector<int> expected;
    for (int v = 18; v > version; --v) expected.push_back(v);
    expected.insert(expected.end(), n_types, version);
    CHECK(vmd.offered == expected);
  }
  Registrar stranger{19, {}, {}};
  CHECK(register_plugins(&stranger, Registrar::take) == molfile::kError);
  CHECK(stranger.offered == std::vector<int>{18, 17, 16});
  CHECK(accepted_abi() == 0);
  CHECK(register_plugins(nullptr, nullptr) == molfile::kError);
}

TEST_CASE("no file type has a structure, to read or to write") {
  for (const char* name : {kVolumeWriter, kVolumeReader}) {
    const auto& plugin = plugin_named<18>(name);
    CHECK(plugin.head.type == std::string("mol file reader"));
    CHECK_FALSE(static_cast<bool>(plugin.file.read_structure));
    CHECK_FALSE(static_cast<bool>(plugin.file.write_structure));
    CHECK_FALSE(static_cast<bool>(plugin.file.read_next_timestep));
    CHECK(plugin.file.filename_extension == std::string());  // VMD copies it: not null
    CHECK(plugin.head.majorv + plugin.head.minorv > 0);
  }
}

TEST_CASE("a volume goes through memory and back bit for bit, in every version of the interface") {
  check_round_trip<18>();
  check_round_trip<17>();
  check_round_trip<16>();
}

TEST_CASE("a data name that fills its field, and one without a unit") {
  auto volume = some_volume<18>();
  std::memset(volume.dataname, 'n', sizeof volume.dataname);
  REQUIRE(write<18>("long", &volume, some_values()) == molfile::kSuccess);
  CHECK(describe_volume("long")->dataname == std::string(256, 'n'));
  CHECK(describe_volume("long")->unit == PotentialUnit::kUnknown);
  auto& reader = plugin_named<18>(kVolumeReader);
  int n_atoms = 0, n_sets = 0;
  void* const handle = reader.file.open_file_read("long", kVolumeReader, &n_atoms);
  molfile::Volume<18>* metadata = nullptr;
  reader.file.read_volumetric_metadata(handle, &n_sets, &metadata);
  CHECK(std::string(metadata->dataname) == std::string(255, 'n'));
  reader.file.close_file_read(handle);

  volume.dataname[0] = '\0';
  REQUIRE(write<18>("long", &volume, some_values()) == molfile::kSuccess);
  CHECK(take_volume("long")->name == "volume 'long'");
}

TEST_CASE("volumes that cannot be used are refused, and said so") {
  const auto refusal = [](auto change, std::vector<float> values = some_values()) {
    auto volume = some_volume<18>();
    change(volume);
    CHECK(write<18>("bad", &volume, std::move(values)) == molfile::kError);
    CHECK_FALSE(describe_volume("bad"));
    return printed();
  };
  const std::string shown = "espdiff) pme.dx : PME potential (kT/e, T=300K): ";
  CHECK(refusal([](auto& v) { v.ysize = 1; }) ==
        shown + "the grid has 4 x 1 x 2 points; at least 2 along each axis were expected\n");
  CHECK(refusal([](auto& v) { v.zsize = -2; }).find("4 x 3 x -2") != std::string::npos);
  CHECK(refusal([](auto& v) { v.xsize = v.ysize = v.zsize = 1 << 30; }).find("at most 2^31 - 1") != std::string::npos);
  CHECK(refusal([](auto& v) { std::fill_n(v.xaxis, 3, 0.0F); }) ==
        shown + "a grid step is zero; the three axes must have a length\n");
  CHECK(refusal([](auto& v) { std::copy_n(v.xaxis, 3, v.yaxis); }).find("lie in one plane") != std::string::npos);
  CHECK(refusal([](auto& v) { v.origin[1] = std::nanf(""); }).find("not finite") != std::string::npos);
  CHECK(refusal([](auto&) {}, {}) == "espdiff) volume 'bad': VMD gave no values; load the volume again\n");
  auto& writer = plugin_named<18>(kVolumeWriter);
  auto volume = some_volume<18>();
  std::vector<float> values = some_values();
  CHECK(writer.other.write_volumetric_data(nullptr, &volume, values.data(), nullptr) == molfile::kError);
  void* const handle = writer.file.open_file_write("bad", kVolumeWriter, 0);
  CHECK(writer.other.write_volumetric_data(handle, nullptr, values.data(), nullptr) == molfile::kError);
}

TEST_CASE("opening a name for writing removes what was there; close changes nothing") {
  put_volume("n", small_grid(1), "old");
  auto& writer = plugin_named<18>(kVolumeWriter);
  void* const handle = writer.file.open_file_write("n", kVolumeWriter, 0);
  CHECK_FALSE(describe_volume("n"));
  auto volume = some_volume<18>();
  std::vector<float> values = some_values();
  CHECK(writer.other.write_volumetric_data(handle, &volume, values.data(), nullptr) == molfile::kSuccess);
  writer.file.close_file_write(handle);
  CHECK(take_volume("n"));
  CHECK(writer.file.open_file_write(nullptr, nullptr, 0) != nullptr);  // the name ''
}

TEST_CASE("reading a name that is not there says what is") {
  auto& reader = plugin_named<18>(kVolumeReader);
  int n_atoms = 0;
  CHECK(reader.file.open_file_read("absent", kVolumeReader, &n_atoms) == nullptr);
  CHECK(printed() == "espdiff) no volume 'absent' is in memory (there: none); 'espdiff map' puts one there\n");
  put_volume("here", small_grid(1), "");
  CHECK(reader.file.open_file_read(nullptr, nullptr, nullptr) == nullptr);
  CHECK(printed() == "espdiff) no volume '' is in memory (there: 'here'); 'espdiff map' puts one there\n");
  take_volume("here");
  int n_sets = 7;
  CHECK(reader.file.read_volumetric_metadata(nullptr, &n_sets, nullptr) == molfile::kError);
  CHECK(n_sets == 0);
  CHECK(reader.file.read_volumetric_data(nullptr, 0, nullptr, nullptr) == molfile::kError);
  reader.file.close_file_read(nullptr);
}
