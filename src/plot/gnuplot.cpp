// gnuplot.cpp: runs gnuplot as a child process with a script in a temporary file; the picture comes through a pipe.
#include "plot/gnuplot.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/text_cursor.h"
#include "io/write_csv.h"

namespace espdiff {
namespace {

/// A file that is removed when it goes out of scope.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "espdiff-plot-XXXXXX").string();
    const int descriptor = ::mkstemp(pattern.data());
    if (descriptor < 0)
      throw IoError(pattern, "a temporary file cannot be created; free some space there, or set TMPDIR");
    ::close(descriptor);
    path_ = pattern;
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }
  std::string content() const {
    std::ifstream in(path_, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }

 private:
  std::string path_;
};

/// The line of gnuplot's messages that names the error; the other lines show its place in the script.
std::string first_message(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!trimmed(line).empty()) last = std::string(trimmed(line));
  }
  return last.empty() ? "it gave no reason" : last;
}

/// Quotes for the shell, since temporary folders may have any name.
std::string quoted(const std::string& path) {
  std::string text = "'";
  for (const char c : path) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

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

std::string gnuplot_number(double value) { return std::isfinite(value) ? csv_number(value, 9) : "NaN"; }

std::string run_gnuplot(const std::string& script) {
  const TemporaryFile file, messages;
  std::ofstream(file.path(), std::ios::binary) << script;
  const std::string command = "gnuplot " + quoted(file.path()) + " 2>" + quoted(messages.path());
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw DeviceError("gnuplot cannot be started; see that the machine has memory left");
  std::string picture;
  std::array<char, 65536> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;) picture.append(block.data(), n);
  const int status = ::pclose(pipe);
  constexpr int kNotFound = 127;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound)
    throw DeviceError("plots are drawn by gnuplot, which is not installed; install it (Debian: gnuplot-nox)");
  if (status != 0 || picture.empty())
    throw DeviceError("gnuplot failed: " + first_message(messages.content()) +
                      "; version 5.2 or later with pngcairo and svg is needed (Debian: gnuplot-nox)");
  return picture;
}

void write_picture(const std::string& path, const std::string& script) {
  AtomicFile file(path);  // before drawing, to find an unwritable output early
  const std::string picture = run_gnuplot(script);
  file.stream().write(picture.data(), static_cast<std::streamsize>(picture.size()));
  file.commit();
}

}  // namespace espdiff
