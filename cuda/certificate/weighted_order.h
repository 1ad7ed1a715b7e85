// weighted_order.h: values in ascending order with their weights, for quantiles over an area.
#pragma once

#include <utility>
#include <vector>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// (value, weight) in ascending order, by the weight among equal values. NaN comes last, or first if its
/// sign bit is set.
/// @param values, weights [point]
std::vector<std::pair<float, float>> in_ascending_order(const Buffer<float>& values, const Buffer<float>& weights);

}  // namespace espdiff::ESPDIFF_BACKEND
