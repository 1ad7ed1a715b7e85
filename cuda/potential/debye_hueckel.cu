// debye_hueckel.cu: the border's potential, summed on a coarse lattice over each face and interpolated between.
#include "cuda/potential/debye_hueckel.h"

#include <algorithm>
#include <cmath>

#include "cuda/surface/gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Distance between evaluations of the sum. Far from atoms it varies over many Angstrom.
constexpr double kBorderSpacing_A = 2.5;

/// Charges for the sum: strength = scale q exp(kappa a) / (1 + kappa a).
struct BorderCharges {
  const float* x;
  const float* y;
  const float* z;
  const float* strength;
  std::size_t n;  ///< a multiple of kLanes, padded with charges of strength 0
  float kappa;
};
constexpr std::size_t kLanes = 16;

ESPDIFF_INLINE float border_sum(const BorderCharges& c, float px, float py, float pz) {
  float sums[kLanes] = {};
  for (std::size_t first = 0; first < c.n; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = first + lane;
      const float dx = px - c.x[i], dy = py - c.y[i], dz = pz - c.z[i];
      const float r = sqrtf(larger(dx * dx + dy * dy + dz * dz, 0.25F));
      sums[lane] += c.strength[i] * exp_of_negative(larger(-c.kappa * r, -80.0F)) / r;
    }
  }
  double sum = 0;
  for (const float s : sums) sum += static_cast<double>(s);
  return static_cast<float>(sum);
}

/// A face of the border: where its points lie in the grid.
struct Face {
  std::size_t first, step[2];              ///< of indices, along its two axes
  int n[2];                                ///< points
  int coarse[2];                           ///< points of the coarse lattice
  float first_coordinate[3], along[2][3];  ///< Angstrom, a step along each axis
};

struct BorderSums {
  Face face;
  BorderCharges charges;
  int stride;
  float* values;

  ESPDIFF_INLINE void at(std::size_t index) const {
    // The last points may lie beyond the face, where the sum is valid too.
    const int u = static_cast<int>(index % static_cast<std::size_t>(face.coarse[0])),
              v = static_cast<int>(index / static_cast<std::size_t>(face.coarse[0]));
    const float a = static_cast<float>(u * stride), b = static_cast<float>(v * stride);
    float p[3];
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = face.first_coordinate[axis] + a * face.along[0][axis] + b * face.along[1][axis];
    values[index] = border_sum(charges, p[0], p[1], p[2]);
  }
};

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION void sum_points(const BorderSums& sums, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) sums.at(i);
}
#endif

/// Weights of cubic Lagrange interpolation on four points in a row; t runs from 0 to 1 between the middle two.
ESPDIFF_INLINE void cubic_weights(float t, float (&w)[4]) {
  w[0] = -t * (t - 1.0F) * (t - 2.0F) / 6.0F;
  w[1] = (t + 1.0F) * (t - 1.0F) * (t - 2.0F) * 0.5F;
  w[2] = -(t + 1.0F) * t * (t - 2.0F) * 0.5F;
  w[3] = (t + 1.0F) * t * (t - 1.0F) / 6.0F;
}

struct CubicPlace {
  int first;
  float weight[4];
};
ESPDIFF_INLINE CubicPlace cubic_place(int point, int stride, int n_coarse) {
  CubicPlace place;
  const int below = point / stride;
  place.first = below - 1 < 0 ? 0 : below - 1 > n_coarse - 4 ? n_coarse - 4 : below - 1;
  cubic_weights(static_cast<float>(point) / static_cast<float>(stride) - static_cast<float>(place.first + 1),
                place.weight);
  return place;
}

void set_face(const Face& face, const BorderCharges& charges, int stride, Buffer<float>& phi) {
  const std::size_t n_coarse = static_cast<std::size_t>(face.coarse[0]) * static_cast<std::size_t>(face.coarse[1]);
  Buffer<float> coarse(n_coarse);
  const BorderSums sums{face, charges, stride, raw(coarse)};
#if defined(__CUDACC__)
  for_each_index(n_coarse, [=] ESPDIFF_HD(std::size_t i) { sums.at(i); });
#else
  constexpr std::size_t kRun = 16;
  for_each_index((n_coarse + kRun - 1) / kRun,
                 [=](std::size_t run) { sum_points(sums, run * kRun, std::min(n_coarse, (run + 1) * kRun)); });
#endif
  const float* const from = raw(coarse);
  float* const to = raw(phi);
  for_each_index(
      static_cast<std::size_t>(face.n[0]) * static_cast<std::size_t>(face.n[1]), [=] ESPDIFF_HD(std::size_t index) {
        const int a = static_cast<int>(index % static_cast<std::size_t>(face.n[0])),
                  b = static_cast<int>(index / static_cast<std::size_t>(face.n[0]));
        const CubicPlace u = cubic_place(a, stride, face.coarse[0]), v = cubic_place(b, stride, face.coarse[1]);
        float sum = 0;
        for (int row = 0; row < 4; ++row) {
          const float* const line = from + u.first + std::ptrdiff_t{face.coarse[0]} * (v.first + row);
          sum += v.weight[row] *
                 ((u.weight[0] * line[0] + u.weight[1] * line[1]) + (u.weight[2] * line[2] + u.weight[3] * line[3]));
        }
        to[face.first + static_cast<std::size_t>(a) * face.step[0] + static_cast<std::size_t>(b) * face.step[1]] = sum;
      });
}

Face face_of(const CubicLattice& lattice, int axis, bool upper, int stride) {
  const std::size_t steps[3] = {1, static_cast<std::size_t>(lattice.size[0]),
                                static_cast<std::size_t>(lattice.size[0]) * static_cast<std::size_t>(lattice.size[1])};
  Face face{};
  const int last = lattice.size[axis] - 1;
  face.first = upper ? steps[axis] * static_cast<std::size_t>(last) : 0;
  for (int c = 0; c < 3; ++c) face.first_coordinate[c] = lattice.coordinate(c, c == axis && upper ? last : 0);
  const int axes[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
  for (int side = 0; side < 2; ++side) {
    face.step[side] = steps[axes[side]];
    face.n[side] = lattice.size[axes[side]];
    face.along[side][axes[side]] = lattice.spacing;
    face.coarse[side] = std::max(4, (face.n[side] - 2) / stride + 2);
  }
  return face;
}

}  // namespace

void set_debye_hueckel_border(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, const DebyeHueckel& law,
                              Buffer<float>& phi) {
  std::vector<float> x, y, z, strength;
  for (const PbAtom& atom : atoms) {
    if (atom.charge == 0) continue;
    const double a = law.kappa * static_cast<double>(atom.radius);
    x.push_back(static_cast<float>(atom.position.x));
    y.push_back(static_cast<float>(atom.position.y));
    z.push_back(static_cast<float>(atom.position.z));
    strength.push_back(static_cast<float>(law.scale * static_cast<double>(atom.charge) * std::exp(a) / (1 + a)));
  }
  while (strength.size() % kLanes != 0) {
    for (std::vector<float>* values : {&x, &y, &z}) values->push_back(0);
    strength.push_back(0);
  }
  const Buffer<float> on_x = to_device(x), on_y = to_device(y), on_z = to_device(z), on_strength = to_device(strength);
  const BorderCharges charges{raw(on_x),        raw(on_y),       raw(on_z),
                              raw(on_strength), strength.size(), static_cast<float>(law.kappa)};
  const int stride =
      std::max(1, static_cast<int>(std::lround(kBorderSpacing_A / static_cast<double>(lattice.spacing))));
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) set_face(face_of(lattice, axis, upper, stride), charges, stride, phi);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
