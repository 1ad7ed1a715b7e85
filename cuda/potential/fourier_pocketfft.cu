// fourier_pocketfft.cu: the CPU back end's Fourier transforms: pocketfft's one-dimensional transforms, several at once
// as the lanes of vectors, arranged so that the grid passes through the cache three times.
//
// (1) Each slab's rows x (real to complex), then its columns y; (2) lines z forward, times the influence, and back;
// (3) each slab back. A block of modes is kLanes neighbouring columns x at one (y, z). Lanes do not mix, so neither the
// number of threads nor the width of a processor's vectors changes the bits.
#include "cuda/potential/fourier.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "base/error.h"
#include "engine/make_engine.h"

#if defined(ESPDIFF_HAVE_POCKETFFT)
// We bring threads and vectors.
#define POCKETFFT_NO_MULTITHREADING
#define POCKETFFT_NO_VECTORS
#include <pocketfft_hdronly.h>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// 32 bytes of numbers that are transformed together. Unlike the compiler's vectors it needs no alignment, which
/// pocketfft's own work space does not have.
template <typename T>
struct Lanes {
  static constexpr std::size_t kCount = 32 / sizeof(T);
  using Vector __attribute__((vector_size(32))) = T;
  T value[kCount];

  ESPDIFF_INLINE Vector get() const {
    Vector vector;
    std::memcpy(&vector, value, sizeof vector);
    return vector;
  }
  ESPDIFF_INLINE Lanes& set(Vector vector) {
    std::memcpy(value, &vector, sizeof vector);
    return *this;
  }
  ESPDIFF_INLINE Lanes& operator+=(const Lanes& b) { return set(get() + b.get()); }
  ESPDIFF_INLINE Lanes& operator-=(const Lanes& b) { return set(get() - b.get()); }
  ESPDIFF_INLINE Lanes& operator*=(T b) { return set(get() * b); }
  ESPDIFF_INLINE Lanes operator-() const { return Lanes{}.set(-get()); }
  friend ESPDIFF_INLINE Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes{}.set(a.get() + b.get()); }
  friend ESPDIFF_INLINE Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes{}.set(a.get() - b.get()); }
  friend ESPDIFF_INLINE Lanes operator*(const Lanes& a, T b) { return Lanes{}.set(a.get() * b); }
  friend ESPDIFF_INLINE Lanes operator*(T a, const Lanes& b) { return b * a; }
};

template <typename T>
using RealPlan = pocketfft::detail::rfftp<T>;
template <typename T>
using ComplexPlan = pocketfft::detail::cfftp<T>;
/// Modes of neighbouring columns x.
template <typename T>
using Block = pocketfft::detail::cmplx<Lanes<T>>;

// Flattened, so that pocketfft's code is compiled for each instruction set.
#define ESPDIFF_TRANSFORM __attribute__((flatten)) ESPDIFF_MULTIVERSION
ESPDIFF_TRANSFORM void run(const RealPlan<float>& plan, Lanes<float>* line, bool forward) {
  plan.exec(line, 1.0F, forward);
}
ESPDIFF_TRANSFORM void run(const RealPlan<double>& plan, Lanes<double>* line, bool forward) {
  plan.exec(line, 1.0, forward);
}
ESPDIFF_TRANSFORM void run(const ComplexPlan<float>& plan, Block<float>* line, bool forward) {
  plan.exec(line, 1.0F, forward);
}
ESPDIFF_TRANSFORM void run(const ComplexPlan<double>& plan, Block<double>* line, bool forward) {
  plan.exec(line, 1.0, forward);
}
#undef ESPDIFF_TRANSFORM

/// Multiplies a line of blocks along z, whose first column is (x, y), by the influence. Columns beyond the last are
/// left.
template <typename T>
ESPDIFF_INLINE void multiply_line_inline(const Influence<T>& f, Block<T>* line, int x, int y) {
  constexpr int kCount = static_cast<int>(Lanes<T>::kCount);
  const int n = std::min(kCount, f.size[0] / 2 + 1 - x);
  Vec3<T> in_plane[kCount];
  T plane_factor[kCount];
  for (int i = 0; i < n; ++i) {
    in_plane[i] = in_plane_mode(f, x + i, y);
    plane_factor[i] = f.scale * f.spline[0][x + i] * f.spline[1][y];
  }
  for (int z = 0; z < f.size[2]; ++z) {
    for (int i = 0; i < n; ++i) {
      const T factor = influence_at(f, in_plane[i], plane_factor[i], z);
      line[z].r.value[i] *= factor;
      line[z].i.value[i] *= factor;
    }
  }
}
ESPDIFF_MULTIVERSION void multiply_line(const Influence<float>& f, Block<float>* line, int x, int y) {
  multiply_line_inline(f, line, x, y);
}
ESPDIFF_MULTIVERSION void multiply_line(const Influence<double>& f, Block<double>* line, int x, int y) {
  multiply_line_inline(f, line, x, y);
}

/// Number of parts of the work; each has its own scratch space.
constexpr std::size_t kMostParts = 32;

template <typename T>
class PocketfftGrid : public FourierGrid<T> {
  static constexpr std::size_t kLanes = Lanes<T>::kCount;

 public:
  explicit PocketfftGrid(std::array<int, 3> size)
      : nx_(static_cast<std::size_t>(size[0])),
        ny_(static_cast<std::size_t>(size[1])),
        nz_(static_cast<std::size_t>(size[2])),
        blocks_per_row_(nx_ / 2 / kLanes + 1),
        // An odd number of blocks, lest all blocks of a line along z share a few lines of the cache.
        plane_((blocks_per_row_ * ny_) | 1U),
        n_parts_(std::min(nz_, kMostParts)),
        scratch_per_part_(std::max(nx_, 2 * nz_)),
        along_x_(nx_),
        along_y_(ny_),
        along_z_(nz_) {
    values_.resize(nx_ * ny_ * nz_);
    modes_.resize(2 * kLanes * plane_ * nz_);
    scratch_.resize(kLanes * scratch_per_part_ * n_parts_);
  }

  T* values() override { return raw(values_); }
  std::size_t slab_stride() const override { return nx_ * ny_; }

  void convolve(const Influence<T>& influence) override {
    for_each_part(nz_, [this](std::size_t z, Lanes<T>* scratch) { transform_slab(z, scratch); });
    for_each_part(blocks_per_row_ * ny_, [this, &influence](std::size_t line, Lanes<T>* scratch) {
      convolve_line(influence, line, reinterpret_cast<Block<T>*>(scratch));
    });
    for_each_part(nz_, [this](std::size_t z, Lanes<T>* scratch) { transform_slab_back(z, scratch); });
  }

 private:
  /// Calls work(i, scratch) for i < n, in parts that share no scratch space.
  template <typename Work>
  void for_each_part(std::size_t n, const Work& work) {
    for_each_index(n_parts_, [=, &work](std::size_t part) {
      Lanes<T>* const scratch = reinterpret_cast<Lanes<T>*>(raw(scratch_)) + part * scratch_per_part_;
      for (std::size_t i = n * part / n_parts_; i < n * (part + 1) / n_parts_; ++i) work(i, scratch);
    });
  }
  /// Modes of a slab: [block of columns x][y]
  Block<T>* plane(std::size_t z) { return reinterpret_cast<Block<T>*>(raw(modes_)) + z * plane_; }

  void transform_slab(std::size_t z, Lanes<T>* line) {
    for (std::size_t y = 0; y < ny_; y += kLanes) {
      const std::size_t n_rows = std::min(kLanes, ny_ - y);
      const T* const rows = raw(values_) + (z * ny_ + y) * nx_;
      for (std::size_t x = 0; x < nx_; ++x) {
        for (std::size_t i = 0; i < kLanes; ++i) line[x].value[i] = i < n_rows ? rows[i * nx_ + x] : T(0);
      }
      run(along_x_, line, true);
      put_modes(line, plane(z) + y, n_rows);
    }
    for (std::size_t b = 0; b < blocks_per_row_; ++b) run(along_y_, plane(z) + b * ny_, true);
  }
  void transform_slab_back(std::size_t z, Lanes<T>* line) {
    for (std::size_t b = 0; b < blocks_per_row_; ++b) run(along_y_, plane(z) + b * ny_, false);
    for (std::size_t y = 0; y < ny_; y += kLanes) {
      const std::size_t n_rows = std::min(kLanes, ny_ - y);
      take_modes(plane(z) + y, line, n_rows);
      run(along_x_, line, false);
      T* const rows = raw(values_) + (z * ny_ + y) * nx_;
      for (std::size_t i = 0; i < n_rows; ++i) {
        for (std::size_t x = 0; x < nx_; ++x) rows[i * nx_ + x] = line[x].value[i];
      }
    }
  }
  /// From pocketfft's order (r0, r1, i1, r2, i2, ...) of several rows to blocks of columns. Lanes beyond the last
  /// column are transformed with the others, so they must hold numbers.
  void put_modes(const Lanes<T>* line, Block<T>* to, std::size_t n_rows) {
    const Lanes<T> zero{};
    for (std::size_t x = 0; x < blocks_per_row_ * kLanes; ++x) {
      const Lanes<T>& real = x == 0 ? line[0] : 2 * x <= nx_ ? line[2 * x - 1] : zero;
      const Lanes<T>& imaginary = x > 0 && 2 * x < nx_ ? line[2 * x] : zero;
      Block<T>* const column = to + x / kLanes * ny_;
      for (std::size_t i = 0; i < n_rows; ++i) {
        column[i].r.value[x % kLanes] = real.value[i];
        column[i].i.value[x % kLanes] = imaginary.value[i];
      }
    }
  }
  void take_modes(const Block<T>* from, Lanes<T>* line, std::size_t n_rows) {
    for (std::size_t x = 0; 2 * x <= nx_; ++x) {
      const Block<T>* const column = from + x / kLanes * ny_;
      for (std::size_t i = 0; i < kLanes; ++i) {
        const bool there = i < n_rows;
        line[x == 0 ? 0 : 2 * x - 1].value[i] = there ? column[i].r.value[x % kLanes] : T(0);
        if (x > 0 && 2 * x < nx_) line[2 * x].value[i] = there ? column[i].i.value[x % kLanes] : T(0);
      }
    }
  }
  void convolve_line(const Influence<T>& influence, std::size_t line, Block<T>* scratch) {
    for (std::size_t z = 0; z < nz_; ++z) scratch[z] = plane(z)[line];
    run(along_z_, scratch, true);
    multiply_line(influence, scratch, static_cast<int>(line / ny_ * kLanes), static_cast<int>(line % ny_));
    run(along_z_, scratch, false);
    for (std::size_t z = 0; z < nz_; ++z) plane(z)[line] = scratch[z];
  }

  std::size_t nx_, ny_, nz_, blocks_per_row_, plane_, n_parts_, scratch_per_part_;
  Buffer<T> values_, modes_, scratch_;
  RealPlan<T> along_x_;
  ComplexPlan<T> along_y_, along_z_;
};

}  // namespace

template <typename T>
std::unique_ptr<FourierGrid<T>> make_fourier_grid(std::array<int, 3> size) {
  return std::make_unique<PocketfftGrid<T>>(size);
}

Message probe_fourier(bool* available) {
  *available = true;
  return "pocketfft";
}

}  // namespace espdiff::ESPDIFF_BACKEND

#else

namespace espdiff::ESPDIFF_BACKEND {

Message probe_fourier(bool* available) {
  *available = false;
  return "this build has no pocketfft, which the PME potential needs on the CPU; install gemmi-dev (Debian), which "
         "contains it, and build again, or give potential maps as files";
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
