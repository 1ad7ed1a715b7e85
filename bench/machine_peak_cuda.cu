// machine_peak_cuda.cu: the first GPU's bandwidth and arithmetic.
#include <algorithm>

#include "cuda/device/device.h"
#include "machine_peak.h"

namespace espdiff_bench {

using namespace espdiff::cuda_backend;

MachinePeak cuda_peak() {
  constexpr int kRuns = 5, kSteps = 4096, kChains = 8;
  constexpr std::size_t kElements = std::size_t{1} << 26, kThreads = std::size_t{1} << 20;
  const auto context = std::make_shared<CudaContext>(0);
  const CudaContext::Use use(context);
  Buffer<float> a(kElements, 0.0F), b(kElements, 1.0F), c(kElements, 2.0F);
  float* const to = raw(a);
  const float *const from = raw(b), *const other = raw(c);
  double triad = 1e300, arithmetic = 1e300;
  for (int run = 0; run <= kRuns; ++run) {  // the first run loads the code
    const double copied = context->elapsed_ms(
        [&] { for_each_index(kElements, [=] ESPDIFF_HD(std::size_t i) { to[i] = from[i] + 3.0F * other[i]; }); });
    const double computed = context->elapsed_ms([&] {
      for_each_index(kThreads, [=] ESPDIFF_HD(std::size_t i) {
        float chain[kChains];
        for (int k = 0; k < kChains; ++k) chain[k] = static_cast<float>(k) + from[i];
        for (int step = 0; step < kSteps; ++step) {
          for (int k = 0; k < kChains; ++k) chain[k] = chain[k] * 0.999F + 0.5F;
        }
        float sum = 0;
        for (int k = 0; k < kChains; ++k) sum += chain[k];
        to[i] = sum;
      });
    });
    if (run == 0) continue;
    triad = std::min(triad, copied);
    arithmetic = std::min(arithmetic, computed);
  }
  MachinePeak peak;
  peak.gigabytes_per_s = 12.0 * static_cast<double>(kElements) / triad * 1e-6;
  peak.gigaoperations_per_s = 2.0 * kChains * kSteps * static_cast<double>(kThreads) / arithmetic * 1e-6;
  return peak;
}

}  // namespace espdiff_bench
