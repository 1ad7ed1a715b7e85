// heat_map.h: a square table of values as colours, with labels, groups and a dendrogram.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plot/gnuplot.h"

namespace espdiff {

/// A branch of a dendrogram: clusters 0 to n - 1 are the items, the k-th branch is n + k.
struct DendrogramBranch {
  std::size_t left = 0, right = 0;
  double height = 0;  ///< NaN: unknown, drawn at the top
};

struct HeatMap {
  std::vector<std::string> labels;  ///< [item]
  std::vector<std::string> groups;  ///< [item]; empty, or empty texts, for none
  std::vector<double> values;       ///< [row * n + column]; NaN, like the diagonal, is struck through
  std::vector<bool> marked;         ///< [row * n + column] gets a dot; empty for none
  std::string title, unit;          ///< of the colour bar
  std::string row_title = "Source", column_title = "Target", mark_title;
  bool diverging = false;                    ///< both signs: red over grey to blue, symmetric about 0
  std::vector<DendrogramBranch> dendrogram;  ///< orders rows and columns; empty keeps the given order
  std::string dendrogram_title;
  double low = 0, high = 0;  ///< ends of the colours; if equal, the range off the diagonal is used
};

/// The gnuplot script of a heat map, sized to the number of items. Rows run from top to bottom. Adjacent items of one
/// group are framed, with the group's name above. Missing values are struck through. Colours: an even ramp in CIE
/// lightness (sequential_colour()), or diverging_colour() from red to blue.
/// @throws InputError (no values, inconsistent sizes, range)
std::string heat_map_script(const HeatMap& map, PictureFormat format);

/// Lowest and highest value off the diagonal; symmetric about 0 for diverging colours.
std::pair<double, double> drawn_range(const HeatMap& map);
/// The items from left to right: ordered by the dendrogram, or as given.
std::vector<std::size_t> drawing_order(const HeatMap& map);

}  // namespace espdiff
