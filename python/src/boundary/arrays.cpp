// arrays.cpp: arrays of NumPy's in every type and order, element by element.
#include "arrays.h"

#include <cmath>
#include <cstring>

#include "base/error.h"

namespace espdiff::python {
namespace {

std::string shape_of(const AnyArray& array) {
  std::string text = "(";
  for (std::size_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + ")";
}

template <typename T>
double element(const void* data, std::int64_t index) {
  return static_cast<double>(static_cast<const T*>(data)[index]);
}

using Element = double (*)(const void*, std::int64_t);

/// How one element of the array's type is read.
Element reader_of(const AnyArray& array, const std::string& name) {
  const nb::dlpack::dtype type = array.dtype();
  const auto is = [&](nb::dlpack::dtype_code code, int bits) {
    return type.code == static_cast<std::uint8_t>(code) && type.bits == bits && type.lanes == 1;
  };
  using Code = nb::dlpack::dtype_code;
  if (is(Code::Float, 32)) return element<float>;
  if (is(Code::Float, 64)) return element<double>;
  if (is(Code::Int, 32)) return element<std::int32_t>;
  if (is(Code::Int, 64)) return element<std::int64_t>;
  throw InputError(name + ": the array has a type that is not read; give float32 or float64");
}

}  // namespace

nb::object array_from(std::vector<double> values) {
  auto* const kept = new std::vector<double>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return view_of(*kept, owner);
}

nb::object array_from(std::vector<float> values) {
  auto* const kept = new std::vector<float>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
  return view_of(*kept, owner);
}

std::vector<float> read_numbers(const AnyArray& array, const std::string& name, std::size_t n) {
  const Element read = reader_of(array, name);
  if (array.ndim() != 1 || array.shape(0) != n)
    throw InputError(name + ": the array has the shape " + shape_of(array) + "; one value for each of the " +
                     std::to_string(n) + " atoms is needed");
  std::vector<float> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = static_cast<float>(read(array.data(), static_cast<std::int64_t>(i) * array.stride(0)));
    if (!std::isfinite(values[i])) throw InputError(name + ": atom " + std::to_string(i) + " has no finite value");
  }
  return values;
}

PositionRows::PositionRows(const AnyArray& array, const std::optional<AnyArray>& rows, std::string name)
    : array_(array), rows_(rows), name_(std::move(name)), read_(reader_of(array, name_)) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(name_ + ": the array has the shape " + shape_of(array) + "; (number of atoms, 3) is needed");
  if (rows) {
    if (rows->ndim() != 1 || rows->dtype().code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float))
      throw InputError("rows: the array has the shape " + shape_of(*rows) +
                       "; one whole number for each atom is needed");
    read_row_ = reader_of(*rows, "rows");
  }
  if (size() == 0) throw InputError(name_ + ": there are no atoms");
}

std::size_t PositionRows::size() const { return rows_ ? rows_->shape(0) : array_.shape(0); }

Vec3d PositionRows::operator[](std::size_t i) const {
  auto row = static_cast<std::int64_t>(i);
  if (rows_) {
    row = static_cast<std::int64_t>(read_row_(rows_->data(), row * rows_->stride(0)));
    if (row < 0 || row >= static_cast<std::int64_t>(array_.shape(0)))
      throw InputError("rows: " + name_ + " has no row " + std::to_string(row) + "; there are " +
                       std::to_string(array_.shape(0)));
  }
  Vec3d position{};
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = read_(array_.data(), row * array_.stride(0) + axis * array_.stride(1));
    if (!std::isfinite(position[axis]))
      throw InputError(name_ + ": atom " + std::to_string(i) + " has a coordinate that is not finite");
  }
  return position;
}

std::vector<float> read_values(const AnyArray& array, const std::string& name) {
  const Element read = reader_of(array, name);
  std::vector<float> values(array.size());
  std::vector<std::size_t> index(array.ndim(), 0);
  for (float& value : values) {
    std::int64_t at = 0;
    for (std::size_t axis = 0; axis < index.size(); ++axis)
      at += static_cast<std::int64_t>(index[axis]) * array.stride(axis);
    value = static_cast<float>(read(array.data(), at));
    for (std::size_t axis = index.size(); axis-- > 0;) {
      if (++index[axis] < array.shape(axis)) break;
      index[axis] = 0;
    }
  }
  return values;
}

}  // namespace espdiff::python
