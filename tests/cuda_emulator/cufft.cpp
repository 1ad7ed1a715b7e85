// cufft.cpp: cuFFT's functions that espdiff calls, by pocketfft, on the memory of cuda_emulator/device_memory.h. Made
// into a library of cuFFT's name, which the engine opens as it would open NVIDIA's.
#include <cufft.h>

#define POCKETFFT_NO_MULTITHREADING
#define POCKETFFT_NO_VECTORS
#include <pocketfft_hdronly.h>

#include <complex>
#include <cstddef>
#include <map>
#include <vector>

// streams.h has these; the program that opens this library exports them.
extern "C" void cuda_emulator_put(void* stream, void (*work)(void*), void* data);
extern "C" void* cuda_emulator_view(void* place);
extern "C" void cuda_emulator_mark_written(void* place, unsigned long n_bytes);

namespace {

struct Plan {
  int size[3];
  cufftType type;
  void* stream;
};

struct Transform {
  Plan plan;
  void *in, *out;
};

std::map<cufftHandle, Plan>& plans() {
  static std::map<cufftHandle, Plan> all;
  return all;
}

template <typename Real>
void transform(const Transform& it, bool forward) {
  using Complex = std::complex<Real>;
  const std::vector<std::size_t> size(it.plan.size, it.plan.size + 3);
  const std::size_t rows = size[0] * size[1], columns = size[2], modes = columns / 2 + 1;
  const auto strides = [&](std::size_t row, std::size_t element) {
    const auto at = [&](std::size_t n) { return static_cast<std::ptrdiff_t>(n * element); };
    return std::vector<std::ptrdiff_t>{at(size[1] * row), at(row), at(1)};
  };
  const auto of_values = strides(columns, sizeof(Real)), of_modes = strides(modes, sizeof(Complex));
  void *const in = cuda_emulator_view(it.in), *const out = cuda_emulator_view(it.out);
  if (forward) {
    pocketfft::r2c(size, of_values, of_modes, {0, 1, 2}, true, static_cast<Real*>(in), static_cast<Complex*>(out),
                   Real(1));
  } else {
    pocketfft::c2r(size, of_modes, of_values, {0, 1, 2}, false, static_cast<Complex*>(in), static_cast<Real*>(out),
                   Real(1));
  }
  cuda_emulator_mark_written(it.out, rows * (forward ? modes * sizeof(Complex) : columns * sizeof(Real)));
}

void run(void* data) {
  const Transform it = *static_cast<Transform*>(data);
  delete static_cast<Transform*>(data);
  const bool forward = it.plan.type == CUFFT_R2C || it.plan.type == CUFFT_D2Z;
  if (it.plan.type == CUFFT_R2C || it.plan.type == CUFFT_C2R) {
    transform<float>(it, forward);
  } else {
    transform<double>(it, forward);
  }
}

cufftResult put(cufftHandle handle, cufftType type, void* in, void* out) {
  const auto plan = plans().find(handle);
  if (plan == plans().end()) return CUFFT_INVALID_PLAN;
  if (plan->second.type != type) return CUFFT_INVALID_TYPE;
  cuda_emulator_put(plan->second.stream, run, new Transform{plan->second, in, out});
  return CUFFT_SUCCESS;
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the names are NVIDIA's
#pragma GCC visibility push(default)
extern "C" {

cufftResult cufftPlan3d(cufftHandle* handle, int x, int y, int z, cufftType type) {
  *handle = plans().empty() ? 1 : plans().rbegin()->first + 1;
  plans()[*handle] = {{x, y, z}, type, nullptr};
  return CUFFT_SUCCESS;
}
cufftResult cufftSetStream(cufftHandle handle, cudaStream_t stream) {
  plans().at(handle).stream = stream;
  return CUFFT_SUCCESS;
}
cufftResult cufftDestroy(cufftHandle handle) {
  plans().erase(handle);
  return CUFFT_SUCCESS;
}
cufftResult cufftExecR2C(cufftHandle plan, cufftReal* in, cufftComplex* out) { return put(plan, CUFFT_R2C, in, out); }
cufftResult cufftExecC2R(cufftHandle plan, cufftComplex* in, cufftReal* out) { return put(plan, CUFFT_C2R, in, out); }
cufftResult cufftExecD2Z(cufftHandle plan, cufftDoubleReal* in, cufftDoubleComplex* out) {
  return put(plan, CUFFT_D2Z, in, out);
}
cufftResult cufftExecZ2D(cufftHandle plan, cufftDoubleComplex* in, cufftDoubleReal* out) {
  return put(plan, CUFFT_Z2D, in, out);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
