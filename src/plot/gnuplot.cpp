// gnuplot.cpp: runs gnuplot as a child process; script, picture and messages are files in memory.
#include "plot/gnuplot.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/system_message.h"
#include "io/atomic_file.h"
#include "io/text_cursor.h"
#include "io/write_csv.h"

extern "C" char** environ;  // NOLINT: POSIX declares no header for it

namespace espdiff {
namespace {

/// A file in memory, without a name: neither a full disk nor a missing folder for temporary files matters.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content = {}) : descriptor_(::memfd_create("espdiff-plot", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail();
    for (std::size_t written = 0; written < content.size();) {
      const ssize_t n = ::write(descriptor_, content.data() + written, content.size() - written);
      if (n < 0) fail();
      written += static_cast<std::size_t>(n);
    }
    ::lseek(descriptor_, 0, SEEK_SET);
  }
  ~MemoryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }
  std::string content() const {
    std::string text;
    std::array<char, 65536> block{};
    ::lseek(descriptor_, 0, SEEK_SET);
    for (ssize_t n = 0; (n = ::read(descriptor_, block.data(), block.size())) > 0;)
      text.append(block.data(), static_cast<std::size_t>(n));
    return text;
  }

 private:
  [[noreturn]] void fail() {
    const int error_number = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw DeviceError(std::string("gnuplot cannot be started: ") + system_message(error_number));
  }

  int descriptor_;
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

/// Starts gnuplot on a script, without a shell between and without the user's own ~/.gnuplot (-d), and waits for it.
/// Returns what waitpid() says.
int wait_for_gnuplot(const MemoryFile& script, const MemoryFile& picture, const MemoryFile& messages) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, script.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, picture.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages.descriptor(), STDERR_FILENO);
  std::string program = "gnuplot", defaults = "-d";
  std::array<char*, 3> words = {program.data(), defaults.data(), nullptr};
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, program.c_str(), &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT)
    throw DeviceError("plots are drawn by gnuplot, which is not installed; install it (Debian: gnuplot-nox)");
  if (error != 0) throw DeviceError(std::string("gnuplot cannot be started: ") + system_message(error));
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  return status;
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
  const MemoryFile input(script), output, messages;
  const int status = wait_for_gnuplot(input, output, messages);
  const std::string picture = output.content();
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
