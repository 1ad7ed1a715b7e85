// spatial_order.cu: sorts points along the Hilbert curve.
#include "cuda/device/spatial_order.h"

#include <cfloat>

#include "cuda/device/hilbert_curve.h"
#include "cuda/device/sort.h"

#if !defined(ESPDIFF_BACKEND_CUDA)
#include <thrust/copy.h>
#endif

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
  // The box stays on the device.
  const Buffer<Extent> boxes = sum_on_device<Extent>(n, [=] ESPDIFF_HD(std::size_t i) {
    return Extent{x[i].xyz(), x[i].xyz()};
  });
  const Extent* const box = raw(boxes);
  Buffer<std::uint32_t> codes(n), order(n);
  std::uint32_t* const code = raw(codes);
  std::uint32_t* const index = raw(order);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    code[i] = hilbert_code(hilbert_scale(box->lower, box->upper) * (x[i].xyz() - box->lower));
    index[i] = static_cast<std::uint32_t>(i);
  });
  sort_by_key(codes, order, kHilbertBits);
  return order;
}

#if !defined(ESPDIFF_BACKEND_CUDA)

std::size_t drop_done(Buffer<std::uint32_t>& list, std::size_t n, const Buffer<std::uint8_t>& done) {
  const std::uint8_t* const flag = raw(done);
  Buffer<std::uint32_t> rest(n);
  const auto end = thrust::copy_if(on_device(), list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n),
                                   rest.begin(), [=] ESPDIFF_HD(std::uint32_t i) { return flag[i] == 0; });
  list.swap(rest);
  return static_cast<std::size_t>(end - list.begin());
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
