// through_template.cpp: exact pairs beside a matrix through a template.
#include "matrix/through_template.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "matrix/matrix_summary.h"

namespace espdiff {

bool is_given_by_template(const Metric& metric) {
  const bool is_share = metric.json_pointer().find("/trusted_area_fraction/") != std::string::npos;
  return is_share || (metric.section == MetricSection::kPotential && metric.source.of_area != nullptr);
}

std::vector<TemplateAgreement> agreement(const Matrix& matrix) {
  std::vector<TemplateAgreement> all;
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    if (!matrix.gives(m)) continue;
    TemplateAgreement of;
    of.metric = m;
    std::vector<double> exact, through;
    for (const MatrixCell& cell : matrix.through->exact) {
      const double own = cell.values[m], other = matrix.value(m, cell.source, cell.target);
      if (!std::isfinite(own) || !std::isfinite(other)) continue;
      const double difference = std::fabs(own - other);
      if (exact.empty() || difference > of.largest_difference) {
        of.largest_difference = difference;
        of.farthest = {cell.source, cell.target};
      }
      of.mean_difference += difference;
      exact.push_back(own);
      through.push_back(other);
      of.exact_mean += own;
      of.template_mean += other;
    }
    of.n = exact.size();
    if (of.n == 0) continue;
    for (double* const sum : {&of.mean_difference, &of.exact_mean, &of.template_mean})
      *sum /= static_cast<double>(of.n);
    of.correlation = correlation(exact, through);
    all.push_back(of);
  }
  return all;
}

}  // namespace espdiff
