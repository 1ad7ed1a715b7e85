// fourier_fftw.cu: the CPU back end's Fourier transforms: FFTW's one-dimensional transforms, arranged so that the grid
// passes through the cache three times.
//
// FFTW's own three-dimensional plans take twice as long if estimated; measured plans depend on the machine's load.
// Here: (1) each slab's rows x (real to complex), then its columns y; (2) blocks of columns z forward, times the
// influence, and back; (3) each slab back. All slabs and blocks share one plan, so the bits do not depend on the number
// of threads.
#include "cuda/potential/fourier.h"

#include <algorithm>
#include <mutex>
#include <string>

#include "base/error.h"
#include "engine/make_engine.h"

#if defined(ESPDIFF_HAVE_FFTW)
#include <fftw3.h>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// FFTW's names for one precision.
template <typename T>
struct Fftw;
template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static void destroy(Plan plan) { fftwf_destroy_plan(plan); }
  static Plan rows(int n, int rows, float* in, Complex* out, int complex_row) {
    return fftwf_plan_many_dft_r2c(1, &n, rows, in, nullptr, 1, n, out, nullptr, 1, complex_row, FFTW_ESTIMATE);
  }
  static Plan rows_back(int n, int rows, Complex* in, float* out, int complex_row) {
    return fftwf_plan_many_dft_c2r(1, &n, rows, in, nullptr, 1, complex_row, out, nullptr, 1, n, FFTW_ESTIMATE);
  }
  static Plan columns(int n, int columns, Complex* in, int in_stride, int in_next, Complex* out, int out_stride,
                      int out_next, int sign) {
    return fftwf_plan_many_dft(1, &n, columns, in, nullptr, in_stride, in_next, out, nullptr, out_stride, out_next,
                               sign, FFTW_ESTIMATE);
  }
  static void run(Plan plan, float* in, Complex* out) { fftwf_execute_dft_r2c(plan, in, out); }
  static void run(Plan plan, Complex* in, float* out) { fftwf_execute_dft_c2r(plan, in, out); }
  static void run(Plan plan, Complex* in, Complex* out) { fftwf_execute_dft(plan, in, out); }
};
template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static void destroy(Plan plan) { fftw_destroy_plan(plan); }
  static Plan rows(int n, int rows, double* in, Complex* out, int complex_row) {
    return fftw_plan_many_dft_r2c(1, &n, rows, in, nullptr, 1, n, out, nullptr, 1, complex_row, FFTW_ESTIMATE);
  }
  static Plan rows_back(int n, int rows, Complex* in, double* out, int complex_row) {
    return fftw_plan_many_dft_c2r(1, &n, rows, in, nullptr, 1, complex_row, out, nullptr, 1, n, FFTW_ESTIMATE);
  }
  static Plan columns(int n, int columns, Complex* in, int in_stride, int in_next, Complex* out, int out_stride,
                      int out_next, int sign) {
    return fftw_plan_many_dft(1, &n, columns, in, nullptr, in_stride, in_next, out, nullptr, out_stride, out_next, sign,
                              FFTW_ESTIMATE);
  }
  static void run(Plan plan, double* in, Complex* out) { fftw_execute_dft_r2c(plan, in, out); }
  static void run(Plan plan, Complex* in, double* out) { fftw_execute_dft_c2r(plan, in, out); }
  static void run(Plan plan, Complex* in, Complex* out) { fftw_execute_dft(plan, in, out); }
};

/// FFTW is thread-safe only in executing plans.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

/// Columns that are transformed together.
constexpr std::size_t kBlock = 16;
/// Number of parts of the work; each has its own scratch space.
constexpr std::size_t kMostParts = 32;

/// Multiplies a block of columns [column][z] by the influence.
template <typename T>
ESPDIFF_INLINE void multiply_columns_inline(const Influence<T>& f, T (*modes)[2], std::size_t first, std::size_t n) {
  const std::size_t nx = static_cast<std::size_t>(f.size[0]) / 2 + 1;
  const int nz = f.size[2];
  for (std::size_t c = 0; c < n; ++c) {
    const int x = static_cast<int>((first + c) % nx), y = static_cast<int>((first + c) / nx);
    const Vec3<T> in_plane = in_plane_mode(f, x, y);
    const T plane_factor = f.scale * f.spline[0][x] * f.spline[1][y];
    T(*const column)[2] = modes + c * static_cast<std::size_t>(nz);
    for (int z = 0; z < nz; ++z) {
      const T factor = influence_at(f, in_plane, plane_factor, z);
      column[z][0] *= factor;
      column[z][1] *= factor;
    }
  }
}
ESPDIFF_MULTIVERSION void multiply_columns(const Influence<float>& f, float (*modes)[2], std::size_t first,
                                           std::size_t n) {
  multiply_columns_inline(f, modes, first, n);
}
ESPDIFF_MULTIVERSION void multiply_columns(const Influence<double>& f, double (*modes)[2], std::size_t first,
                                           std::size_t n) {
  multiply_columns_inline(f, modes, first, n);
}

template <typename T>
class FftwGrid : public FourierGrid<T> {
  using Complex = typename Fftw<T>::Complex;
  using Plan = typename Fftw<T>::Plan;

 public:
  explicit FftwGrid(std::array<int, 3> size) : size_(size) {
    const std::size_t nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]),
                      nz = static_cast<std::size_t>(size[2]);
    complex_row_ = nx / 2 + 1;
    // Slabs begin at cache lines, and at an odd number of blocks from each other, lest all points of a column share a
    // few lines of the cache.
    slab_ = odd_multiple(nx * ny);
    plane_ = odd_multiple(complex_row_ * ny);
    n_parts_ = std::min(nz, kMostParts);
    // One more block, so that an address aligned for FFTW's plans exists.
    // The gaps between slabs and columns are transformed too, so they must hold numbers.
    values_.assign(slab_ * nz + kBlock, T(0));
    modes_.assign(2 * plane_ * nz + kBlock, T(0));
    scratch_per_part_ = 2 * std::max(plane_, kBlock * nz);
    scratch_.assign(scratch_per_part_ * n_parts_ + kBlock, T(0));
    make_plans();
  }
  ~FftwGrid() override {
    const std::lock_guard<std::mutex> lock(planner());
    for (Plan plan : {rows_, rows_back_, y_, y_back_, z_, z_back_}) {
      if (plan != nullptr) Fftw<T>::destroy(plan);
    }
  }
  FftwGrid(const FftwGrid&) = delete;
  FftwGrid& operator=(const FftwGrid&) = delete;

  T* values() override { return aligned(values_); }
  std::size_t slab_stride() const override { return slab_; }

  void convolve(const Influence<T>& influence) override {
    const std::size_t nz = static_cast<std::size_t>(size_[2]), n_parts = n_parts_;
    for_each_index(n_parts, [=](std::size_t part) {
      for (std::size_t z = nz * part / n_parts; z < nz * (part + 1) / n_parts; ++z) {
        Fftw<T>::run(rows_, values() + z * slab_, scratch(part));
        Fftw<T>::run(y_, scratch(part), modes() + z * plane_);
      }
    });
    const std::size_t n_blocks = plane_ / kBlock, n_columns = complex_row_ * static_cast<std::size_t>(size_[1]);
    for_each_index(n_parts, [=](std::size_t part) {
      for (std::size_t b = n_blocks * part / n_parts; b < n_blocks * (part + 1) / n_parts; ++b) {
        Complex* const block = modes() + b * kBlock;
        if (b * kBlock >= n_columns) continue;
        Fftw<T>::run(z_, block, scratch(part));
        multiply_columns(influence, scratch(part), b * kBlock, std::min(kBlock, n_columns - b * kBlock));
        Fftw<T>::run(z_back_, scratch(part), block);
      }
    });
    for_each_index(n_parts, [=](std::size_t part) {
      for (std::size_t z = nz * part / n_parts; z < nz * (part + 1) / n_parts; ++z) {
        Fftw<T>::run(y_back_, modes() + z * plane_, scratch(part));
        Fftw<T>::run(rows_back_, scratch(part), values() + z * slab_);
      }
    });
  }

 private:
  static std::size_t odd_multiple(std::size_t n) {
    const std::size_t blocks = (n + kBlock - 1) / kBlock;
    return (blocks % 2 == 0 ? blocks + 1 : blocks) * kBlock;
  }
  static T* aligned(Buffer<T>& buffer) {
    constexpr std::size_t kCacheLine = 64;
    const std::size_t address = reinterpret_cast<std::size_t>(raw(buffer));
    return raw(buffer) + (kCacheLine - address % kCacheLine) % kCacheLine / sizeof(T);
  }
  Complex* modes() { return reinterpret_cast<Complex*>(aligned(modes_)); }
  Complex* scratch(std::size_t part) {
    return reinterpret_cast<Complex*>(aligned(scratch_) + part * scratch_per_part_);
  }

  void make_plans() {
    const std::lock_guard<std::mutex> lock(planner());
    const int nx = size_[0], ny = size_[1], nz = size_[2], row = static_cast<int>(complex_row_),
              plane = static_cast<int>(plane_), block = static_cast<int>(kBlock);
    Complex* const modes_at = modes();
    Complex* const scratch_at = scratch(0);
    rows_ = Fftw<T>::rows(nx, ny, values(), scratch_at, row);
    rows_back_ = Fftw<T>::rows_back(nx, ny, scratch_at, values(), row);
    y_ = Fftw<T>::columns(ny, row, scratch_at, row, 1, modes_at, row, 1, FFTW_FORWARD);
    y_back_ = Fftw<T>::columns(ny, row, modes_at, row, 1, scratch_at, row, 1, FFTW_BACKWARD);
    z_ = Fftw<T>::columns(nz, block, modes_at, plane, 1, scratch_at, 1, nz, FFTW_FORWARD);
    z_back_ = Fftw<T>::columns(nz, block, scratch_at, 1, nz, modes_at, plane, 1, FFTW_BACKWARD);
    for (Plan plan : {rows_, rows_back_, y_, y_back_, z_, z_back_}) {
      if (plan == nullptr) throw Error(ErrorClass::kInternal, "FFTW made no plan for a grid; please report its size");
    }
  }

  std::array<int, 3> size_;
  std::size_t complex_row_ = 0, slab_ = 0, plane_ = 0, n_parts_ = 0, scratch_per_part_ = 0;
  Buffer<T> values_, modes_, scratch_;
  Plan rows_{}, rows_back_{}, y_{}, y_back_{}, z_{}, z_back_{};
};

}  // namespace

template <typename T>
std::unique_ptr<FourierGrid<T>> make_fourier_grid(std::array<int, 3> size) {
  return std::make_unique<FftwGrid<T>>(size);
}

Message probe_fourier(bool* available) {
  *available = true;
  return fftwf_version;
}

}  // namespace espdiff::ESPDIFF_BACKEND

#else

namespace espdiff::ESPDIFF_BACKEND {

Message probe_fourier(bool* available) {
  *available = false;
  return "this build has no FFTW, which the PME potential needs on the CPU; install libfftw3-dev (Debian) and build "
         "again, or give potential maps as files";
}

template <typename T>
std::unique_ptr<FourierGrid<T>> make_fourier_grid(std::array<int, 3>) {
  bool available = false;
  throw DeviceError(probe_fourier(&available));
}

}  // namespace espdiff::ESPDIFF_BACKEND

#endif

namespace espdiff::ESPDIFF_BACKEND {

template std::unique_ptr<FourierGrid<float>> make_fourier_grid(std::array<int, 3> size);
template std::unique_ptr<FourierGrid<double>> make_fourier_grid(std::array<int, 3> size);

}  // namespace espdiff::ESPDIFF_BACKEND
