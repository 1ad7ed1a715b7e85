// arrays.h: NumPy's views of our arrays, and ours of NumPy's.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff::python {

namespace nb = nanobind;

/// A read-only array without a copy; it keeps `owner` alive.
template <typename T>
nb::object view_of(const T* data, std::initializer_list<std::size_t> shape, nb::handle owner) {
  return nb::cast(nb::ndarray<nb::numpy, const T>(data, shape, owner));
}
template <typename T>
nb::object view_of(const std::vector<T>& values, nb::handle owner) {
  return view_of(values.data(), {values.size()}, owner);
}
inline nb::object view_of(const std::vector<Vec3d>& v, nb::handle owner) {
  return view_of(reinterpret_cast<const double*>(v.data()), {v.size(), std::size_t{3}}, owner);
}
inline nb::object view_of(const std::vector<Vec3f>& v, nb::handle owner) {
  return view_of(reinterpret_cast<const float*>(v.data()), {v.size(), std::size_t{3}}, owner);
}
inline nb::object view_of(const std::vector<Triangle>& v, nb::handle owner) {
  return view_of(reinterpret_cast<const std::uint32_t*>(v.data()), {v.size(), std::size_t{3}}, owner);
}

/// An array of its own, made from values that nobody keeps.
nb::object array_from(std::vector<double> values);
nb::object array_from(std::vector<float> values);

/// Any numeric array of NumPy's: read in its own type and order, so that nothing is copied twice.
using AnyArray = nb::ndarray<nb::ro, nb::device::cpu>;

/// n numbers from an array of shape (n).
/// @param name of the argument, for messages
/// @param n    expected
/// @throws InputError (shape, type, values that are not finite)
std::vector<float> read_numbers(const AnyArray& array, const std::string& name, std::size_t n);
/// Rows of an array of shape (n, 3), read one by one where they are needed, so that nothing is copied on the way.
class PositionRows {
 public:
  /// @param rows which of them, in this order, (m) integers; none: all
  /// @throws InputError (shape, type, no rows, a row that the array lacks)
  PositionRows(const AnyArray& array, const std::optional<AnyArray>& rows, std::string name);
  std::size_t size() const;
  /// @throws InputError (a coordinate that is not finite)
  Vec3d operator[](std::size_t i) const;

 private:
  using Element = double (*)(const void*, std::int64_t);

  const AnyArray& array_;
  const std::optional<AnyArray>& rows_;
  std::string name_;
  Element read_ = nullptr, read_row_ = nullptr;
};
/// @throws as read_numbers(), for an array of any shape; in C order
std::vector<float> read_values(const AnyArray& array, const std::string& name);

}  // namespace espdiff::python
