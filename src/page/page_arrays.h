// page_arrays.h: numbers for a page in a browser: steps of at most 16 bits, deflated, as base64.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Collects arrays, and describes where each begins. Little-endian. Neighbours on a surface have similar numbers: steps
/// and corners are kept as differences from the one before, all low bytes first, which deflate shortens by a third.
class PageArrays {
 public:
  static constexpr int kFineSteps = 65534, kColourSteps = 4095;

  /// Steps between the smallest and the largest value; NaN is 65535.
  /// @param n_steps kFineSteps, or kColourSteps for what is only seen as a colour
  /// @param stride components that are interleaved; each differs from the one of its kind before
  /// @returns {offset (bytes), n, min, max, steps, stride} for the page's decode()
  nlohmann::ordered_json add_numbers(const std::vector<double>& values, int n_steps = kFineSteps, int stride = 1);
  /// In single precision, for numbers that are read. @returns {offset, n, single: true} for the page's decode()
  nlohmann::ordered_json add_singles(const std::vector<double>& values);
  /// Corners, each as its difference from the one before. @returns {offset, n} with n triangles
  nlohmann::ordered_json add_triangles(const std::vector<Triangle>& triangles);
  /// @returns {offset, n}
  nlohmann::ordered_json add_integers(const std::vector<std::int32_t>& values);

  const std::string& bytes() const { return bytes_; }
  /// All bytes as base64, deflated where this build has zlib.
  std::string base64() const;
  static std::string packed(const std::string& bytes);
  static bool is_deflated();

 private:
  std::size_t begin(std::size_t alignment);
  std::string bytes_;
};

}  // namespace espdiff
