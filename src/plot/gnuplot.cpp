// gnuplot.cpp: runs gnuplot as a program.
#include "plot/gnuplot.h"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"
#include "io/files/atomic_file.h"
#include "io/files/run_program.h"
#include "io/files/write_csv.h"
#include "io/text/text_cursor.h"
#include "plot/colour_map.h"

namespace espdiff {
namespace {}  // namespace

PictureFormat picture_format(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (ending == ".png") return PictureFormat::kPng;
  if (ending == ".svg") return PictureFormat::kSvg;
  throw InputError(path + ": a picture's name ends in .png or .svg");
}

std::string picture_head(PictureFormat format, const PictureSize& size) {
  // The bitmap's fonts are drawn at 96 dots per inch, the SVG's at 72.
  constexpr double kFontSize = 10, kPngFontScale = 0.75;
  const bool png = format == PictureFormat::kPng;
  const double scale = png ? size.pixels_per_point : 1;
  std::ostringstream head;
  head << "set encoding utf8\nset terminal " << (png ? "pngcairo" : "svg") << " size "
       << std::lround(scale * size.width) << ',' << std::lround(scale * size.height) << " noenhanced font 'Arial,"
       << gnuplot_number(kFontSize) << "' " << (png ? "fontscale " + gnuplot_number(kPngFontScale * scale) : "")
       << (png ? " linewidth " + gnuplot_number(scale) + " pointscale " + gnuplot_number(scale) +
                     " background rgb 'white'"
               : " background rgb 'white'")
       << '\n';
  return head.str();
}

std::string gnuplot_string(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '`') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

std::string gnuplot_tic(const std::string& text) {
  std::string format;
  for (const char c : text) format += c == '%' ? std::string("%%") : std::string(1, c);
  return gnuplot_string(format);
}

std::string gnuplot_palette(bool diverging) {
  constexpr int kSteps = 64;
  std::string text = "set palette defined (";
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const Rgb c = diverging ? diverging_colour(t, kRedBlue) : sequential_colour(t);
    text += (i == 0 ? "" : ", ") + std::to_string(i) + formatted(" '#%02x%02x%02x'", c.red, c.green, c.blue);
  }
  return text + ")\n";
}

std::string gnuplot_number(double value) { return std::isfinite(value) ? csv_number(value, 9) : "NaN"; }

void require_gnuplot() {
  if (find_program("gnuplot").empty())
    throw DeviceError("plots are drawn by gnuplot, which is not installed; install it (Debian: gnuplot-nox)");
}

std::string run_gnuplot(const std::string& script) {
  require_gnuplot();
  // Without the user's own ~/.gnuplot (-d).
  const ProgramResult result = run_program({{"gnuplot", "-d"}, script, {}, 0, {}});
  if (result.status != 0 || result.output.empty())
    throw DeviceError("gnuplot could not draw (exit status " + std::to_string(result.status) +
                      "); version 5.2 or later with its terminals pngcairo and svg is needed (Debian: gnuplot-nox)");
  return result.output;
}

void write_picture(const std::string& path, const std::string& script) {
  AtomicFile file(path);  // before drawing, to find an unwritable output early
  const std::string picture = run_gnuplot(script);
  file.stream().write(picture.data(), static_cast<std::streamsize>(picture.size()));
  file.commit();
}

}  // namespace espdiff
