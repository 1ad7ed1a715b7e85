// line_plot.h: plots values of one variant against all, or along a trajectory, as lines with points.
#pragma once

#include <string>
#include <vector>

#include "plot/gnuplot.h"

namespace espdiff {

struct LineSeries {
  std::string title, unit;
  std::vector<double> values;  ///< [point]; NaN leaves a gap
  std::vector<double> errors;  ///< [point] half lengths of the error bars; empty for none
};

struct LinePlot {
  std::string title, x_title;
  std::vector<double> x;            ///< [point]; empty if the points are named
  std::vector<std::string> labels;  ///< [point] names, instead of x
  std::vector<std::string> groups;  ///< [point] lines separate neighbours of different groups; empty for none
  std::vector<LineSeries> series;
  std::vector<bool> trustworthy;  ///< [point] otherwise drawn hollow; empty: all are
  bool normalized = false;        ///< scales each series from its minimum, 0, to its maximum, 1, in one panel
  double width = 520;             ///< points
};

/// The gnuplot script of a line plot. Series of one unit share a panel; panels share the x axis. With `normalized`
/// there is one panel, and the key gives the values of 0 and 1. Series differ in colour and point shape.
/// @throws InputError (no points, no series, inconsistent sizes, a series without values)
std::string line_plot_script(const LinePlot& plot, PictureFormat format);

}  // namespace espdiff
