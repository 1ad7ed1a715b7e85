// made_amber.h: Amber's coordinates as programs write them: restarts in text, and NetCDF byte by byte.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace espdiff_test {

/// A restart of n atoms at (i, i + 0.5, -i) A. @param more numbers behind the coordinates
inline std::string made_restart(int n, const std::vector<double>& more = {}) {
  std::string text = "title\n" + std::to_string(n) + "  0.1000000E+02\n";
  std::vector<double> numbers;
  for (int i = 0; i < n; ++i) numbers.insert(numbers.end(), {1.0 * i, i + 0.5, -1.0 * i});
  const std::size_t n_coordinates = numbers.size();
  numbers.insert(numbers.end(), more.begin(), more.end());
  for (std::size_t i = 0, on_line = 0; i < numbers.size(); ++i) {
    if (i == n_coordinates && on_line != 0) {
      text += "\n";
      on_line = 0;
    }
    char field[32];
    std::snprintf(field, sizeof field, "%12.7f", numbers[i]);
    text += field;
    if (++on_line == 6) {
      text += "\n";
      on_line = 0;
    }
  }
  return text + "\n";
}

/// How the file is laid out.
struct NetcdfForm {
  int version = 2;            ///< 1, 2 or 5
  bool is_trajectory = true;  ///< otherwise a restart, in double
  bool is_stream = false;     ///< the head does not count the frames
  bool has_cell = true;
  int n_promised = -1;  ///< frames by the head; -1: as many as there are
  std::string unit = "angstrom", coordinates = "coordinates";
};

/// @param frames [frame][atom] x, which is y + 1 and z + 2 too
inline std::string made_netcdf(const std::vector<std::vector<double>>& frames, const NetcdfForm& form = {}) {
  std::string bytes = "CDF" + std::string(1, static_cast<char>(form.version));
  const auto add = [&](const auto& number) {
    std::string raw(reinterpret_cast<const char*>(&number), sizeof number);
    std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  const auto size = [&](std::uint64_t n) {
    if (form.version == 5) add(n);
    if (form.version != 5) add(static_cast<std::uint32_t>(n));
  };
  const auto text = [&](const std::string& words) {
    size(words.size());
    bytes += words + std::string((4 - words.size() % 4) % 4, '\0');
  };
  const auto list = [&](std::uint32_t mark, std::uint64_t n) {
    add(n == 0 ? 0U : mark);
    size(n);
  };
  constexpr std::uint32_t kDimensions = 10, kVariables = 11, kAttributes = 12, kChar = 2, kFloat = 5, kDouble = 6;
  const std::size_t n_atoms = frames.front().size();
  const std::uint64_t n_frames = form.n_promised < 0 ? frames.size() : static_cast<std::uint64_t>(form.n_promised);
  size(form.is_stream ? ~std::uint64_t{0} : form.is_trajectory ? n_frames : 0);
  list(kDimensions, 4);
  for (const auto& [name, length] :
       {std::pair<const char*, std::size_t>{"frame", 0}, {"spatial", 3}, {"atom", n_atoms}, {"cell_spatial", 3}}) {
    text(name);
    size(length);
  }
  list(kAttributes, 1);
  text("Conventions");
  add(kChar);
  text(form.is_trajectory ? "AMBER" : "AMBERRESTART");
  // Places of the variables' first numbers: known once the head's length is.
  struct Variable {
    std::string name, unit;
    std::vector<std::uint64_t> dimensions;
    std::uint32_t type;
    std::uint64_t n_bytes;
    std::size_t begin_at;
  };
  const std::uint32_t type = form.is_trajectory ? kFloat : kDouble;
  const std::uint64_t n_bytes = 3 * n_atoms * (form.is_trajectory ? sizeof(float) : sizeof(double));
  std::vector<Variable> variables{{form.coordinates, form.unit, {2, 1}, type, n_bytes, 0}};
  if (form.has_cell) {
    variables.push_back({"cell_lengths", "angstrom", {3}, kDouble, 3 * sizeof(double), 0});
    variables.push_back({"cell_angles", "degree", {3}, kDouble, 3 * sizeof(double), 0});
  }
  list(kVariables, variables.size());
  for (Variable& variable : variables) {
    text(variable.name);
    size(variable.dimensions.size() + (form.is_trajectory ? 1 : 0));
    if (form.is_trajectory) size(0);
    for (const std::uint64_t dimension : variable.dimensions) size(dimension);
    list(kAttributes, 1);
    text("units");
    add(kChar);
    text(variable.unit);
    add(variable.type);
    size(variable.n_bytes);
    variable.begin_at = bytes.size();
    if (form.version == 1) add(std::uint32_t{0});
    if (form.version != 1) add(std::uint64_t{0});
  }
  std::uint64_t begin = bytes.size();
  for (const Variable& variable : variables) {
    std::string head;
    std::swap(head, bytes);
    if (form.version == 1) add(static_cast<std::uint32_t>(begin));
    if (form.version != 1) add(begin);
    head.replace(variable.begin_at, bytes.size(), bytes);
    bytes = head;
    begin += variable.n_bytes;
  }
  for (const std::vector<double>& frame : frames) {
    for (const double x : frame) {
      for (int axis = 0; axis < 3; ++axis) {
        if (form.is_trajectory) add(static_cast<float>(x + axis));
        if (!form.is_trajectory) add(x + axis);
      }
    }
    if (!form.has_cell) continue;
    for (const double number : {30.0, 40.0, 50.0, 90.0, 100.0, 90.0}) add(number);
  }
  return bytes;
}

}  // namespace espdiff_test
