// permissions.h: what this user may do with a path.
#pragma once

#include <string>

namespace espdiff {

bool may_write(const std::string& path);
/// A file, not a folder.
bool may_run(const std::string& path);
/// This user's, and no link: /tmp belongs to everyone.
bool is_own_folder(const std::string& path);
/// Device and inode of a regular file, with links followed: equal for all names of one file. Empty for anything else.
std::string file_identity(const std::string& path);
/// A new folder that is readable by this user alone.
/// @param start its path but for six letters  @returns an empty string if it cannot be made
std::string make_private_folder(const std::string& start);

}  // namespace espdiff
