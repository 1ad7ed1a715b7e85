// fourier.h: convolution of a periodic grid in Fourier space, by pocketfft on the CPU and cuFFT on a device.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "cuda/device/device.h"
#include "cuda/surface/density/gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Factor of each Fourier mode of the charges: the Ewald sum's factor divided by the splines'.
template <typename T>
struct Influence {
  int size[3];
  Vec3<T> reciprocal[3];  ///< reciprocal edges, 1/A
  T exponent;             ///< -(pi / beta)^2, A^2
  T scale;
  const T* spline[3];  ///< [mode] of each axis; on the device
};

ESPDIFF_INLINE float gaussian_of(float exponent) { return exp_of_negative(exponent > -80.0F ? exponent : -80.0F); }
ESPDIFF_INLINE double gaussian_of(double exponent) { return exp(exponent); }

/// -size/2 < m <= size/2
ESPDIFF_INLINE int signed_mode(int k, int size) { return k <= size / 2 ? k : k - size; }

/// The factors of the modes (x, y, z), z from 0 to its size. The mode m = 0 is 0: a uniform background neutralizes the
/// cell, and the potential's mean is zero.
/// @param in_plane the sum of the first two axes' reciprocal parts, plane_factor their splines' factors times the scale
template <typename T>
ESPDIFF_INLINE T influence_at(const Influence<T>& f, Vec3<T> in_plane, T plane_factor, int z) {
  const Vec3<T> m = in_plane + static_cast<T>(signed_mode(z, f.size[2])) * f.reciprocal[2];
  const T square = dot(m, m);
  const T factor = plane_factor * f.spline[2][z] * gaussian_of(f.exponent * square) / square;
  return square > T(0) ? factor : T(0);
}
template <typename T>
ESPDIFF_INLINE Vec3<T> in_plane_mode(const Influence<T>& f, int x, int y) {
  return static_cast<T>(signed_mode(x, f.size[0])) * f.reciprocal[0] +
         static_cast<T>(signed_mode(y, f.size[1])) * f.reciprocal[1];
}

/// A real periodic grid, x fastest, with the workspace of its transforms. Slabs of constant z begin at multiples of
/// slab_stride().
template <typename T>
class FourierGrid {
 public:
  virtual ~FourierGrid() = default;
  virtual T* values() = 0;
  virtual std::size_t slab_stride() const = 0;
  /// Replaces the values v(n) by sum_m f(m) V(m) e^(2 pi i m.n / size), V(m) = sum_n v(n) e^(-2 pi i m.n / size): no
  /// factor 1 / number of points. The same bits for any number of threads.
  virtual void convolve(const Influence<T>& influence) = 0;
};

/// @throws DeviceError if the back end's FFT library is absent; the message says how to install it
template <typename T>
std::unique_ptr<FourierGrid<T>> make_fourier_grid(std::array<int, 3> size);

}  // namespace espdiff::ESPDIFF_BACKEND
