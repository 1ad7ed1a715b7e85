// map_pattern.cpp: patterns of the frames' maps.
#include "ensemble/frames/map_pattern.h"

#include "base/error.h"
#include "field/file_pattern.h"

namespace espdiff {

void check_map_pattern(const std::string& pattern) {
  if (count_frame_places(pattern) != 1)
    throw InputError(option("maps") + ": '" + pattern +
                     "' does not have one place for the frame's number, such as %d or %03d");
}

std::string map_file(const std::string& pattern, const std::string& replicate, int frame) {
  FieldInput state;
  state.replicate = replicate;
  state.frame = frame;
  return fill_pattern(pattern, state, "the pattern of maps '" + pattern + "'");
}

}  // namespace espdiff
