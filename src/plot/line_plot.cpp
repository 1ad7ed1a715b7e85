// line_plot.cpp: panels above each other, one per unit.
#include "plot/line_plot.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "io/files/write_csv.h"

namespace espdiff {
namespace {

/// M. Okabe and K. Ito's colours, distinguishable with any colour vision; without yellow, which is too light for lines.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"};
constexpr std::size_t kColourCount = sizeof kColours / sizeof *kColours;
/// Point shapes, filled and hollow: circle, square, triangle, diamond, inverted triangle.
constexpr int kFilled[] = {7, 5, 9, 13, 11}, kHollow[] = {6, 4, 8, 12, 10};
constexpr std::size_t kFormCount = sizeof kFilled / sizeof *kFilled;

struct Panel {
  std::string unit;
  std::vector<std::size_t> series;
};

std::size_t n_points(const LinePlot& plot) { return plot.labels.empty() ? plot.x.size() : plot.labels.size(); }

double least(const LineSeries& s) {
  double value = HUGE_VAL;
  for (const double v : s.values) value = std::isfinite(v) ? std::min(value, v) : value;
  return value;
}
double greatest(const LineSeries& s) {
  double value = -HUGE_VAL;
  for (const double v : s.values) value = std::isfinite(v) ? std::max(value, v) : value;
  return value;
}

void check(const LinePlot& plot) {
  const std::size_t n = n_points(plot);
  if (n == 0 || plot.series.empty()) throw InputError("there is nothing to draw: no points, or no metric");
  for (const LineSeries& s : plot.series) {
    if (s.values.size() != n || (!s.errors.empty() && s.errors.size() != n))
      throw InputError("'" + s.title + "' has a number of values that differs from the number of points");
    if (least(s) > greatest(s)) throw InputError("there is nothing to draw: '" + s.title + "' has no values");
  }
}

std::vector<Panel> panels_of(const LinePlot& plot) {
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const std::string& unit = plot.series[i].unit;
    auto panel = plot.normalized
                     ? panels.begin()
                     : std::find_if(panels.begin(), panels.end(), [&](const Panel& p) { return p.unit == unit; });
    if (panel == panels.end()) panel = panels.insert(panels.end(), {unit, {}});
    panel->series.push_back(i);
  }
  return panels;
}

std::string with_unit(const std::string& title, const std::string& unit) {
  return unit.empty() ? title : title + " (" + unit + ")";
}

/// "RMSD (0: 1.67 A, 1: 6.61 A)" for normalized values.
std::string key_title(const LinePlot& plot, const LineSeries& s) {
  if (!plot.normalized) return s.title;
  const std::string unit = s.unit.empty() ? "" : (s.unit == "%" ? " %" : " " + s.unit);
  return s.title + " (0: " + csv_number(least(s), 3) + unit + ", 1: " + csv_number(greatest(s), 3) + unit + ")";
}

/// x, value, error, hollow?
std::string data(const LinePlot& plot) {
  std::ostringstream out;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const LineSeries& s = plot.series[i];
    const double low = least(s), span = greatest(s) - low;
    out << "$s" << i << " << END_OF_SERIES\n";
    for (std::size_t p = 0; p < n_points(plot); ++p) {
      double value = s.values[p], error = s.errors.empty() ? 0 : s.errors[p];
      if (plot.normalized) {
        value = span > 0 ? (value - low) / span : 0.5 + 0 * value;
        error = span > 0 ? error / span : 0;
      }
      const bool hollow = !plot.trustworthy.empty() && !plot.trustworthy[p];
      // An error bar of zero length, apart from rounding, would be invisible under its point.
      const std::string bar = error > 1e-9 * std::fabs(value) ? gnuplot_number(error) : "NaN";
      out << (plot.labels.empty() ? gnuplot_number(plot.x[p]) : std::to_string(p)) << ' ' << gnuplot_number(value)
          << ' ' << bar << ' ' << (hollow ? 1 : 0) << '\n';
    }
    out << "END_OF_SERIES\n";
  }
  return out.str();
}

std::string x_range(const LinePlot& plot) {
  double low = 0, high = static_cast<double>(plot.labels.size()) - 1, room = 0.5;
  if (plot.labels.empty()) {
    low = *std::min_element(plot.x.begin(), plot.x.end());
    high = *std::max_element(plot.x.begin(), plot.x.end());
    room = high > low ? 0.02 * (high - low) : 0.5;
  }
  return "set xrange [" + gnuplot_number(low - room) + ':' + gnuplot_number(high + room) + "]\n";
}

std::string x_tics(const LinePlot& plot, bool shown, double plot_width) {
  if (!shown) return "set format x ''\n" + std::string(plot.labels.empty() ? "" : "set xtics () scale 0\n");
  if (plot.labels.empty()) return "set format x '%g'\nset xtics autofreq scale 0.5\n";
  std::ostringstream out;
  const double room = plot_width / static_cast<double>(plot.labels.size());
  const auto step = static_cast<std::size_t>(std::ceil(9 / room));
  out << "set xtics (";
  for (std::size_t p = 0; p < plot.labels.size(); p += step)
    out << (p == 0 ? "" : ", ") << gnuplot_tic(plot.labels[p]) << ' ' << p;
  out << ") rotate by 90 right scale 0.5 font ',9'\n";
  return out.str();
}

/// The range of the panel's values and error bars, with a margin; below 0 only if there are negative values.
std::string y_range(const LinePlot& plot, const Panel& panel) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const std::size_t i : panel.series) {
    const LineSeries& s = plot.series[i];
    for (std::size_t p = 0; p < s.values.size(); ++p) {
      const double bar = s.errors.empty() || !std::isfinite(s.errors[p]) ? 0 : s.errors[p];
      if (!std::isfinite(s.values[p])) continue;
      low = std::min(low, s.values[p] - bar);
      high = std::max(high, s.values[p] + bar);
    }
  }
  const double span = high > low ? high - low : std::max(1e-6, std::fabs(high));
  const double room = 0.06 * span;
  return "set yrange [" + gnuplot_number(low >= 0 && low < room ? -0.03 * span : low - room) + ':' +
         gnuplot_number(high + room) + "]\n";
}

/// Lines between groups.
std::string group_lines(const LinePlot& plot) {
  std::ostringstream out;
  for (std::size_t p = 1; p < plot.groups.size(); ++p) {
    if (plot.groups[p] == plot.groups[p - 1]) continue;
    const double x = static_cast<double>(p) - 0.5;
    out << "set arrow from first " << x << ", graph 0 to first " << x
        << ", graph 1 nohead back linecolor rgb '#b0b0b0' dashtype 2\n";
  }
  return out.str();
}

std::string curves(const LinePlot& plot, const Panel& panel) {
  std::string text;
  for (const std::size_t i : panel.series) {
    const std::string block = "$s" + std::to_string(i);
    const std::string colour = std::string(" linecolor rgb '") + kColours[i % kColourCount] + "'";
    const LineSeries& s = plot.series[i];
    const bool alone = !plot.normalized && panel.series.size() == 1;
    const std::string title = " title " + gnuplot_string(alone ? with_unit(s.title, panel.unit) : key_title(plot, s));
    const auto points = [&](int form, int hollow) {
      return ", " + block + " using 1:($4==" + std::to_string(hollow) + "?$2:NaN) with points pointtype " +
             std::to_string(form) + " pointsize 0.7" + colour + " notitle";
    };
    text += (text.empty() ? "" : ", ") + block + " using 1:2 with lines linewidth 1.2" + colour + " notitle";
    if (!plot.series[i].errors.empty())
      text +=
          ", " + block + " using 1:2:3 with yerrorbars pointtype 7 pointsize 0.01 linewidth 1" + colour + " notitle";
    text += points(kFilled[i % kFormCount], 0) + points(kHollow[i % kFormCount], 1);
    // The sample shown in the key.
    text += ", NaN with linespoints pointtype " + std::to_string(kFilled[i % kFormCount]) + " pointsize 0.7" + colour +
            title;
  }
  return text;
}

}  // namespace

std::string line_plot_script(const LinePlot& plot, PictureFormat format) {
  check(plot);
  const std::vector<Panel> panels = panels_of(plot);
  constexpr double kPanel = 130, kGap = 12, kLeft = 62, kRight = 14, kKeyLine = 13;
  std::size_t longest = 0;
  for (const std::string& label : plot.labels) longest = std::max(longest, label.size());
  const bool any_hollow = std::count(plot.trustworthy.begin(), plot.trustworthy.end(), false) > 0;
  const double bottom = (plot.labels.empty() ? 34 : 24 + 5.6 * static_cast<double>(longest)) + (any_hollow ? 12 : 0);
  const double height_of_panel = panels.size() == 1 ? 1.6 * kPanel : kPanel;
  // A title stands beside its panel if it is no longer than the panel.
  const auto title_beside = [&](const Panel& panel) {
    const LineSeries& first = plot.series[panel.series.front()];
    constexpr double kLetter = 5.4;
    return !plot.normalized && panel.series.size() == 1 &&
           kLetter * static_cast<double>(with_unit(first.title, panel.unit).size()) < height_of_panel;
  };
  // Otherwise a key stands above it, one line per series.
  const auto key_lines = [&](const Panel& panel) {
    return title_beside(panel) ? 0.0 : static_cast<double>(panel.series.size());
  };
  double height = bottom + (plot.title.empty() ? 8 : 24);
  for (const Panel& panel : panels) height += height_of_panel + kGap + kKeyLine * key_lines(panel);

  PictureSize size;
  size.width = plot.width;
  size.height = height;
  std::ostringstream s;
  s << picture_head(format, size) << data(plot) << "set multiplot\nset border linewidth 0.6 linecolor rgb '" << kInk
    << "'\nset ytics scale 0.5\nset mxtics 1\nset grid ytics linecolor rgb '#e4e4e4' linewidth 0.5\nset lmargin at "
       "screen "
    << kLeft / size.width << "\nset rmargin at screen " << 1 - kRight / size.width << '\n';
  s << x_range(plot);
  if (!plot.title.empty())
    s << "set label 1 " << gnuplot_string(plot.title) << " at screen 0.5, screen " << 1 - 13 / size.height
      << " center\n";
  if (any_hollow)
    s << "set label 2 'hollow points: not trustworthy' at screen " << 1 - kRight / size.width << ", screen "
      << 9 / size.height << " right font ',8'\n";
  // gnuplot omits an axis title if it finds no room for it.
  s << "set label 3 " << gnuplot_string(plot.x_title) << " at screen "
    << 0.5 * (kLeft + size.width - kRight) / size.width << ", screen " << (any_hollow ? 21 : 9) / size.height
    << " center\n";
  s << group_lines(plot);
  double top = size.height - (plot.title.empty() ? 8 : 24);
  for (const Panel& panel : panels) {
    const bool last = &panel == &panels.back();
    top -= kKeyLine * key_lines(panel);
    s << "set tmargin at screen " << top / size.height << "\nset bmargin at screen "
      << (top - height_of_panel) / size.height << '\n';
    const LineSeries& first = plot.series[panel.series.front()];
    const std::string axis = plot.normalized            ? "Normalized"
                             : title_beside(panel)      ? with_unit(first.title, panel.unit)
                             : panel.series.size() == 1 ? ""
                             : panel.unit.empty()       ? "Index or count"
                                                        : panel.unit;
    s << "set label 4 " << gnuplot_string(axis) << " at screen " << 14 / size.width << ", screen "
      << (top - 0.5 * height_of_panel) / size.height << " center rotate by 90\n"
      << (plot.normalized ? "set yrange [-0.05:1.05]\n" : y_range(plot, panel))
      << x_tics(plot, last, size.width - kLeft - kRight);
    if (key_lines(panel) > 0) {
      s << "set key at graph 0, screen " << (top + kKeyLine * key_lines(panel)) / size.height
        << " left top Left reverse samplen 2 spacing 1 font ',9'\n";
    } else {
      s << "unset key\n";
    }
    s << "plot " << curves(plot, panel) << '\n';
    if (&panel == &panels.front()) s << "unset label 1\nunset label 2\nunset label 3\n";
    top -= height_of_panel + kGap;
  }
  return s.str() + "unset multiplot\n";
}

}  // namespace espdiff
