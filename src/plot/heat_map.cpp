// heat_map.cpp: cells as boxes, group frames and branches in one coordinate system, in which a cell is 1 by 1.
#include "plot/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/error.h"
#include "plot/colour_map.h"

namespace espdiff {
namespace {

constexpr const char* kNoValue = "#ececec";
constexpr double kTreeShare = 0.18;  // height above the matrix, as a fraction of its side

Rgb colour_at(const HeatMap& map, double t) {
  return map.diverging ? diverging_colour(t, kRedBlue) : sequential_colour(t);
}

/// Picture and margins in points.
struct Layout {
  double cell, font, left, right, bottom, top, tree;
  PictureSize size;

  double side(std::size_t n) const { return cell * static_cast<double>(n); }
};

std::size_t longest(const std::vector<std::string>& words) {
  std::size_t n = 1;
  for (const std::string& word : words) {
    // Continuation bytes of UTF-8 take no room.
    n = std::max(n, static_cast<std::size_t>(
                        std::count_if(word.begin(), word.end(), [](char c) { return (c & 0xC0) != 0x80; })));
  }
  return n;
}

bool has_groups(const HeatMap& map) {
  return std::any_of(map.groups.begin(), map.groups.end(), [](const std::string& g) { return !g.empty(); });
}

std::string foot_note(const HeatMap& map) {
  const std::string marks = map.mark_title.empty() ? "" : "\u2022 " + map.mark_title;
  if (map.dendrogram.empty() || map.dendrogram_title.empty()) return marks;
  return marks + (marks.empty() ? "" : "; ") + map.dendrogram_title;
}

Layout layout_of(const HeatMap& map) {
  const auto n = static_cast<double>(map.labels.size());
  Layout l{};
  l.cell = std::clamp(330 / n, 4.0, 40.0);
  l.font = std::clamp(0.75 * l.cell, 3.0, 9.0);
  const double label = 0.62 * l.font * static_cast<double>(longest(map.labels)) + 6;
  l.left = label + 22;
  l.bottom = label + 22 + (foot_note(map).empty() ? 0 : 14);
  l.tree = map.dendrogram.empty() ? 0 : kTreeShare * l.side(map.labels.size());
  l.top = l.tree + (has_groups(map) ? 18 : 8) + (map.dendrogram.empty() ? 0 : 4);
  l.right = 86;
  l.size.width = l.left + l.side(map.labels.size()) + l.right;
  l.size.height = l.bottom + l.side(map.labels.size()) + l.top;
  return l;
}

/// Beside the scale, upwards; a title longer than the matrix is centred on the picture, in letters that fit into it.
std::string title_of_scale(const HeatMap& map, const Layout& l, double n) {
  const std::string title = map.title + (map.unit.empty() ? "" : " (" + map.unit + ")");
  const double letters = 0.56 * static_cast<double>(longest({title})), margin = 8;
  const double font = std::min(10.0, (l.size.height - margin) / letters);
  std::ostringstream s;
  s << "set label " << gnuplot_string(title) << " at screen " << 1 - 12 / l.size.width << ", ";
  if (letters * font <= l.cell * n) {
    s << "first " << 0.5 * (n - 1);
  } else {
    s << "screen 0.5";
  }
  s << " center rotate by 90 font '," << gnuplot_number(font) << "'\n";
  return s.str();
}

void check(const HeatMap& map) {
  const std::size_t n = map.labels.size();
  if (n < 2 || map.values.size() != n * n || (!map.groups.empty() && map.groups.size() != n) ||
      (!map.marked.empty() && map.marked.size() != n * n) ||
      (!map.dendrogram.empty() && map.dendrogram.size() != n - 1))
    throw InputError("a heat map needs two labels or more, and a value for each pair of them");
  if (map.low > map.high)
    throw InputError("the range of colours goes from " + gnuplot_number(map.low) + " down to " +
                     gnuplot_number(map.high) + "; give the lower end first");
}

/// Consecutive items of one group: first and last place, and the name.
struct Run {
  std::size_t first, last;
  std::string group;
};

std::vector<Run> runs_of(const HeatMap& map, const std::vector<std::size_t>& order) {
  std::vector<Run> runs;
  if (!has_groups(map)) return runs;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const std::string& group = map.groups[order[place]];
    if (!runs.empty() && runs.back().group == group && runs.back().last + 1 == place) {
      runs.back().last = place;
    } else {
      runs.push_back({place, place, group});
    }
  }
  runs.erase(std::remove_if(runs.begin(), runs.end(), [](const Run& run) { return run.group.empty(); }), runs.end());
  return runs;
}

std::string tics(const char* axis, const HeatMap& map, const std::vector<std::size_t>& order, const Layout& l) {
  std::ostringstream out;
  out << "set " << axis << "tics (";
  // Thins out labels that would overlap.
  const auto step = static_cast<std::size_t>(std::ceil(l.font / l.cell));
  for (std::size_t place = 0; place < order.size(); place += step)
    out << (place == 0 ? "" : ", ") << gnuplot_tic(map.labels[order[place]]) << ' ' << place;
  out << ") " << (*axis == 'x' ? "rotate by 90 right " : "") << "scale 0 offset " << (*axis == 'x' ? "0,0.3" : "0.6,0")
      << " font '," << gnuplot_number(l.font) << "' textcolor rgb '" << kInk << "'\n";
  return out.str();
}

/// The lines of the dendrogram above the matrix.
std::string tree(const HeatMap& map, const std::vector<std::size_t>& order, double foot, double height) {
  const std::size_t n = order.size();
  double top = 0;
  for (const DendrogramBranch& branch : map.dendrogram) {
    if (std::isfinite(branch.height)) top = std::max(top, branch.height);
  }
  std::vector<double> x(n), y(n, foot);
  for (std::size_t place = 0; place < n; ++place) x[order[place]] = static_cast<double>(place);
  std::ostringstream out;
  out << "$tree << END_OF_TREE\n";
  for (const DendrogramBranch& branch : map.dendrogram) {
    const double share = std::isfinite(branch.height) && top > 0 ? branch.height / top : 1;
    const double level = foot - share * height;
    const std::size_t a = branch.left, b = branch.right;
    out << x[a] << ' ' << y[a] << '\n'
        << x[a] << ' ' << level << '\n'
        << x[b] << ' ' << level << '\n'
        << x[b] << ' ' << y[b] << "\n\n";
    x.push_back(0.5 * (x[a] + x[b]));
    y.push_back(level);
  }
  out << "END_OF_TREE\n";
  return out.str();
}

/// Cells, and dots that contrast with the colour below.
std::string cells(const HeatMap& map, const std::vector<std::size_t>& order, double low, double high) {
  const std::size_t n = order.size();
  std::ostringstream values, dots, strikes;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t at = order[row] * n + order[column];
      const double value = map.values[at];
      if (row == column || !std::isfinite(value)) {
        const double x = static_cast<double>(column), y = static_cast<double>(row);
        strikes << x - 0.5 << ' ' << y - 0.5 << '\n' << x + 0.5 << ' ' << y + 0.5 << "\n\n";
        continue;
      }
      values << column << ' ' << row << ' ' << gnuplot_number(std::clamp(value, low, high)) << '\n';
      if (map.marked.empty() || !map.marked[at]) continue;
      const Rgb c = colour_at(map, (value - low) / (high > low ? high - low : 1));
      const double lightness = 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue;
      dots << column << ' ' << row << ' ' << (lightness > 128 ? "0x303030" : "0xf0f0f0") << '\n';
    }
  }
  return "$cells << END_OF_CELLS\n" + values.str() + "END_OF_CELLS\n$dots << END_OF_DOTS\n" + dots.str() +
         "END_OF_DOTS\n$strikes << END_OF_STRIKES\n" + strikes.str() + "END_OF_STRIKES\n";
}

std::string rectangle(double x0, double y0, double x1, double y1, const std::string& style) {
  return "set object rectangle from " + gnuplot_number(x0) + ',' + gnuplot_number(y0) + " to " + gnuplot_number(x1) +
         ',' + gnuplot_number(y1) + ' ' + style + '\n';
}

}  // namespace

std::vector<std::size_t> drawing_order(const HeatMap& map) {
  const std::size_t n = map.labels.size();
  std::vector<std::vector<std::size_t>> things(n);
  for (std::size_t i = 0; i < n; ++i) things[i] = {i};
  if (map.dendrogram.empty()) {
    std::vector<std::size_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = i;
    return order;
  }
  for (const DendrogramBranch& branch : map.dendrogram) {
    std::vector<std::size_t> joined = things.at(branch.left);
    joined.insert(joined.end(), things.at(branch.right).begin(), things.at(branch.right).end());
    things.push_back(std::move(joined));
  }
  return things.back();
}

std::pair<double, double> drawn_range(const HeatMap& map) {
  const std::size_t n = map.labels.size();
  double low = map.low, high = map.high;
  if (low == high) {
    low = HUGE_VAL;
    high = -HUGE_VAL;
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t column = 0; column < n; ++column) {
        const double value = map.values[row * n + column];
        if (row == column || !std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    if (low > high) throw InputError("there is nothing to draw: no pair has a value of '" + map.title + "'");
    if (map.diverging) {
      high = std::max(std::fabs(low), std::fabs(high));
      low = -high;
    }
    if (low == high) high = low + std::max(1e-6, 1e-3 * std::fabs(low));  // one colour, and a bar that can be drawn
  }
  return {low, high};
}

std::string heat_map_script(const HeatMap& map, PictureFormat format) {
  check(map);
  const auto [low, high] = drawn_range(map);
  const std::vector<std::size_t> order = drawing_order(map);
  const Layout l = layout_of(map);
  const auto n = static_cast<double>(order.size());
  const double above = l.top / l.cell;  // in cells
  std::ostringstream s;
  s << picture_head(format, l.size) << gnuplot_palette(map.diverging) << cells(map, order, low, high);
  s << "unset border\nunset key\nset lmargin at screen " << l.left / l.size.width << "\nset rmargin at screen "
    << 1 - l.right / l.size.width << "\nset bmargin at screen " << l.bottom / l.size.height
    << "\nset tmargin at screen 1\n"
    << "set xrange [-0.5:" << n - 0.5 << "]\nset yrange [" << n - 0.5 << ":" << -0.5 - above << "]\nset cbrange ["
    << gnuplot_number(low) << ':' << gnuplot_number(high) << "]\n";
  s << tics("x", map, order, l) << tics("y", map, order, l);
  // gnuplot omits an axis title if it finds no room for it.
  s << "set label " << gnuplot_string(map.column_title) << " at first " << 0.5 * (n - 1) << ", screen "
    << (foot_note(map).empty() ? 11 : 25) / l.size.height << " center\n";
  s << "set label " << gnuplot_string(map.row_title) << " at screen " << 10 / l.size.width << ", first "
    << 0.5 * (n - 1) << " center rotate by 90\n";
  s << "set colorbox user origin screen " << 1 - (l.right - 14) / l.size.width << ',' << l.bottom / l.size.height
    << " size screen " << 12 / l.size.width << ',' << l.side(order.size()) / l.size.height
    << " border\nset cbtics scale 0.4 font ',9'\n"
    << title_of_scale(map, l, n);
  s << rectangle(-0.5, -0.5, n - 0.5, n - 0.5,
                 std::string("behind fillcolor rgb '") + kNoValue + "' fillstyle solid 1 noborder");
  s << rectangle(-0.5, -0.5, n - 0.5, n - 0.5,
                 std::string("front fillstyle empty border rgb '") + kInk + "' linewidth 0.6");
  for (const Run& run : runs_of(map, order)) {
    const double first = static_cast<double>(run.first) - 0.5, last = static_cast<double>(run.last) + 0.5;
    if (run.last > run.first)
      s << rectangle(first, first, last, last,
                     std::string("front fillstyle empty border rgb '") + kInk + "' linewidth 1.8");
    s << "set label " << gnuplot_string(run.group) << " at first " << 0.5 * (first + last) << ',' << -0.5 - 8 / l.cell
      << " center font ',9'\n";
  }
  if (!foot_note(map).empty())
    s << "set label " << gnuplot_string(foot_note(map)) << " at screen " << l.left / l.size.width << ", screen "
      << 9 / l.size.height << " left font ',8' textcolor rgb '#404040'\n";
  std::string plot =
      "plot $cells using 1:2:($1-0.5):($1+0.5):($2-0.5):($2+0.5):3 with boxxyerror fillstyle solid 1 "
      "border linewidth 0.3 linecolor palette";
  plot += ", $strikes using 1:2 with lines linewidth 0.5 linecolor rgb '#909090'";
  if (std::count(map.marked.begin(), map.marked.end(), true) > 0)
    plot += ", $dots using 1:2:3 with points pointtype 7 pointsize " +
            gnuplot_number(std::clamp(l.cell / 100, 0.05, 0.2)) + " linecolor rgb variable";
  if (!map.dendrogram.empty()) {
    s << tree(map, order, -0.5 - (has_groups(map) ? 16 : 4) / l.cell, l.tree / l.cell);
    plot += std::string(", $tree using 1:2 with lines linewidth 0.8 linecolor rgb '") + kInk + "'";
  }
  return s.str() + plot + '\n';
}

}  // namespace espdiff
