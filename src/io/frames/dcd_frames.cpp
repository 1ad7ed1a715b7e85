// dcd_frames.cpp: each frame is a record of the cell, where there is one, and records of x, y and z.
#include "io/frames/dcd_frames.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "io/files/read_input.h"

namespace espdiff {
namespace {

constexpr std::size_t kCellBytes = 6 * sizeof(double);

template <typename T>
T value_at(const std::vector<char>& bytes, std::size_t index, bool is_swapped) {
  char raw[sizeof(T)];
  std::memcpy(raw, bytes.data() + index * sizeof(T), sizeof(T));
  if (is_swapped) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// An angle in degrees, which may be written as its cosine.
double angle_of(double written) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  return std::fabs(written) <= 1 ? std::acos(written) * kDegrees : written;
}

}  // namespace

bool is_dcd_name(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending == ".dcd";
}

DcdFrames::DcdFrames(std::string path, std::size_t n_atoms)
    : path_(std::move(path)), file_(path_, FileAccess::kReadPipe) {
  require_regular_file(path_);
  if (!file_) throw IoError(path_, "cannot be read; check its permissions");
  const std::optional<DcdHead> head = read_dcd_head(path_);
  if (!head)
    throw FormatError(path_, 0, "this does not begin as a DCD; copy the file again, or give its format's ending");
  head_ = *head;
  if (static_cast<std::size_t>(head_.n_atoms) != n_atoms)
    throw InputError(path_ + ": has " + std::to_string(head_.n_atoms) + " atoms, and the structure " +
                     std::to_string(n_atoms) + "; give the structure or topology it was written for");
  if (head_.n_whole < 1) throw FormatError(path_, 0, "holds no whole frame; copy or write the file again");
  if (head_.n_whole > std::numeric_limits<int>::max())
    throw InputError(path_ + ": has more than 2147483647 frames, which is the most that are read");
  if (head_.n_fixed > 0) first_ = frame(0).positions;
}

std::vector<char> DcdFrames::record(int number, std::uint64_t& at, std::size_t n_bytes) const {
  std::vector<char> mark(head_.mark_bytes), content(n_bytes);
  const auto read = [&](std::vector<char>& bytes) {
    const bool is_there = file_.read_at(at, bytes.data(), bytes.size()) == 0;
    at += bytes.size();
    return is_there;
  };
  const auto length = [&] {
    return head_.mark_bytes == sizeof(std::uint64_t) ? value_at<std::uint64_t>(mark, 0, head_.is_swapped)
                                                     : value_at<std::uint32_t>(mark, 0, head_.is_swapped);
  };
  const bool is_whole = read(mark) && length() == n_bytes && read(content) && read(mark) && length() == n_bytes;
  if (!is_whole)
    throw FormatError(path_, 0,
                      "frame " + std::to_string(number) + " is damaged: a record of " + std::to_string(n_bytes) +
                          " bytes was expected; copy or write the file again");
  return content;
}

std::uint64_t DcdFrames::read_coordinates(int number, std::uint64_t at, std::vector<float> (&axes)[3],
                                          std::size_t n) const {
  for (std::vector<float>& axis : axes) {
    const std::vector<char> bytes = record(number, at, n * sizeof(float));
    axis.resize(n);
    for (std::size_t i = 0; i < n; ++i) axis[i] = value_at<float>(bytes, i, head_.is_swapped);
  }
  return at;
}

const CoordinateFrame& DcdFrames::frame(int number) {
  if (held_ == number) return frame_;
  held_ = -1;
  const auto n_atoms = static_cast<std::size_t>(head_.n_atoms);
  const std::uint64_t begin = head_.begin;
  std::uint64_t at =
      number == 0 ? begin : begin + head_.n_first + static_cast<std::uint64_t>(number - 1) * head_.n_frame;
  frame_.cell.reset();
  if (head_.has_cell) {
    const std::vector<char> bytes = record(number, at, kCellBytes);
    const auto entry = [&](std::size_t i) { return value_at<double>(bytes, i, head_.is_swapped); };
    const UnitCell cell{{entry(0), entry(2), entry(5)}, {angle_of(entry(4)), angle_of(entry(3)), angle_of(entry(1))}};
    if (cell.lengths.x > 1 && cell.lengths.y > 1 && cell.lengths.z > 1) frame_.cell = cell;
  }
  const bool has_all = number == 0 || head_.n_fixed == 0;
  const std::size_t n = has_all ? n_atoms : head_.moving.size();
  std::vector<float> axes[3];
  read_coordinates(number, at, axes, n);
  frame_.positions = has_all ? std::vector<Vec3f>(n_atoms) : first_;
  for (std::size_t i = 0; i < n; ++i)
    frame_.positions[has_all ? i : head_.moving[i]] = {axes[0][i], axes[1][i], axes[2][i]};
  held_ = number;
  return frame_;
}

}  // namespace espdiff
