// field_result.cpp: means of a quantity by residue.
#include "field/field_result.h"

#include <cmath>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

bool signs_differ(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

}  // namespace

std::vector<ResidueMeans> residue_means(const std::vector<double>& weight, const std::vector<std::int32_t>& residue,
                                        const std::vector<float>& source, const std::vector<float>& target,
                                        std::size_t n_residues) {
  std::vector<ResidueMeans> means(n_residues);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (residue[v] < 0 || weight[v] <= 0) continue;
    ResidueMeans& mean = means[static_cast<std::size_t>(residue[v])];
    const double a = static_cast<double>(source[v]), b = static_cast<double>(target[v]);
    mean.area_A2 += weight[v];
    mean.mean_abs_difference += weight[v] * std::fabs(b - a);
    mean.mean_signed_difference += weight[v] * (b - a);
    mean.mean_source += weight[v] * a;
    mean.mean_target += weight[v] * b;
    mean.sign_change_area_fraction += signs_differ(a, b) ? weight[v] : 0;
  }
  for (ResidueMeans& mean : means) {
    const double scale = mean.area_A2 > 0 ? 1 / mean.area_A2 : kNaN;
    for (double* value : {&mean.mean_abs_difference, &mean.mean_signed_difference, &mean.mean_source, &mean.mean_target,
                          &mean.sign_change_area_fraction})
      *value *= scale;
  }
  return means;
}

}  // namespace espdiff
