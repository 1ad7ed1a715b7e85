// fourier_cufft.cu: the CUDA back end's Fourier transforms: cuFFT, loaded when a potential is first asked for.
//
// libcufft takes 290 MB. If it were linked, every machine that loads the module would need it; linked statically, the
// module would be as large. So it is opened at first use, and its absence is an error that says what to install.
#include "cuda/potential/fourier.h"

#include <cuda_runtime.h>
#include <cufft.h>

#include <string>

#include "base/error.h"
#include "engine/make_engine.h"
#include "system/shared_library.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// cuFFT's functions. Made once; never unloaded, since the driver may still call into it.
class CufftLibrary {
 public:
  static const CufftLibrary& get() {
    static const CufftLibrary library;
    return library;
  }

  decltype(&cufftPlan3d) plan_3d = nullptr;
  decltype(&cufftSetStream) set_stream = nullptr;
  decltype(&cufftDestroy) destroy = nullptr;
  decltype(&cufftExecR2C) forward_float = nullptr;
  decltype(&cufftExecC2R) back_float = nullptr;
  decltype(&cufftExecD2Z) forward_double = nullptr;
  decltype(&cufftExecZ2D) back_double = nullptr;

 private:
  CufftLibrary() {
    const std::string name = "libcufft.so." + std::to_string(CUFFT_VER_MAJOR);
    void* library = nullptr;
    for (const std::string& path : {name, "/usr/local/cuda/lib64/" + name}) {
      if (library == nullptr) library = load_library(path, LibraryUse::kOwn);
    }
    if (library == nullptr) {
      throw DeviceError(name +
                        " was not found, which the PME potential needs on a GPU; install cuFFT of the CUDA toolkit and "
                        "add its folder to LD_LIBRARY_PATH, or use " +
                        option("device", "cpu"));
    }
    load(library, "cufftPlan3d", plan_3d);
    load(library, "cufftSetStream", set_stream);
    load(library, "cufftDestroy", destroy);
    load(library, "cufftExecR2C", forward_float);
    load(library, "cufftExecC2R", back_float);
    load(library, "cufftExecD2Z", forward_double);
    load(library, "cufftExecZ2D", back_double);
  }
  template <typename Function>
  static void load(void* library, const char* name, Function& function) {
    function = find_function<Function>(library, name);
    if (function == nullptr)
      throw DeviceError(std::string("libcufft lacks ") + name + "; install cuFFT " + std::to_string(CUFFT_VER_MAJOR) +
                        " of the CUDA toolkit, or use " + option("device", "cpu"));
  }
};

void check(cufftResult status, const char* what) {
  if (status == CUFFT_SUCCESS) return;
  if (status == CUFFT_ALLOC_FAILED) throw std::bad_alloc();
  throw DeviceError(std::string("cuFFT failed to ") + what + " (code " + std::to_string(static_cast<int>(status)) +
                    "); try " + option("device", "cpu"));
}

/// cuFFT's names for one precision.
template <typename T>
struct Cufft;
template <>
struct Cufft<float> {
  using Complex = cufftComplex;
  static constexpr cufftType kForward = CUFFT_R2C, kBack = CUFFT_C2R;
  static cufftResult run(cufftHandle plan, float* in, Complex* out) {
    return CufftLibrary::get().forward_float(plan, in, out);
  }
  static cufftResult run(cufftHandle plan, Complex* in, float* out) {
    return CufftLibrary::get().back_float(plan, in, out);
  }
};
template <>
struct Cufft<double> {
  using Complex = cufftDoubleComplex;
  static constexpr cufftType kForward = CUFFT_D2Z, kBack = CUFFT_Z2D;
  static cufftResult run(cufftHandle plan, double* in, Complex* out) {
    return CufftLibrary::get().forward_double(plan, in, out);
  }
  static cufftResult run(cufftHandle plan, Complex* in, double* out) {
    return CufftLibrary::get().back_double(plan, in, out);
  }
};

/// A plan on the engine's stream, destroyed with its owner.
class Plan {
 public:
  Plan(std::array<int, 3> size, cufftType type) {
    check(CufftLibrary::get().plan_3d(&handle_, size[2], size[1], size[0], type), "plan a transform");
    const cufftResult status = CufftLibrary::get().set_stream(handle_, CudaContext::current()->stream());
    if (status != CUFFT_SUCCESS) CufftLibrary::get().destroy(handle_);
    check(status, "plan a transform on a stream");
  }
  ~Plan() { CufftLibrary::get().destroy(handle_); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  cufftHandle get() const { return handle_; }

 private:
  cufftHandle handle_{};
};

template <typename T>
class CufftGrid : public FourierGrid<T> {
  using Complex = typename Cufft<T>::Complex;

 public:
  explicit CufftGrid(std::array<int, 3> size)
      : slab_(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])),
        forward_(size, Cufft<T>::kForward),
        back_(size, Cufft<T>::kBack) {
    const std::size_t nz = static_cast<std::size_t>(size[2]);
    values_.resize(slab_ * nz);
    modes_.resize(static_cast<std::size_t>(size[0] / 2 + 1) * static_cast<std::size_t>(size[1]) * nz);
  }

  T* values() override { return raw(values_); }
  std::size_t slab_stride() const override { return slab_; }

  void convolve(const Influence<T>& influence) override {
    check(Cufft<T>::run(forward_.get(), raw(values_), raw(modes_)), "transform a grid");
    multiply(influence);
    check(Cufft<T>::run(back_.get(), raw(modes_), raw(values_)), "transform a grid back");
  }

  /// Public for nvcc, which takes no device lambda in a private function.
  void multiply(const Influence<T>& influence) {
    Complex* const modes = raw(modes_);
    const Influence<T> f = influence;
    for_each_index(modes_.size(), [=] ESPDIFF_HD(std::size_t i) {
      const std::size_t nx = static_cast<std::size_t>(f.size[0] / 2 + 1), ny = static_cast<std::size_t>(f.size[1]);
      const int x = static_cast<int>(i % nx), y = static_cast<int>(i / nx % ny), z = static_cast<int>(i / (nx * ny));
      const T plane_factor = f.scale * f.spline[0][x] * f.spline[1][y];
      const T factor = influence_at(f, in_plane_mode(f, x, y), plane_factor, z);
      modes[i].x *= factor;
      modes[i].y *= factor;
    });
  }

 private:
  std::size_t slab_;
  Plan forward_, back_;
  Buffer<T> values_;
  Buffer<Complex> modes_;
};

}  // namespace

Message probe_fourier(bool* available) {
  try {
    CufftLibrary::get();
    *available = true;
    return "cuFFT " + std::to_string(CUFFT_VER_MAJOR);
  } catch (const DeviceError& error) {
    *available = false;
    return error.message();
  }
}

template <typename T>
std::unique_ptr<FourierGrid<T>> make_fourier_grid(std::array<int, 3> size) {
  return std::make_unique<CufftGrid<T>>(size);
}
template std::unique_ptr<FourierGrid<float>> make_fourier_grid(std::array<int, 3> size);
template std::unique_ptr<FourierGrid<double>> make_fourier_grid(std::array<int, 3> size);

}  // namespace espdiff::ESPDIFF_BACKEND
