// select_engine.cpp: probes the back ends and makes the engine that was asked for.
#include "engine/select_engine.h"

#include <algorithm>
#include <thread>

#include "base/error.h"
#include "engine/make_engine.h"

namespace espdiff {

DeviceChoice parse_device_choice(const std::string& text) {
  if (text == "auto") return DeviceChoice::kAuto;
  if (text == "cpu") return DeviceChoice::kCpu;
  if (text == "cuda") return DeviceChoice::kCuda;
  throw InputError("unknown device '" + text + "'; use auto, cpu or cuda");
}

BackEndStatus cpu_status() {
  const unsigned n = std::max(1U, std::thread::hardware_concurrency());
  return {"cpu", true, std::to_string(n) + (n == 1 ? " thread" : " threads")};
}

BackEndStatus cuda_status() {
  BackEndStatus status{"cuda", false, ""};
#if defined(ESPDIFF_HAVE_CUDA)
  status.description = cuda_backend::probe_device(&status.available);
#else
  status.description =
      "this build has no CUDA back end; configure with -DESPDIFF_CUDA=ON where nvcc is installed, or use --device cpu";
#endif
  return status;
}

BackEndStatus cpu_fourier_status() {
  BackEndStatus status{"cpu", false, ""};
  status.description = cpu_backend::probe_fourier(&status.available);
  return status;
}

BackEndStatus cuda_fourier_status() {
  BackEndStatus status = cuda_status();
#if defined(ESPDIFF_HAVE_CUDA)
  if (status.available) status.description = cuda_backend::probe_fourier(&status.available);
#endif
  return status;
}

std::unique_ptr<Engine> select_engine(DeviceChoice choice, int n_threads) {
  if (n_threads < 0)
    throw InputError("the number of threads, " + std::to_string(n_threads) + ", is negative; 0 takes all");
  if (choice != DeviceChoice::kCpu) {
    const BackEndStatus cuda = cuda_status();
    if (choice == DeviceChoice::kCuda && !cuda.available) throw DeviceError("--device cuda: " + cuda.description);
#if defined(ESPDIFF_HAVE_CUDA)
    if (cuda.available) return cuda_backend::make_engine(0);
#endif
  }
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return cpu_backend::make_engine(n_threads > 0 ? n_threads : all);
}

}  // namespace espdiff
