// page_arrays.h: numbers for a page in a browser: 16-bit steps, deflated, as base64.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Collects arrays, and describes where each begins. Little-endian.
class PageArrays {
 public:
  /// 65535 steps between the smallest and the largest value; the last one stands for NaN.
  /// @returns {offset (bytes), n, min, max} for the page's decode()
  nlohmann::ordered_json add_numbers(const std::vector<double>& values);
  /// In single precision, for numbers that are read. @returns {offset, n, single: true} for the page's decode()
  nlohmann::ordered_json add_singles(const std::vector<double>& values);
  /// Corners, each as its difference from the one before. @returns {offset, n} with n triangles
  nlohmann::ordered_json add_triangles(const std::vector<Triangle>& triangles);
  /// @returns {offset, n}
  nlohmann::ordered_json add_integers(const std::vector<std::int32_t>& values);

  /// All bytes as base64, deflated where this build has zlib.
  std::string base64() const;
  static bool is_deflated();

 private:
  std::size_t begin(std::size_t alignment);
  std::string bytes_;
};

}  // namespace espdiff
