// hdf5_layout.cpp: has files laid out by HDF5, and finds the parts again without it.
#include "ensemble/file/hdf5_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/error.h"
#include "compare/template_mapping.h"
#include "ensemble/file/hdf5_reader.h"
#include "ensemble/file/hdf5_writer.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

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

/// The place of a dataset of `n` elements. @throws FormatError
std::uint64_t place_of(const Hdf5Reader& reader, const std::string& path, const std::string& name, std::uint64_t n,
                       std::size_t item_bytes) {
  const Hdf5Dataset set = reader.find(name);
  if (set.n == n && set.item_bytes == item_bytes && set.chunks.empty()) return set.address;
  throw FormatError(path, 0, name + " is of another size than the frames" + kBeginAnew + switched_on("overwrite"));
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

/// What was written must be read: HDF5 does not tell of every write that fails.
void read_back(const Hdf5Reader& reader, const std::string& path, const std::vector<WrittenDataset>& written) {
  for (const WrittenDataset& set : written) {
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
        path, 0,
        std::string("an HDF5 file, but not one of `espdiff ensemble`") + kBeginAnew + switched_on("overwrite"));
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
                      std::string("the template or the description of the run in this file is damaged") + kBeginAnew +
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
                      values.name + " is of another size than the template" + kBeginAnew + switched_on("overwrite"));
  layout.values = std::move(values.chunks);
  if (reader.has(kTrustedVertices)) {
    Hdf5Dataset trusted = reader.find(kTrustedVertices);
    if (trusted.item_bytes != 1 || trusted.chunk_items != layout.n_vertices || trusted.chunks.size() != layout.n_frames)
      throw FormatError(path, 0,
                        trusted.name + " is of another size than the template" + kBeginAnew + switched_on("overwrite"));
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
  const std::uint64_t head =
      head_checksum(plan, surface.positions, surface.normals, surface.triangles, surface.residue);
  const std::vector<WrittenDataset> written =
      write_by_hdf5(place, path, {plan, surface, unit, n_frames, frame_columns(), head});
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
                      std::string("something besides the frames was changed in this file, or is damaged") + kBeginAnew +
                          switched_on("overwrite"));
  return contents;
}

void check_ensemble_head(const OpenFile& file, const std::string& path) { read_head({file, path}, path); }

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
