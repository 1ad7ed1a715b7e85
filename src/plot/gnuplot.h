// gnuplot.h: draws pictures with gnuplot: runs scripts, and formats their parts.
#pragma once

#include <string>

namespace espdiff {

/// Of text and axes.
inline constexpr const char* kInk = "#202020";

enum class PictureFormat { kPng, kSvg };

/// By the extension. @throws InputError unless it is .png or .svg
PictureFormat picture_format(const std::string& path);

/// Size of a picture. A script is laid out in points; a PNG has `pixels_per_point` pixels per point.
struct PictureSize {
  double width = 480, height = 440;  ///< points
  double pixels_per_point = 3;       ///< of a PNG
};

/// The head of a script: format, size, fonts. Text stays text in an SVG. Labels contain no markup.
std::string picture_head(PictureFormat format, const PictureSize& size);

/// A text as a gnuplot string, with any content; line ends become blanks.
std::string gnuplot_string(const std::string& text);
/// The same for the label of a tic, where gnuplot would expand formats.
std::string gnuplot_tic(const std::string& text);
/// A number in gnuplot's syntax; NaN as `NaN`.
std::string gnuplot_number(double value);

/// Sets the palette of a map of values: diverging_colour() from red to blue, or sequential_colour().
std::string gnuplot_palette(bool diverging);

/// @throws DeviceError (gnuplot is missing, with the package to install)
void require_gnuplot();

/// Runs a script and returns the picture.
/// @throws as require_gnuplot(); DeviceError (it failed, with its message)
std::string run_gnuplot(const std::string& script);

/// Runs the script and writes the picture to a file.
/// @throws as run_gnuplot(), IoError
void write_picture(const std::string& path, const std::string& script);

}  // namespace espdiff
