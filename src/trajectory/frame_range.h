// frame_range.h: which frames of a trajectory are meant, in the words of VMD's PMEPot.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Frames from 0 on, ascending. Accepts `all`, `last`, a frame, `begin:end` or `begin:step:end`, both ends included;
/// `end` or `last` is the last frame, and negative ones count from the end (-1 is the last).
/// @throws InputError that names the range, what is accepted, and how many frames there are
std::vector<int> parse_frames(const std::string& text, int n_frames);

}  // namespace espdiff
