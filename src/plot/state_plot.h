// state_plot.h: plots values of both states of a pair: by residue as bars, and against each other.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plot/gnuplot.h"

namespace espdiff {

struct StateBar {
  std::string label;
  double difference = 0, source = 0, target = 0;
};

struct StatePlot {
  std::vector<StateBar> bars;
  std::string title, unit;
  bool has_bars = true;      ///< differences are drawn too, from 0
  double low = 0, high = 0;  ///< ends of the axis of values; if equal, the range of all values is used
  std::string source = "source", target = "target";  ///< what the states are called
};

/// Lowest and highest value that is drawn; with `low` and `high`, these.
/// @throws InputError (nothing to draw, a value that is not finite)
std::pair<double, double> drawn_range(const StatePlot& plot);

/// The gnuplot script of signed bars, one below the other: blue where the target is more positive, red where it is more
/// negative, as on surfaces; a hollow circle for the source's value, a filled one for the target's.
/// @throws InputError (nothing to draw, a value that is not finite)
std::string state_bars_script(const StatePlot& plot, PictureFormat format);

/// The gnuplot script of target against source, a point each; the line is where both are equal. Points farthest from it
/// are labelled.
/// @throws as state_bars_script()
std::string state_scatter_script(const StatePlot& plot, PictureFormat format);

}  // namespace espdiff
