// state_sums.cpp: one pass over the columns, all pairs of a block at a time.
#include "ensemble/result/state_sums.h"

#include <algorithm>
#include <cmath>

#include "base/progress.h"
#include "ensemble/file/ensemble_file.h"

namespace espdiff {
namespace {

/// The block's sums of two frames. Each is added up by itself first, so that long sums stay exact.
PotentialSums sums_of(const StateBlock& block, std::size_t i, std::size_t j, const double* weights) {
  const double *a = block.values(j), *b = block.values(i), *has_a = block.trusted(j), *has_b = block.trusted(i);
  PotentialSums s;
  for (std::size_t c = 0; c < block.width(); ++c) {
    const double w = weights[c] * has_a[c] * has_b[c], d = b[c] - a[c];
    s.area_A2 += w;
    s.abs_difference += w * std::fabs(d);
    s.squared_difference += w * d * d;
    s.difference += w * d;
    s.sign_change += a[c] * b[c] < 0 ? w : 0;
    s.ab += w * a[c] * b[c];
    s.aa += w * a[c] * a[c];
    s.bb += w * b[c] * b[c];
    s.a += w * a[c];
    s.b += w * b[c];
  }
  return s;
}

double product_of(const StateBlock& block, std::size_t i, std::size_t j, const double* weights) {
  const double *a = block.values(j), *b = block.values(i);
  double sum = 0;
  for (std::size_t c = 0; c < block.width(); ++c) sum += weights[c] * a[c] * b[c];
  return sum;
}

}  // namespace

Metrics StateSums::metrics(std::size_t source, std::size_t target) const {
  PotentialSums sums = pairs[place(std::max(source, target), std::min(source, target))];
  if (source > target) {
    sums.difference = -sums.difference;
    std::swap(sums.aa, sums.bb);
    std::swap(sums.a, sums.b);
  }
  return sums.metrics();
}

void StateBlock::read(std::size_t begin, std::size_t end) {
  width_ = end - begin;
  values_.resize(frames_.size() * width_);
  trusted_.resize(values_.size());
  complete_.assign(width_, 1);
  std::vector<float> all(width_), trusted(width_);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    file_.read_all_values(frames_[i], begin, end, all.data());
    file_.read_values(frames_[i], begin, end, trusted.data());
    for (std::size_t c = 0; c < width_; ++c) {
      const bool is_known = std::isfinite(all[c]);
      values_[i * width_ + c] = is_known ? static_cast<double>(all[c]) : 0;
      trusted_[i * width_ + c] = std::isfinite(trusted[c]) ? 1 : 0;
      if (!is_known) complete_[c] = 0;
    }
  }
}

bool StateBlock::is_complete(std::size_t column) const { return complete_[column] != 0; }

StateSums sum_states(const EnsembleFile& file, const std::vector<std::size_t>& frames,
                     const std::vector<double>& weights) {
  StateSums sums;
  sums.n = frames.size();
  sums.pairs.resize(StateSums::place(sums.n, 0));
  sums.complete.assign(sums.pairs.size(), 0);
  StateBlock block(file, frames);
  for (std::size_t begin = 0; begin < file.n_vertices(); begin += kStateBlock) {
    CancelRequest().check();
    const std::size_t end = std::min(file.n_vertices(), begin + kStateBlock);
    block.read(begin, end);
    std::vector<double> complete(weights.begin() + static_cast<std::ptrdiff_t>(begin),
                                 weights.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t c = 0; c < complete.size(); ++c) {
      if (!block.is_complete(c)) complete[c] = 0;
      sums.complete_area_A2 += complete[c];
    }
#pragma omp parallel for schedule(dynamic, 4)
    for (std::size_t i = 0; i < sums.n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const std::size_t at = StateSums::place(i, j);
        sums.pairs[at] += sums_of(block, i, j, &weights[begin]);
        sums.complete[at] += product_of(block, i, j, complete.data());
      }
    }
  }
  return sums;
}

}  // namespace espdiff
