// machine_peak.cpp: the CPU's bandwidth and arithmetic.
#include "machine_peak.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

namespace espdiff_bench {
namespace {

constexpr int kRuns = 5;
constexpr std::size_t kElements = std::size_t{1} << 24;  // 64 MiB per array

/// Seconds of the fastest of several runs.
template <typename Work>
double fastest(Work work) {
  double least = 1e300;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

constexpr int kSteps = 2000000;
// Independent chains hide the instructions' latency of eight cycles; more would not fit into sixteen registers.
constexpr int kChains = 12;

using FourLanes = float __attribute__((vector_size(16)));
using EightLanes = float __attribute__((vector_size(32)));
using SixteenLanes = float __attribute__((vector_size(64)));

/// Chains of a multiplication and an addition on vectors.
template <typename Lanes>
[[gnu::always_inline]] inline float multiply_and_add(float factor, float summand) {
  Lanes chain[kChains];
  for (int c = 0; c < kChains; ++c) chain[c] = Lanes{} + static_cast<float>(c);
  for (int step = 0; step < kSteps; ++step) {
    for (int c = 0; c < kChains; ++c) chain[c] = chain[c] * factor + summand;
  }
  float sum = 0;
  for (int c = 0; c < kChains; ++c) sum += chain[c][0] + chain[c][1];
  return sum;
}

struct Chains {
  int n_lanes;
  float (*run)(float factor, float summand);
};

float chains_of_4(float factor, float summand) { return multiply_and_add<FourLanes>(factor, summand); }
#if defined(__x86_64__)
[[gnu::target("arch=x86-64-v3")]] float chains_of_8(float factor, float summand) {
  return multiply_and_add<EightLanes>(factor, summand);
}
[[gnu::target("arch=x86-64-v4")]] float chains_of_16(float factor, float summand) {
  return multiply_and_add<SixteenLanes>(factor, summand);
}
#endif

/// On the widest vectors of this processor.
Chains widest() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("x86-64-v4") != 0) return {16, chains_of_16};
  if (__builtin_cpu_supports("x86-64-v3") != 0) return {8, chains_of_8};
#endif
  return {4, chains_of_4};
}

}  // namespace

MachinePeak cpu_peak(int n_threads) {
  const int usual = omp_get_max_threads();
  omp_set_num_threads(n_threads);
  const long n = static_cast<long>(kElements);
  const std::unique_ptr<float[]> a(new float[kElements]), b(new float[kElements]), c(new float[kElements]);
#pragma omp parallel for schedule(static)
  for (long i = 0; i < n; ++i) {
    a[static_cast<std::size_t>(i)] = 0.0F;
    b[static_cast<std::size_t>(i)] = 1.0F;
    c[static_cast<std::size_t>(i)] = 2.0F;
  }
  float *const to = a.get(), *const from = b.get(), *const other = c.get();
  const double triad = fastest([&] {
#pragma omp parallel for simd schedule(static)
    for (long i = 0; i < n; ++i) to[i] = from[i] + 3.0F * other[i];
  });
  std::vector<float> results(static_cast<std::size_t>(n_threads));
  const Chains chains = widest();
  const double arithmetic = fastest([&] {
#pragma omp parallel
    results[static_cast<std::size_t>(omp_get_thread_num())] = chains.run(0.999F, 0.5F);
  });
  omp_set_num_threads(usual);
  MachinePeak peak;
  peak.gigabytes_per_s = 12.0 * static_cast<double>(kElements) / triad * 1e-9;
  peak.gigaoperations_per_s = 2.0 * chains.n_lanes * kChains * kSteps * n_threads / arithmetic * 1e-9;
  return results[0] > -1e30F ? peak : MachinePeak{};
}

}  // namespace espdiff_bench
