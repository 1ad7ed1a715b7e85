// sibling_file.h: new files beside the one whose place they take when they are complete; and those that killed runs
// left.
#pragma once

#include <string>
#include <vector>

#include "system/open_file.h"

namespace espdiff {

/// The folder that a file is in: "." of a bare name.
std::string folder_of(const std::string& path);

/// A name beside `target` that no other process or thread uses.
std::string sibling_name(const std::string& target, const char* suffix);

/// Makes a file beside `target`, through no link, and locks it, so that others see that its process lives.
/// @param name receives its name  @returns a file that is not open, with its error, where it cannot be made
OpenFile make_sibling(const std::string& target, std::string& name);

/// Gives a new file that has no name one beside `target`. @returns 0, or the error's number
int name_sibling(const OpenFile& file, const std::string& target, std::string& name);

/// Removes the files beside these that killed processes left: of this version and those before (`.tmp12-0`, `.old12-0`,
/// `.new-12`). An older result that stepped aside for one that never came takes its place again.
void remove_leftovers(const std::vector<std::string>& targets);

/// The file that `path` means once symbolic links are followed; it need not exist.
std::string followed_links(const std::string& path);

}  // namespace espdiff
