// json_integer.h: whole numbers of JSON files.
#pragma once
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace espdiff {

/// A whole number of an nlohmann::json value. The library's own get() casts any number to any type, which is undefined
/// for 1e30.
/// @throws std::out_of_range if the value is not a whole number of this type
template <typename Integer, typename Json>
Integer integer_of(const Json& json) {
  static_assert(std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>);
  using Limits = std::numeric_limits<Integer>;
  if (!json.is_number_integer()) throw std::out_of_range("not a whole number");
  bool fits = false;
  if (json.is_number_unsigned() || json.template get<std::int64_t>() >= 0)
    fits = json.template get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max());
  else if constexpr (std::is_signed_v<Integer>)
    fits = json.template get<std::int64_t>() >= Limits::min();
  if (!fits) throw std::out_of_range("a whole number out of range");
  return json.template get<Integer>();
}

}  // namespace espdiff
