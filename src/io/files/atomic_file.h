// atomic_file.h: output files that appear complete under their names, or not at all.
#pragma once

#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "system/open_file.h"

namespace espdiff {

/// Writes to a temporary file in the folder of `path` and gives it its name at the end, so that a crash, a full disk or
/// a cancelled run leaves an older file of this name as it was. Where the file system can (O_TMPFILE: ext4, xfs, btrfs,
/// tmpfs), the temporary file has no name until then, and a killed process leaves nothing. A symbolic link is followed,
/// not replaced; the new file has the permissions of the older one. Numbers are written in the C locale.
class AtomicFile {
 public:
  /// Opens the temporary file.
  /// @throws IoError naming the path, the reason and what to do: empty name, missing folder, a folder or device of this
  /// name,
  ///         no permission, an existing file that is read-only
  explicit AtomicFile(std::string path);
  /// Removes the temporary file unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  const std::string& path() const { return path_; }

  /// Finishes the file and gives it its name.
  /// @throws IoError (disk full, name no longer free); then nothing is left behind and an older file is as it was
  void commit();

  /// Commits all or none: every file is finished before the first gets its name, and names already given are taken back
  /// when a later one is refused.
  /// @throws IoError as commit()
  friend void commit_all(const std::vector<AtomicFile*>& files);

 private:
  void open_unnamed();
  void open_named();
  void keep_mode() const;
  void name_temporary();
  void finish();
  void rename_to_target();
  void restore_target();
  void forget_previous();

  std::string path_;       // as given, for messages
  std::string target_;     // with symbolic links followed
  std::string temporary_;  // empty once renamed or removed, and while the file has no name
  OpenFile file_;          // locked until it has its name; has none before the end where that can be
  std::string previous_;   // an older file of this name, aside until all are committed; empty without one
  std::ofstream stream_;
  bool renamed_ = false;
};

void commit_all(const std::vector<AtomicFile*>& files);

}  // namespace espdiff
