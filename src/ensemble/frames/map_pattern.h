// map_pattern.h: the given map of each frame, by a pattern.
#pragma once

#include <string>

namespace espdiff {

/// Names the file of a frame's map: `%d` (or `%03d`: with zeros, of at least three digits) stands for the frame's
/// number in its replicate, from 0, as in `espdiff trajectory`; `{replicate}` for the replicate's name.
/// @throws InputError unless there is one place for the number
void check_map_pattern(const std::string& pattern);

/// @pre check_map_pattern()
std::string map_file(const std::string& pattern, const std::string& replicate, int frame);

}  // namespace espdiff
