// matrix_table.cpp: prints the summary of a matrix.
#include "matrix/matrix_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/formatted.h"
#include "matrix/matrix_summary.h"
#include "matrix/write_through_template.h"

namespace espdiff {
namespace {

std::string significant(double value) {
  if (std::isnan(value)) return "-";
  return formatted("%.4g", value);
}

std::string padded(const std::string& text, int width) { return formatted("%-*.200s", width, text.c_str()); }

std::string right(const std::string& text, int width) { return formatted(" %*.100s", width - 1, text.c_str()); }

struct Range {
  double mean = 0;
  const MatrixCell *least = nullptr, *most = nullptr;  ///< null without values
};

Range range_of(const Matrix& matrix, std::size_t metric) {
  Range range;
  std::size_t n = 0;
  for (const MatrixCell& cell : matrix.cells) {
    const double value = cell.values[metric];
    if (std::isnan(value)) continue;
    range.mean += value;
    ++n;
    if (range.least == nullptr || value < range.least->values[metric]) range.least = &cell;
    if (range.most == nullptr || value > range.most->values[metric]) range.most = &cell;
  }
  range.mean = n > 0 ? range.mean / static_cast<double>(n) : std::nan("");
  // Through a template the two directions have opposite signs: what is left of their sum is rounding.
  constexpr double kRounding = 1e-12;
  if (n > 0 && std::fabs(range.mean) < kRounding * std::fabs(range.most->values[metric])) range.mean = 0;
  return range;
}

/// Treats rounding noise as zero.
std::string percent(double fraction) {
  return std::isnan(fraction) ? "-" : significant(fraction < 1e-9 ? 0 : 100 * fraction) + " %";
}

/// Of the column of labels, which those of a region or patch make wider.
int label_width(const Matrix& matrix) {
  std::size_t longest = 0;
  const PartsAndFields compared = matrix.plan.compared();
  for (const std::string& part : compared.parts) longest = std::max(longest, std::string(", ").size() + part.size());
  for (const Quantity& field : compared.fields)
    longest = std::max(longest, std::string(", ").size() + field.name.size());
  return 30 + static_cast<int>(longest);
}

void print_metric(std::ostream& out, const Matrix& matrix, std::size_t m) {
  const Metric& metric = matrix.metrics()[m];
  const Range range = range_of(matrix, m);
  if (range.least == nullptr) return;
  const bool share = metric.unit == MetricUnit::kFraction;
  const auto value = [&](double v) { return share ? percent(v) : significant(v); };
  out << padded("  " + std::string(metric.label), label_width(matrix))
      << padded(share ? "of the area" : unit_of(metric, matrix.plan.potential_unit), 13)
      << right(value(range.least->values[m]), 11) << right(value(range.mean), 11)
      << right(value(range.most->values[m]), 11) << right(percent(asymmetry(matrix, m).mean), 12) << '\n';
}

void print_groups(std::ostream& out, const Matrix& matrix, std::size_t metric) {
  const std::vector<GroupMean> means = group_means(matrix, metric);
  if (means.empty()) return;
  out << "\nMeans of groups (source in rows), " << matrix.metrics()[metric].label << ' '
      << unit_of(matrix.metrics()[metric], matrix.plan.potential_unit) << "\n  ";
  std::vector<std::string> names;
  for (const GroupMean& g : means) {
    if (g.source == means.front().source) names.push_back(g.target);
  }
  out << padded("", 12);
  for (const std::string& name : names) out << right(name, 10);
  for (const GroupMean& g : means) {
    if (g.target == names.front()) out << "\n  " << padded(g.source, 12);
    out << right(significant(g.mean), 10);
  }
  out << '\n';
}

/// Prints the reasons why cells are not trustworthy, without their numbers, and how often each occurs.
void print_trust(std::ostream& out, const Matrix& matrix) {
  std::size_t n_trustworthy = 0, n_failed = 0;
  for (const MatrixCell& cell : matrix.cells) {
    n_trustworthy += cell.trustworthy ? 1 : 0;
    n_failed += cell.error.empty() ? 0 : 1;
  }
  out << '\n' << n_trustworthy << " of " << matrix.cells.size() << " pairs are trustworthy";
  if (n_failed > 0) out << ", " << n_failed << " could not be compared";
  out << (n_trustworthy < matrix.cells.size() ? "; the reasons are in the files\n" : "\n");
}

}  // namespace

void print_matrix(std::ostream& out, const Matrix& matrix, std::size_t metric) {
  out << matrix.n() << " variants, " << matrix.cells.size() << " ordered pairs";
  if (!matrix.plan.potential.empty()) out << ", potentials: " << matrix.plan.potential;
  if (matrix.through)
    out << formatted("\nthrough one template: %s, %zu vertices, %.1f A^2; pairs trust %.1f %% of it (least %.1f %%)",
                     matrix.through->name.c_str(), matrix.through->n_vertices, matrix.through->area_A2,
                     100 * matrix.through->mean_area_fraction, 100 * matrix.through->least_area_fraction);
  if (!matrix.plan.radii_note.empty()) out << "\n" << matrix.plan.radii_note;
  out << "\n\n"
      << padded("Over all pairs", label_width(matrix) + 13) << right("least", 11) << right("mean", 11)
      << right("greatest", 11) << right("asymmetry", 12) << '\n';
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    const MetricSection section = matrix.metrics()[m].section;
    if (section != MetricSection::kCertificate && section != MetricSection::kMapping) print_metric(out, matrix, m);
  }
  const Range range = range_of(matrix, metric);
  if (range.least != nullptr) {
    const auto pair = [&](const MatrixCell& cell) {
      return matrix.plan.variants[cell.source].label + " to " + matrix.plan.variants[cell.target].label;
    };
    out << "\nBy " << matrix.metrics()[metric].label << ": nearest " << pair(*range.least) << ", farthest "
        << pair(*range.most) << '\n';
  }
  print_groups(out, matrix, metric);
  print_trust(out, matrix);
  if (matrix.through) print_through_template(out, matrix);
}

}  // namespace espdiff
