// line_plot.h: values of one variant against all, or along a trajectory, as lines with points.
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
  std::vector<double> x;            ///< [point]; empty where the points are named
  std::vector<std::string> labels;  ///< [point] names, in the place of x
  std::vector<std::string> groups;  ///< [point] a line parts neighbours of different groups; empty for none
  std::vector<LineSeries> series;
  std::vector<bool> trustworthy;  ///< [point] else it is drawn hollow; empty: all are
  bool normalized = false;        ///< each series from its least value, 0, to its greatest, 1, in one panel
  double width = 520;             ///< points
};

/// The script that draws it. Series of one unit share a panel, panels share the x axis; with `normalized` there is one
/// panel, and the key says what 0 and 1 stand for. Every series is told apart by colour and by the form of its points.
/// @throws InputError (no points, no series, sizes that do not fit each other, no value in a series)
std::string line_plot_script(const LinePlot& plot, PictureFormat format);

}  // namespace espdiff
