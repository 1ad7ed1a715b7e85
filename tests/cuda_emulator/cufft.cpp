// cufft.cpp: cuFFT's functions that espdiff calls, by FFTW, on the memory of cuda_emulator/device_memory.h. Made into a
// library of cuFFT's name, which the engine opens as it would open NVIDIA's.
#include <cufft.h>
#include <fftw3.h>

#include <map>

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

template <typename Real, typename Complex, typename MakeForward, typename MakeBack, typename Execute, typename Destroy>
void transform(const Transform& it, bool forward, MakeForward make_forward, MakeBack make_back, Execute execute,
               Destroy destroy) {
  const auto [x, y, z] = it.plan.size;
  void *const in = cuda_emulator_view(it.in), *const out = cuda_emulator_view(it.out);
  const auto plan = forward ? make_forward(x, y, z, static_cast<Real*>(in), static_cast<Complex*>(out), FFTW_ESTIMATE)
                            : make_back(x, y, z, static_cast<Complex*>(in), static_cast<Real*>(out), FFTW_ESTIMATE);
  execute(plan);
  destroy(plan);
  const unsigned long rows = static_cast<unsigned long>(x) * static_cast<unsigned long>(y),
                      columns = static_cast<unsigned long>(z);
  cuda_emulator_mark_written(it.out, rows * (forward ? (columns / 2 + 1) * sizeof(Complex) : columns * sizeof(Real)));
}

void run(void* data) {
  const Transform it = *static_cast<Transform*>(data);
  delete static_cast<Transform*>(data);
  const bool forward = it.plan.type == CUFFT_R2C || it.plan.type == CUFFT_D2Z;
  if (it.plan.type == CUFFT_R2C || it.plan.type == CUFFT_C2R) {
    transform<float, fftwf_complex>(it, forward, fftwf_plan_dft_r2c_3d, fftwf_plan_dft_c2r_3d, fftwf_execute,
                                    fftwf_destroy_plan);
  } else {
    transform<double, fftw_complex>(it, forward, fftw_plan_dft_r2c_3d, fftw_plan_dft_c2r_3d, fftw_execute,
                                    fftw_destroy_plan);
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
