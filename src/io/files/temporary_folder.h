// temporary_folder.h: a folder for the files of another program, which does not stay.
#pragma once

#include <string>

#include "system/open_file.h"

namespace espdiff {

/// An empty folder in TMPDIR (otherwise /tmp), readable by the user alone, removed with all that is in it at the end.
/// A process that is killed leaves its folder; the next one that makes a folder there removes it.
class TemporaryFolder {
 public:
  /// @throws IoError
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }  ///< absolute
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  /// Writes a file of this folder. @returns its path. @throws IoError (the disk is full)
  std::string write(const std::string& name, const std::string& content) const;

 private:
  std::string path_;
  OpenFile lock_;  ///< of the folder
};

}  // namespace espdiff
