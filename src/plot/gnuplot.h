// gnuplot.h: pictures by gnuplot: finding it, running a script, and the words that a script is made of.
#pragma once

#include <string>

namespace espdiff {

enum class PictureFormat { kPng, kSvg };

/// By the ending. @throws InputError for anything but .png and .svg
PictureFormat picture_format(const std::string& path);

/// How large a picture is. A script is laid out in points; a PNG has `pixels_per_point` of pixels for each.
struct PictureSize {
  double width = 480, height = 440;  ///< points
  double pixels_per_point = 3;       ///< of a PNG
};

/// The lines that begin a script: format, size, fonts. Text stays text in an SVG. Nothing in labels is markup.
std::string picture_head(PictureFormat format, const PictureSize& size);

/// A text as gnuplot's string, whatever is in it; line ends become blanks.
std::string gnuplot_string(const std::string& text);
/// The same for the label of a tic, which gnuplot would take for a format.
std::string gnuplot_tic(const std::string& text);
/// A number as gnuplot reads it; NaN as `NaN`.
std::string gnuplot_number(double value);

/// Runs a script and returns what it draws.
/// @throws DeviceError (gnuplot is not there, with what to install; it failed, with its message)
std::string run_gnuplot(const std::string& script);

/// Runs the script and writes the picture under its name.
/// @throws as run_gnuplot(), IoError
void write_picture(const std::string& path, const std::string& script);

}  // namespace espdiff
