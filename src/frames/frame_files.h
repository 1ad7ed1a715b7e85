// frame_files.h: the frames of one molecule in structure files of several models.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "io/frames/open_structure.h"

namespace espdiff {

/// Models of structure files, or frames of trajectories, as frames, numbered from 0 through all files. One
/// file at a time is in memory.
class FrameFiles {
 public:
  /// Reads every file, to count its models. A file that is read again must have the same content.
  /// @param open how a file is opened, for trajectories
  /// @throws as `open`; InputError without a file; FormatError (a reader finds other frames in a DCD, XTC or TRR than
  /// it has)
  explicit FrameFiles(std::vector<std::string> paths, OpenStructure open = open_structure);

  int n_frames() const { return first_.back(); }
  /// What is missing of a DCD, XTC or TRR, with the file's name; empty where all are whole. See DcdHead::missing().
  const std::string& incomplete() const { return incomplete_; }
  const std::vector<std::string>& paths() const { return paths_; }
  /// "FILE, model N" of a frame, for messages.
  std::string name(int frame) const;

  /// The file of a frame, which stays until another frame is asked for, and the frame's model in it.
  /// @throws as StructureFile
  std::pair<const StructureFile*, int> file_of_frame(int frame);
  /// @param options all but the model
  /// @throws as read_structure(); IoError (the file was changed since)
  Molecule read(int frame, StructureOptions options);
  /// The cell that the frame's file gives it. @throws as StructureFile::unit_cell()
  std::optional<UnitCell> cell(int frame);

 private:
  std::size_t file_of(int frame) const;
  void load(std::size_t file);
  void compare_with_size(const std::string& path, int n_read);

  std::vector<std::string> paths_;
  OpenStructure open_;
  std::vector<int> first_;           // [file + 1] number of its first frame
  std::vector<std::string> sha256_;  // [file] of the first reading
  std::string incomplete_;
  std::size_t loaded_ = 0;
  std::unique_ptr<StructureFile> file_;
};

}  // namespace espdiff
