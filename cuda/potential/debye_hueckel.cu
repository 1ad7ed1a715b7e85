// debye_hueckel.cu: the border's potential, summed on a coarse lattice over each face and interpolated between.
#include "cuda/potential/debye_hueckel.h"

#include <algorithm>
#include <cmath>

#include "cuda/potential/cubic_weights.h"
#include "cuda/potential/far_charges.h"
#include "cuda/surface/density/gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

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

/// Potential of charge i at a point.
ESPDIFF_INLINE float border_term(const BorderCharges& c, std::size_t i, const Vec3f& p) {
  const float dx = p.x - c.x[i], dy = p.y - c.y[i], dz = p.z - c.z[i];
  const float r = sqrtf(larger(dx * dx + dy * dy + dz * dz, 0.25F));
  return c.strength[i] * exp_of_negative(larger(-c.kappa * r, -80.0F)) / r;
}

ESPDIFF_INLINE float sum_of_lanes(const float* sums) {
  double sum = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += static_cast<double>(sums[lane]);
  return static_cast<float>(sum);
}

/// A face of the border: where its points lie in the grid.
struct Face {
  std::size_t first, step[2];              ///< of indices, along its two axes
  int n[2];                                ///< points
  int coarse[2];                           ///< points of the coarse lattice
  float first_coordinate[3], along[2][3];  ///< Angstrom, a step along each axis

  /// Of the coarse lattice. The last points may lie beyond the face, where the sum is valid too.
  ESPDIFF_INLINE Vec3f coarse_point(std::size_t index, int stride) const {
    const int u = static_cast<int>(index % static_cast<std::size_t>(coarse[0])),
              v = static_cast<int>(index / static_cast<std::size_t>(coarse[0]));
    const float a = static_cast<float>(u * stride), b = static_cast<float>(v * stride);
    Vec3f p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = first_coordinate[axis] + a * along[0][axis] + b * along[1][axis];
    return p;
  }
};

struct BorderSums {
  Face face;
  BorderCharges charges;
  int stride;
  float* values;

  ESPDIFF_INLINE Vec3f point(std::size_t index) const { return face.coarse_point(index, stride); }
};

/// The border's points as charges, summed at the atoms or the nodes around them.
struct PlaceSums {
  BorderCharges charges;
  const Vec3f* places;
  float* values;

  ESPDIFF_INLINE Vec3f point(std::size_t index) const { return places[index]; }
};

#if defined(__CUDACC__)

/// A thread for each lane of a point: the same sums as on the CPU.
template <typename Sums>
__global__ void __launch_bounds__(kThreadsPerBlock) sum_lanes_kernel(std::size_t n, Sums sums) {
  __shared__ float of_lane[kThreadsPerBlock];
  const std::size_t lane = threadIdx.x % kLanes,
                    index = (static_cast<std::size_t>(blockIdx.x) * kThreadsPerBlock + threadIdx.x) / kLanes;
  float sum = 0;
  if (index < n) {
    const Vec3f p = sums.point(index);
    for (std::size_t i = lane; i < sums.charges.n; i += kLanes) sum += border_term(sums.charges, i, p);
  }
  of_lane[threadIdx.x] = sum;
  __syncthreads();
  if (lane == 0 && index < n) sums.values[index] = sum_of_lanes(of_lane + threadIdx.x);
}

#else

template <typename Sums>
ESPDIFF_INLINE void sum_points_inline(const Sums& in, std::size_t begin, std::size_t end) {
  for (std::size_t index = begin; index < end; ++index) {
    const Vec3f p = in.point(index);
    float of_lane[kLanes] = {};
    for (std::size_t first = 0; first < in.charges.n; first += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) of_lane[lane] += border_term(in.charges, first + lane, p);
    }
    in.values[index] = sum_of_lanes(of_lane);
  }
}
ESPDIFF_MULTIVERSION void sum_points(const BorderSums& sums, std::size_t first, std::size_t last) {
  sum_points_inline(sums, first, last);
}
ESPDIFF_MULTIVERSION void sum_points(const PlaceSums& sums, std::size_t first, std::size_t last) {
  sum_points_inline(sums, first, last);
}
#endif

/// The sums at the indices below n.
template <typename Sums>
void run_sums(const Sums& sums, std::size_t n) {
#if defined(__CUDACC__)
  if (n == 0) return;
  const std::size_t n_blocks = (n * kLanes + kThreadsPerBlock - 1) / kThreadsPerBlock;
  sum_lanes_kernel<<<static_cast<unsigned>(n_blocks), kThreadsPerBlock, 0, CudaContext::current()->stream()>>>(n, sums);
  check_cuda(cudaGetLastError(), "starting a sum");
#else
  constexpr std::size_t kRun = 16;
  for_each_index((n + kRun - 1) / kRun,
                 [=](std::size_t run) { sum_points(sums, run * kRun, std::min(n, (run + 1) * kRun)); });
#endif
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
  run_sums(sums, n_coarse);
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

int stride_of(const CubicLattice& lattice, const DebyeHueckel& law) {
  return std::max(1, static_cast<int>(std::lround(law.every_A / static_cast<double>(lattice.spacing))));
}

/// Point charges on the device, padded to whole lanes.
struct ChargeArrays {
  Buffer<float> x, y, z, strength;

  ChargeArrays(const std::vector<Vec3f>& places, std::vector<float> strengths) {
    std::vector<float> of_axis[3];
    const std::size_t padded = (strengths.size() + kLanes - 1) / kLanes * kLanes;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3f& p : places) of_axis[axis].push_back(p[axis]);
      of_axis[axis].resize(padded, 0.0F);
    }
    strengths.resize(padded, 0.0F);
    x = to_device(of_axis[0]);
    y = to_device(of_axis[1]);
    z = to_device(of_axis[2]);
    strength = to_device(strengths);
  }
  BorderCharges view(const DebyeHueckel& law) const {
    return {raw(x), raw(y), raw(z), raw(strength), strength.size(), static_cast<float>(law.kappa)};
  }
};

/// scale exp(kappa a) / (1 + kappa a): the strength of a unit charge.
double unit_strength(const PbAtom& atom, const DebyeHueckel& law) {
  const double a = law.kappa * static_cast<double>(atom.radius);
  return law.scale * std::exp(a) / (1 + a);
}

/// The transpose of set_face()'s interpolation: adds the face's points with their gradients, which are used up.
void gather_face(const Face& face, int stride, Buffer<float>& gradient, std::vector<Vec3f>& places,
                 std::vector<float>& strengths) {
  Buffer<float> coarse(static_cast<std::size_t>(face.coarse[0]) * static_cast<std::size_t>(face.coarse[1]));
  float* const of_point = raw(gradient);
  float* const out = raw(coarse);
  for_each_index(coarse.size(), [=] ESPDIFF_HD(std::size_t index) {
    const int at[2] = {static_cast<int>(index % static_cast<std::size_t>(face.coarse[0])),
                       static_cast<int>(index / static_cast<std::size_t>(face.coarse[0]))};
    int low[2], high[2];  // of the face's points that are interpolated from this one, and some more
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = at[axis] > 4 ? (at[axis] - 4) * stride : 0;
      high[axis] = (at[axis] + 4) * stride < face.n[axis] - 1 ? (at[axis] + 4) * stride : face.n[axis] - 1;
    }
    double sum = 0;
    for (int b = low[1]; b <= high[1]; ++b) {
      const CubicPlace v = cubic_place(b, stride, face.coarse[1]);
      if (at[1] < v.first || at[1] > v.first + 3) continue;
      double row = 0;
      for (int a = low[0]; a <= high[0]; ++a) {
        const CubicPlace u = cubic_place(a, stride, face.coarse[0]);
        if (at[0] < u.first || at[0] > u.first + 3) continue;
        row += static_cast<double>(u.weight[at[0] - u.first]) *
               static_cast<double>(of_point[face.first + static_cast<std::size_t>(a) * face.step[0] +
                                            static_cast<std::size_t>(b) * face.step[1]]);
      }
      sum += static_cast<double>(v.weight[at[1] - v.first]) * row;
    }
    out[index] = static_cast<float>(sum);
  });
  const std::vector<float> values = to_host(coarse);
  strengths.insert(strengths.end(), values.begin(), values.end());
  for (std::size_t index = 0; index < values.size(); ++index) places.push_back(face.coarse_point(index, stride));
  for_each_index(static_cast<std::size_t>(face.n[0]) * static_cast<std::size_t>(face.n[1]),
                 [=] ESPDIFF_HD(std::size_t index) {
                   const std::size_t a = index % static_cast<std::size_t>(face.n[0]),
                                     b = index / static_cast<std::size_t>(face.n[0]);
                   of_point[face.first + a * face.step[0] + b * face.step[1]] = 0;
                 });
}

}  // namespace

void set_debye_hueckel_border(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, const DebyeHueckel& law,
                              Buffer<float>& phi) {
  const FarCharges places(atoms, law.nodes_A);
  std::vector<double> strengths;
  for (const PbAtom& atom : atoms) strengths.push_back(static_cast<double>(atom.charge) * unit_strength(atom, law));
  const ChargeArrays charges(places.places(), places.spread(strengths));
  const int stride = stride_of(lattice, law);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true})
      set_face(face_of(lattice, axis, upper, stride), charges.view(law), stride, phi);
  }
}

std::vector<double> debye_hueckel_transposed(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                                             const DebyeHueckel& law, Buffer<float>& gradient) {
  std::vector<Vec3f> places;
  std::vector<float> strengths;
  const int stride = stride_of(lattice, law);
  // A point of two faces has the value of the last one that was set.
  for (int axis = 2; axis >= 0; --axis) {
    for (const bool upper : {true, false})
      gather_face(face_of(lattice, axis, upper, stride), stride, gradient, places, strengths);
  }
  const ChargeArrays border(places, std::move(strengths));
  const FarCharges atom_places(atoms, law.nodes_A);
  const Buffer<Vec3f> sent = to_device(atom_places.places());
  Buffer<float> sums(sent.size());
  const PlaceSums at_places{border.view(law), raw(sent), raw(sums)};
  run_sums(at_places, sums.size());
  std::vector<double> result = atom_places.gather(to_host(sums));
  for (std::size_t i = 0; i < atoms.size(); ++i) result[i] *= unit_strength(atoms[i], law);
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
