// spatial_order.cu: sorts points along the Morton curve.
#include "cuda/device/spatial_order.h"

#include <thrust/copy.h>
#include <thrust/sort.h>

#include <cfloat>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Bounding box that sum_over() can add (union).
struct Extent {
  Vec3f lower{FLT_MAX, FLT_MAX, FLT_MAX}, upper{-FLT_MAX, -FLT_MAX, -FLT_MAX};
  ESPDIFF_HD Extent& operator+=(const Extent& o) {
    lower = {smaller(lower.x, o.lower.x), smaller(lower.y, o.lower.y), smaller(lower.z, o.lower.z)};
    upper = {larger(upper.x, o.upper.x), larger(upper.y, o.upper.y), larger(upper.z, o.upper.z)};
    return *this;
  }
};

}  // namespace

Buffer<std::uint32_t> spatial_order(const Buffer<Vec4f>& points) {
  const std::size_t n = points.size();
  const Vec4f* const x = raw(points);
  const Extent box = sum_over<Extent>(n, [=] ESPDIFF_HD(std::size_t i) { return Extent{x[i].xyz(), x[i].xyz()}; });
  const Vec3f size = box.upper - box.lower;
  const float scale = 1023.0F / larger(larger(size.x, size.y), larger(size.z, 1e-6F));
  const Vec3f lower = box.lower;
  Buffer<std::uint64_t> codes(n);  // the index in the low bits makes every key unique
  std::uint64_t* const code = raw(codes);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    code[i] = static_cast<std::uint64_t>(morton_code(scale * (x[i].xyz() - lower))) << 32 | i;
  });
  thrust::sort(on_device(), codes.begin(), codes.end());
  Buffer<std::uint32_t> order(n);
  std::uint32_t* const out = raw(order);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) { out[i] = static_cast<std::uint32_t>(code[i]); });
  return order;
}

std::size_t drop_done(Buffer<std::uint32_t>& list, std::size_t n, const Buffer<std::uint8_t>& done) {
  const std::uint8_t* const flag = raw(done);
  Buffer<std::uint32_t> rest(n);
  const auto end = thrust::copy_if(on_device(), list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n),
                                   rest.begin(), [=] ESPDIFF_HD(std::uint32_t i) { return flag[i] == 0; });
  list.swap(rest);
  return static_cast<std::size_t>(end - list.begin());
}

}  // namespace espdiff::ESPDIFF_BACKEND
