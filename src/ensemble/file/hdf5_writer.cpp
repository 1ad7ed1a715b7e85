// hdf5_writer.cpp: lays an ensemble file out by HDF5.
#include "ensemble/file/hdf5_writer.h"

#include <hdf5.h>

#include <array>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "compare/template_mapping.h"

namespace espdiff {
namespace {

/// An HDF5 identifier, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close_by)(hid_t), const std::string& path, const char* what)
      : id_(id), close_(close_by), path_(path) {
    if (id < 0)
      throw FormatError(path, 0, std::string(what) + " is missing or damaged" + kBeginAnew + switched_on("overwrite"));
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
  const std::vector<WrittenDataset>& written() const { return written_; }

 private:
  hid_t file_;
  std::string path_;
  mutable std::vector<WrittenDataset> written_;
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

}  // namespace

std::vector<WrittenDataset> write_by_hdf5(const std::string& place, const std::string& path, const EnsembleHead& head) {
  be_silent();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "a property");
  // The index of the chunks goes before the chunks, so that a file that lost its end can still be opened.
  H5Pset_meta_block_size(access, (hsize_t{1} << 20) + 256 * head.n_frames);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, false, true);  // the file is locked by who made it
#endif
  const hid_t id = H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (id < 0) throw IoError(path, "cannot be written");
  Handle file(id, H5Fclose, path, "the file");
  const Maker make(file, path);
  make.group("/espdiff");
  make.text_attribute("/espdiff", "written_by", std::string("espdiff ") + kVersion);
  make.dataset("/espdiff/plan", H5T_STD_U8LE, {head.plan.size()}, head.plan.data());
  make.dataset("/espdiff/normals", H5T_IEEE_F32LE, {head.surface.normals.size(), 3}, head.surface.normals.data());
  make.dataset("/espdiff/residue", H5T_STD_I32LE, head.surface.residue);
  make_surface(make, head.surface, head.n_frames);
  // Not written yet, they read as zeros.
  make.dataset("/espdiff/frame_checksums", H5T_STD_U64LE, {head.n_frames}, nullptr);
  make.dataset("/espdiff/frame_numbers", H5T_IEEE_F64LE, {head.n_frames, head.columns.size()}, nullptr);
  make.dataset("/espdiff/frame_notes", H5T_STD_U8LE, {head.n_frames, kNoteBytes}, nullptr);
  const std::vector<std::uint64_t> sums = {head.checksum, 0};
  make.dataset(kHeadChecksum, H5T_STD_U64LE, sums);
  std::string names;
  for (const std::string& column : head.columns) names += (names.empty() ? "" : " ") + column;
  make.text_attribute("/espdiff/frame_numbers", "columns", names);
  const hsize_t n = head.surface.positions.size();
  make.dataset(kTrustedVertices, H5T_STD_U8LE, {n * head.n_frames}, nullptr,
               n);  // before the values: an end that is lost costs few
  make.dataset("/VTKHDF/PointData/potential", H5T_IEEE_F32LE, {n * head.n_frames}, nullptr, n);
  make.text_attribute("/VTKHDF/PointData/potential", "unit", head.unit);
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) throw not_written(path);
  file.close();
  return make.written();
}

std::string hdf5_problem() { return {}; }

}  // namespace espdiff
