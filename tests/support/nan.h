// nan.h: the number that stands for no value.
#pragma once

#include <limits>

namespace espdiff_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace espdiff_test
