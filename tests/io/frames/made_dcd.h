// made_dcd.h: DCD trajectories as programs write them, byte by byte.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace espdiff_test {

/// How the file is laid out.
struct DcdForm {
  bool swapped = false;  ///< the other order of bytes
  bool long_marks = false;
  bool has_cell = false, has_fourth = false;
  int n_fixed = 0;      ///< atoms that only the first frame has
  int n_promised = -1;  ///< frames by the head; -1: as many as there are
};

/// @param frames [frame][axis][atom]
inline std::string made_dcd(const std::vector<std::array<std::vector<float>, 3>>& frames, const DcdForm& form = {}) {
  std::string bytes;
  const auto add = [&](const auto& number) {
    std::string raw(reinterpret_cast<const char*>(&number), sizeof number);
    if (form.swapped) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  const auto mark = [&](std::size_t n) {
    if (form.long_marks) add(static_cast<std::uint64_t>(n));
    if (!form.long_marks) add(static_cast<std::uint32_t>(n));
  };
  std::array<std::int32_t, 20> control{};
  control[0] = form.n_promised < 0 ? static_cast<std::int32_t>(frames.size()) : form.n_promised;
  control[1] = control[2] = 1;
  control[8] = form.n_fixed;
  control[10] = form.has_cell ? 1 : 0;
  control[11] = form.has_fourth ? 1 : 0;
  control[19] = 24;
  mark(84);
  bytes += "CORD";
  for (const std::int32_t number : control) add(number);
  mark(84);
  mark(84);
  add(std::int32_t{1});
  bytes += std::string(80, ' ');
  mark(84);
  const std::size_t n_atoms = frames.front()[0].size(), n_free = n_atoms - static_cast<std::size_t>(form.n_fixed);
  mark(4);
  add(static_cast<std::int32_t>(n_atoms));
  mark(4);
  if (form.n_fixed > 0) {
    mark(4 * n_free);
    for (std::size_t i = 0; i < n_free; ++i) add(static_cast<std::int32_t>(i + 1));
    mark(4 * n_free);
  }
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::size_t n = f == 0 ? n_atoms : n_free;
    if (form.has_cell) {
      mark(48);
      for (int i = 0; i < 6; ++i) add(90.0);
      mark(48);
    }
    for (std::size_t axis = 0; axis < (form.has_fourth ? 4U : 3U); ++axis) {
      mark(4 * n);
      for (std::size_t i = 0; i < n; ++i) add(frames[f][std::min<std::size_t>(axis, 2)][i]);
      mark(4 * n);
    }
  }
  return bytes;
}

}  // namespace espdiff_test
