// charge_sums.h: point charges whose potential is summed where it is sampled: isolated ones by Coulomb's law, those of
// a periodic cell by the direct part of Ewald's sum.
#pragma once

#include <array>
#include <vector>

#include "cuda/device/device.h"
#include "cuda/surface/density/bspline.h"
#include "cuda/surface/density/gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Nearer than this to an atom's centre the law of point charges means nothing: shorter distances count as this one.
constexpr double kLeastDistance_A = 0.5;

/// erfc(beta r) is left out beyond beta r = 3.5, where it is 7e-7.
constexpr double kDirectReach = 3.5;

/// erfc(x) for 0 <= x <= 3.5, relative error below 1e-6: e^(-x^2) times a polynomial in 1 / (1 + x / 2), fitted to
/// erfc(x) e^(x^2) on [0, 4] with a relative error of 1.2e-8. No library call: the same bits on both back ends.
ESPDIFF_INLINE float erfc_of_positive(float x) {
  const float t = 1.0F / (1.0F + 0.5F * x);
  float p = -4.97252104e-2F;
  p = p * t + 3.38180327e-1F;
  p = p * t - 8.88142621e-1F;
  p = p * t + 1.01219718F;
  p = p * t - 4.02199778e-1F;
  p = p * t + 4.73359423e-1F;
  p = p * t + 2.27103936e-1F;
  p = p * t + 2.89682458e-1F;
  p = p * t - 4.55706170e-4F;
  return p * exp_of_negative(-x * x);
}

struct PointCharge {
  Vec3d place;    ///< Angstrom; in a cell, parts of its edges (0 to 1) from the lattice's first point
  double charge;  ///< times Coulomb's constant: kT/e A
};

/// What kernels see of the charges.
struct ChargeSumsView {
  const PointCharge* charges;  ///< null where there are none to sum
  const std::uint32_t* first;  ///< [bin + 1] of a cell; null for isolated charges
  std::size_t n;
  bool by_distance;       ///< isolated: the dielectric grows with the distance
  int bins[3], reach[3];  ///< bins along each edge; how many of them the range covers
  Vec3d edges[3];         ///< Angstrom
  double range_square;    ///< Angstrom^2
  float beta;             ///< 1/Angstrom

  /// Isolated charges, at a point in their frame.
  ESPDIFF_INLINE double isolated(Vec3d p) const {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d d = p - charges[i].place;
      const double square = dot(d, d), least = kLeastDistance_A * kLeastDistance_A;
      const double r2 = square > least ? square : least;
      sum += charges[i].charge / (by_distance ? r2 : sqrt(r2));
    }
    return sum;
  }

  /// The direct part of one bin's charges, as seen from `part` where the bin lies `shift` cells away.
  ESPDIFF_INLINE double direct_of_bin(int bin, const double (&part)[3], const double (&shift)[3]) const {
    double sum = 0;
    for (std::uint32_t i = first[bin]; i < first[bin + 1]; ++i) {
      const Vec3d f = charges[i].place;
      const Vec3d d = (part[0] - f.x - shift[0]) * edges[0] + (part[1] - f.y - shift[1]) * edges[1] +
                      (part[2] - f.z - shift[2]) * edges[2];
      const double square = dot(d, d), least = kLeastDistance_A * kLeastDistance_A;
      if (square > range_square) continue;
      const float r = static_cast<float>(sqrt(square > least ? square : least));
      sum += charges[i].charge * static_cast<double>(erfc_of_positive(beta * r) / r);
    }
    return sum;
  }

  /// sum q erfc(beta r) / r over all images within range, at a point given in parts of the edges.
  ESPDIFF_INLINE double direct(const double (&at)[3]) const {
    double part[3];
    int home[3];
    for (int axis = 0; axis < 3; ++axis) {
      part[axis] = wrapped(at[axis], 1);
      const int bin = static_cast<int>(part[axis] * bins[axis]);
      home[axis] = bin < bins[axis] ? bin : bins[axis] - 1;
    }
    double sum = 0, shift[3];
    for (int k = home[2] - reach[2]; k <= home[2] + reach[2]; ++k) {
      const int z = image(k, 2, shift[2]);
      for (int j = home[1] - reach[1]; j <= home[1] + reach[1]; ++j) {
        const int y = image(j, 1, shift[1]);
        for (int i = home[0] - reach[0]; i <= home[0] + reach[0]; ++i) {
          const int x = image(i, 0, shift[0]);
          sum += direct_of_bin(x + bins[0] * (y + bins[1] * z), part, shift);
        }
      }
    }
    return sum;
  }

 private:
  /// A bin's number in the cell, and how many cells away it lies.
  ESPDIFF_INLINE int image(int bin, int axis, double& shift) const {
    const int n_bins = bins[axis];
    const int cell = bin >= 0 ? bin / n_bins : -((n_bins - 1 - bin) / n_bins);
    shift = cell;
    return bin - cell * n_bins;
  }
};

/// The charges on the device. The order of the input does not matter: they are sorted by place and charge.
class ChargeSums {
 public:
  /// Isolated charges. @param scale Coulomb's constant over the dielectric, kT/e A
  ChargeSums(const std::vector<Vec3d>& positions, const std::vector<float>& charges, double scale, bool by_distance);
  /// Charges of a periodic cell. @param parts [atom] in parts of the edges, any image
  ChargeSums(std::vector<PointCharge> parts, const std::array<Vec3d, 3>& edges, double beta);

  ChargeSumsView view() const;

  /// How many charges a sample in a cell adds up, and bins that it looks into.
  double n_terms() const;

 private:
  Buffer<PointCharge> charges_;
  Buffer<std::uint32_t> first_;
  ChargeSumsView shape_{};  ///< all but the pointers
};

}  // namespace espdiff::ESPDIFF_BACKEND
