// quad.h: four floats that the host computes with in one vector instruction and a GPU one by one, with the same bits.
#pragma once

#include <cstring>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

#if defined(__CUDACC__)

using Quad = Vec4f;
ESPDIFF_INLINE Quad quad_of(const Vec4f& v) { return v; }
ESPDIFF_INLINE Vec4f vec4_of(const Quad& q) { return q; }

#else

using Quad = float __attribute__((vector_size(16)));
ESPDIFF_INLINE Quad quad_of(const Vec4f& v) {
  Quad q;
  std::memcpy(&q, &v, sizeof q);
  return q;
}
ESPDIFF_INLINE Vec4f vec4_of(const Quad& q) { return {q[0], q[1], q[2], q[3]}; }

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
