// json_number.h: numbers in JSON.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace espdiff {

/// JSON has no NaN and no infinity: they are null.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace espdiff
