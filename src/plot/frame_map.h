// frame_map.h: values of many rows, such as residues, along the frames of a trajectory, as colours.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "plot/gnuplot.h"

namespace espdiff {

struct FrameMap {
  std::vector<int> frames;              ///< [column] in rising order
  std::vector<std::string> labels;      ///< [row]
  std::vector<std::string> partners{};  ///< [row] the label's counterpart, which is not drawn; empty if it is the same
  std::vector<double> values;           ///< [row * n_frames + column]; NaN is left empty
  std::string title, unit;              ///< of the colour bar
  double low = 0, high = 0;             ///< ends of the colours; if equal, the range of the values is used
};

/// Lowest and highest value; symmetric about 0 where there are both signs. @throws InputError (there is none)
std::pair<double, double> drawn_range(const FrameMap& map);

/// The gnuplot script: a column for each frame, rows from top to bottom, labels thinned out. Colours as in a heat map:
/// red over grey to blue for both signs, otherwise an even ramp in CIE lightness.
/// @throws InputError (no frames, no labels, inconsistent sizes, range, no value)
std::string frame_map_script(const FrameMap& map, PictureFormat format);

}  // namespace espdiff
