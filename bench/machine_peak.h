// machine_peak.h: a device's peak bandwidth and arithmetic, measured: the roofs of the roofline.
#pragma once

namespace espdiff_bench {

struct MachinePeak {
  double gigabytes_per_s = 0;       ///< a[i] = b[i] + s c[i] over arrays larger than any cache; 12 bytes per element
  double gigaoperations_per_s = 0;  ///< multiplications and additions, not fused, in single precision
};

MachinePeak cpu_peak(int n_threads);
/// Of the first GPU; only in builds with CUDA.
MachinePeak cuda_peak();

}  // namespace espdiff_bench
