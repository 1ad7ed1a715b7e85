// frame_map.cpp: the table as an image in gnuplot, with the numbers of frames below and the labels at its side.
#include "plot/frame_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kWidth = 430, kLeft = 74, kRight = 88, kBottom = 38, kTop = 12;  // points
constexpr double kFont = 7;

void check(const FrameMap& map) {
  if (map.frames.empty() || map.labels.empty() || map.values.size() != map.frames.size() * map.labels.size())
    throw InputError("a map along frames needs frames, rows, and a value for each pair of them");
  if (map.low > map.high)
    throw InputError("the range of colours goes from " + gnuplot_number(map.low) + " down to " +
                     gnuplot_number(map.high) + "; give the lower end first");
}

/// Every so many labels that `room` points hold.
template <typename Label>
std::string tics(std::size_t n, double room, double least, Label label) {
  const double each = room / static_cast<double>(n);
  const auto step = static_cast<std::size_t>(std::max(1.0, std::ceil(least / each)));
  std::string text = "(";
  for (std::size_t i = 0; i < n; i += step)
    text += (i == 0 ? "" : ", ") + gnuplot_tic(label(i)) + ' ' + std::to_string(i);
  return text + ")";
}

}  // namespace

std::pair<double, double> drawn_range(const FrameMap& map) {
  if (map.low != map.high) return {map.low, map.high};
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : map.values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) throw InputError("there is nothing to draw: no frame has a value of '" + map.title + "'");
  if (low < 0 && high > 0) {
    high = std::max(-low, high);
    low = -high;
  } else if (low >= 0) {
    low = 0;
  }
  if (low == high) high = low + 1e-6;
  return {low, high};
}

std::string frame_map_script(const FrameMap& map, PictureFormat format) {
  check(map);
  const auto [low, high] = drawn_range(map);
  const std::size_t n_frames = map.frames.size(), n_rows = map.labels.size();
  const double height = std::clamp(3.0 * static_cast<double>(n_rows), 180.0, 560.0);
  PictureSize size;
  size.width = kLeft + kWidth + kRight;
  size.height = kBottom + height + kTop;
  std::ostringstream s;
  s << picture_head(format, size) << gnuplot_palette(low < 0 && high > 0) << "$values << END_OF_VALUES\n";
  for (std::size_t row = 0; row < n_rows; ++row) {
    for (std::size_t column = 0; column < n_frames; ++column)
      s << (column == 0 ? "" : " ") << gnuplot_number(map.values[row * n_frames + column]);
    s << '\n';
  }
  const double left = kLeft / size.width, right = 1 - kRight / size.width, bottom = kBottom / size.height,
               top = 1 - kTop / size.height;
  s << "END_OF_VALUES\nunset key\nset border linewidth 0.6\nset lmargin at screen " << left
    << "\nset rmargin at screen " << right << "\nset bmargin at screen " << bottom << "\nset tmargin at screen " << top
    << "\nset xrange [-0.5:" << static_cast<double>(n_frames) - 0.5 << "]\nset yrange ["
    << static_cast<double>(n_rows) - 0.5 << ":-0.5]\nset cbrange [" << gnuplot_number(low) << ':'
    << gnuplot_number(high) << "]\n";
  s << "set xtics " << tics(n_frames, kWidth, 34, [&](std::size_t i) { return std::to_string(map.frames[i]); })
    << " scale 0.4 nomirror font ',9'\nset ytics "
    << tics(n_rows, height, kFont + 1, [&](std::size_t i) { return map.labels[i]; }) << " scale 0 nomirror font ',"
    << kFont << "'\nset xlabel 'Frame' offset 0,0.4\n";
  // Unlike any colour of a value: the middle of both signs is grey, the low end of one is nearly white.
  s << "set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '"
    << (low < 0 && high > 0 ? "#ffffff" : "#c8c8c8") << "' fillstyle solid 1 noborder\n"
    << "set colorbox user origin screen " << right + 14 / size.width << ',' << bottom << " size screen "
    << 12 / size.width << ',' << top - bottom << " border\nset cbtics scale 0.4 font ',9'\nset label "
    << gnuplot_string(map.title + (map.unit.empty() ? "" : " (" + map.unit + ")")) << " at screen "
    << 1 - 12 / size.width << ", screen " << 0.5 * (bottom + top) << " center rotate by 90\n";
  // Pixels, since a terminal may interpolate an image.
  s << "plot $values matrix using 1:2:3 with image pixels\n";
  return s.str();
}

}  // namespace espdiff
