// state_plot.cpp: bars with marks of both states, and a scatter.
#include "plot/state_plot.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kBarRow = 15, kBarFrame = 95, kBarPlotWidth = 460, kScatterSide = 420;  // points

void check_states(const StatePlot& plot) {
  if (plot.bars.empty()) throw InputError("there is nothing to draw: no residue has a value in both states");
  for (const StateBar& bar : plot.bars) {
    if (!std::isfinite(bar.difference) || !std::isfinite(bar.source) || !std::isfinite(bar.target))
      throw InputError("'" + bar.label + "' has a value that is not finite");
  }
}

const char* sign_colour(double value) { return value < 0 ? "#b2182b" : "#2166ac"; }

/// Rows "value row" of one state.
void add_column(std::ostream& out, const StatePlot& plot, double StateBar::*member) {
  for (std::size_t i = 0; i < plot.bars.size(); ++i) out << gnuplot_number(plot.bars[i].*member) << ' ' << i << '\n';
  out << "e\n";
}

}  // namespace

std::pair<double, double> drawn_range(const StatePlot& plot) {
  check_states(plot);
  if (plot.low != plot.high) return {plot.low, plot.high};
  double low = plot.bars.front().source, high = low;
  for (const StateBar& bar : plot.bars) {
    const double also = plot.has_bars ? bar.difference : bar.source;
    low = std::min({low, bar.source, bar.target, also});
    high = std::max({high, bar.source, bar.target, also});
  }
  if (plot.has_bars) return {std::min(low, 0.0), std::max(high, 0.0)};
  return {low, high};
}

std::string state_bars_script(const StatePlot& plot, PictureFormat format) {
  check_states(plot);
  const auto n = static_cast<double>(plot.bars.size());
  const double height = kBarFrame + kBarRow * n;
  std::ostringstream out;
  out << picture_head(format, {kBarPlotWidth, height, 3}) << "set lmargin at screen 0.24\nset rmargin at screen 0.96\n"
      << "set tmargin at screen " << gnuplot_number(1 - 52 / height) << "\nset bmargin at screen "
      << gnuplot_number(40 / height) << "\nset border 1\nset xtics nomirror\nset title " << gnuplot_string(plot.title)
      << "\nset xlabel " << gnuplot_string(plot.unit) << "\nset key above horizontal\nset yrange [" << n
      << ":-1]\nset ytics scale 0 (";
  for (std::size_t i = 0; i < plot.bars.size(); ++i)
    out << (i == 0 ? "" : ", ") << gnuplot_tic(plot.bars[i].label) << ' ' << i;
  out << ")\n";
  if (plot.low != plot.high) {
    const double room = 0.03 * (plot.high - plot.low);
    out << "set xrange [" << gnuplot_number(plot.low - room) << ':' << gnuplot_number(plot.high + room) << "]\n";
  }
  out << "set arrow 1 from 0, graph 0 to 0, graph 1 nohead linecolor rgb '" << kInk << "'\n";
  for (std::size_t i = 0; i < plot.bars.size(); ++i) {
    const double row = static_cast<double>(i), value = plot.bars[i].difference;
    out << "set object rectangle from 0," << gnuplot_number(row - 0.35) << " to " << gnuplot_number(value) << ','
        << gnuplot_number(row + 0.35) << " fillcolor rgb '" << sign_colour(value) << "' fillstyle solid 1 noborder\n";
  }
  out << "plot '-' using 1:2 with points pointsize 0 notitle, '-' using 1:2 with points pointtype 6 pointsize 0.7 "
         "linecolor rgb '"
      << kInk << "' title " << gnuplot_string(plot.source)
      << ", '-' using 1:2 with points pointtype 7 pointsize 0.6 linecolor rgb '" << kInk << "' title "
      << gnuplot_string(plot.target) << '\n';
  add_column(out, plot, &StateBar::difference);
  add_column(out, plot, &StateBar::source);
  add_column(out, plot, &StateBar::target);
  return out.str();
}

std::string state_scatter_script(const StatePlot& plot, PictureFormat format) {
  const std::string unit = plot.unit.empty() ? "" : " (" + plot.unit + ")";
  const auto [low, high] = drawn_range(plot);
  const double room = std::max(0.05 * (high - low), 1e-3);
  std::vector<std::size_t> order(plot.bars.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::fabs(plot.bars[a].target - plot.bars[a].source) > std::fabs(plot.bars[b].target - plot.bars[b].source);
  });
  constexpr std::size_t kMostLabels = 8;
  order.resize(std::min(order.size(), kMostLabels));
  std::ostringstream out;
  out << picture_head(format, {kScatterSide, kScatterSide, 3}) << "set size square\nset title "
      << gnuplot_string(plot.title) << "\nset xlabel " << gnuplot_string(plot.source + unit) << "\nset ylabel "
      << gnuplot_string(plot.target + unit) << "\nset xrange [" << gnuplot_number(low - room) << ':'
      << gnuplot_number(high + room) << "]\nset yrange [" << gnuplot_number(low - room) << ':'
      << gnuplot_number(high + room) << "]\nunset key\n";
  for (const std::size_t i : order) {
    const StateBar& bar = plot.bars[i];
    out << "set label " << gnuplot_string(bar.label) << " at " << gnuplot_number(bar.source) << ','
        << gnuplot_number(bar.target) << " offset 0.6,0.3 noenhanced\n";
  }
  out << "plot x with lines linecolor rgb '#999999', '-' using 1:2:3 with points pointtype 7 pointsize 0.7 linecolor "
         "rgb "
         "variable\n";
  for (const StateBar& bar : plot.bars) {
    out << gnuplot_number(bar.source) << ' ' << gnuplot_number(bar.target) << ' '
        << (bar.target < bar.source ? "0xb2182b" : "0x2166ac") << '\n';
  }
  out << "e\n";
  return out.str();
}

}  // namespace espdiff
