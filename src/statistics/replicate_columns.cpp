// replicate_columns.cpp: reads a few columns at a time and summarizes each.
#include "statistics/replicate_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/progress.h"
#include "statistics/columns.h"

namespace espdiff {
namespace {

double mean_of(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(values[i])) continue;
    sum += values[i];
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<ReplicateColumns> summarize_columns(const Columns& columns) {
  std::vector<ReplicateColumns> all(columns.n_replicates());
  std::vector<float> values;
  for (std::size_t r = 0; r < all.size(); ++r) {
    ReplicateColumns& replicate = all[r];
    const std::size_t n = columns.n_columns(), n_frames = columns.n_frames(r);
    replicate.n_frames = n_frames;
    replicate.columns.resize(n);
    replicate.first_half.resize(n);
    replicate.second_half.resize(n);
    replicate.blocks.resize(n * kBlocks);
    const std::size_t block_length = n_frames / kBlocks, left_out = n_frames - block_length * kBlocks;
    const std::size_t at_once =
        std::max<std::size_t>(1, kColumnBytes / sizeof(float) / std::max<std::size_t>(1, n_frames));
    for (std::size_t begin = 0; begin < n; begin += at_once) {
      CancelRequest().check();
      const std::size_t end = std::min(n, begin + at_once), width = end - begin;
      columns.read(r, begin, end, values);
#pragma omp parallel for schedule(dynamic, 16)
      for (std::size_t c = begin; c < end; ++c) {
        std::vector<double> series(n_frames);
        for (std::size_t f = 0; f < n_frames; ++f) series[f] = static_cast<double>(values[f * width + c - begin]);
        replicate.columns[c] = summarize_series(series);
        replicate.first_half[c] = mean_of(series, 0, n_frames / 2);
        replicate.second_half[c] = mean_of(series, n_frames / 2, n_frames);
        for (std::size_t b = 0; b < kBlocks; ++b) {
          const std::size_t start = left_out + b * block_length;
          replicate.blocks[c * kBlocks + b] = mean_of(series, start, start + block_length);
        }
      }
    }
  }
  return all;
}

}  // namespace espdiff
