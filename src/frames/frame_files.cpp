// frame_files.cpp: which file a frame is in.
#include "frames/frame_files.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/frames/dcd_head.h"
#include "io/frames/xdr_frames.h"
#include "io/structures/amber_frames.h"
#include "io/structures/structure_file.h"

namespace espdiff {
FrameFiles::FrameFiles(std::vector<std::string> paths, OpenStructure open)
    : paths_(std::move(paths)), open_(std::move(open)) {
  if (paths_.empty()) throw InputError("no file of frames was given");
  first_.push_back(0);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    load(i);
    compare_with_size(paths_[i], file_->n_models());
    first_.push_back(first_.back() + file_->n_models());
    sha256_.push_back(file_->sha256());
  }
}

/// Readers take a DCD, XTC, TRR or NetCDF trajectory that was cut off for a whole one.
void FrameFiles::compare_with_size(const std::string& path, int n_read) {
  std::int64_t n_whole = 0;
  std::string missing;
  if (const std::optional<DcdHead> head = read_dcd_head(path)) {
    n_whole = head->n_whole;
    missing = head->missing();
  } else if (const std::optional<XdrFrames> frames = read_xdr_frames(path)) {
    n_whole = frames->have_positions ? frames->n_whole : n_read;
    missing = frames->missing;
  } else if (kind_of_file(path) == FileKind::kNetcdf) {
    n_whole = n_read;
    missing = AmberNetcdf(bytes_of_file(path)).missing();
  } else {
    return;
  }
  if (n_whole != n_read)
    throw FormatError(path, 0,
                      "has " + std::to_string(n_whole) + " whole frames by its size, and its reader finds " +
                          std::to_string(n_read) + "; copy or write the file again");
  if (incomplete_.empty() && !missing.empty()) incomplete_ = path + " " + missing;
}

std::size_t FrameFiles::file_of(int frame) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), frame) - first_.begin()) - 1;
}

void FrameFiles::load(std::size_t file) {
  if (file_ != nullptr && loaded_ == file) return;
  file_ = nullptr;  // frees the old text first
  file_ = open_(paths_[file]);
  if (file < sha256_.size()) file_->require_unchanged(sha256_[file]);
  loaded_ = file;
}

std::string FrameFiles::name(int frame) const {
  const std::size_t file = file_of(frame);
  return paths_[file] + ", model " + std::to_string(frame - first_[file] + 1);
}

std::pair<const StructureFile*, int> FrameFiles::file_of_frame(int frame) {
  const std::size_t file = file_of(frame);
  load(file);
  return {file_.get(), frame - first_[file] + 1};
}

Molecule FrameFiles::read(int frame, StructureOptions options) {
  const auto [file, model] = file_of_frame(frame);
  options.model = model;
  return file->read(options);
}

std::optional<UnitCell> FrameFiles::cell(int frame) {
  const std::size_t file = file_of(frame);
  load(file);
  return file_->unit_cell(frame - first_[file] + 1);
}

}  // namespace espdiff
