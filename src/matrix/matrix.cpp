// matrix.cpp: the order of the pairs, and a series for each source.
#include "matrix/matrix.h"

#include <cmath>
#include <limits>
#include <memory>

#include "base/error.h"
#include "compare/result.h"
#include "compare/series.h"
#include "engine/certificate_stage.h"
#include "io/text_cursor.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <double Metrics::*Member>
double of_metrics(const CompareResult& result) {
  return result.has_potential ? result.metrics.*Member : kNan;
}

template <double Certificate::*Member>
double of_certificate(const CompareResult& result) {
  return result.certificate.*Member;
}

std::vector<MatrixMetric> make_metrics() {
  using U = MetricUnit;
  using R = const CompareResult&;
  return {
      {"rmsd_A", "RMSD", U::kAngstrom, false, false, [](R r) { return r.rmsd_A; }},
      {"mean_abs_difference", "Mean absolute difference", U::kPotential, true, false,
       of_metrics<&Metrics::mean_abs_difference>},
      {"rms_difference", "RMS difference", U::kPotential, true, false, of_metrics<&Metrics::rms_difference>},
      {"mean_signed_difference", "Mean signed difference", U::kPotential, true, true,
       of_metrics<&Metrics::mean_signed_difference>},
      {"sign_change_area_fraction", "Area whose sign changes", U::kFraction, true, false,
       of_metrics<&Metrics::sign_change_area_fraction>},
      {"hodgkin_index", "Hodgkin index", U::kIndex, true, false, of_metrics<&Metrics::hodgkin_index>},
      {"carbo_index", "Carbo index", U::kIndex, true, false, of_metrics<&Metrics::carbo_index>},
      {"mean_displacement_A", "Mean displacement", U::kAngstrom, false, false,
       [](R r) { return counted_surface(r).mean_displacement_A; }},
      {"area_mapped_A2", "Area of the mapped surface", U::kSquareAngstrom, false, false,
       [](R r) { return r.area_mapped_A2; }},
      {"corrupt_area_fraction", "Corrupt area", U::kFraction, false, false,
       of_certificate<&Certificate::corrupt_area_fraction>},
      {"flipped_area_fraction", "Flipped area", U::kFraction, false, false,
       of_certificate<&Certificate::flipped_area_fraction>},
      {"self_intersecting_pairs", "Intersecting pairs of triangles", U::kCount, false, false,
       [](R r) { return static_cast<double>(r.certificate.self_intersecting_pairs); }},
      {"no_counterpart_source", "Area without counterpart, source", U::kFraction, false, false,
       of_certificate<&Certificate::unmatched_source>},
      {"no_counterpart_target", "Area without counterpart, target", U::kFraction, false, false,
       of_certificate<&Certificate::unmatched_target>},
      {"mapped_to_target_mean_A", "Distance of the mapped surface to the target", U::kAngstrom, false, false,
       [](R r) { return r.certificate.mapped_to_target.mean; }},
      {"target_to_mapped_mean_A", "Distance of the target to the mapped surface", U::kAngstrom, false, false,
       [](R r) { return r.certificate.target_to_mapped.mean; }},
      {"target_to_mapped_max_A", "Greatest distance of the target to the mapped surface", U::kAngstrom, false, false,
       [](R r) { return r.certificate.target_to_mapped.max; }},
      {"same_residue_area_fraction", "Area on the same residue", U::kFraction, false, false,
       of_certificate<&Certificate::same_residue_area_fraction>},
      {"iterations", "Iterations or steps", U::kCount, false, false,
       [](R r) {
         return static_cast<double>(r.morph_report.steps > 0 ? r.morph_report.steps : r.deform_report.iterations);
       }},
  };
}

MatrixCell cell_of(const MatrixPair& pair, const CompareResult& result) {
  MatrixCell cell;
  cell.source = pair.first;
  cell.target = pair.second;
  for (const MatrixMetric& metric : matrix_metrics()) {
    const double value = metric.of(result);
    cell.values.push_back(std::isfinite(value) ? value : kNan);
  }
  cell.converged = result.certificate.converged;
  cell.trustworthy = result.certificate.trustworthy;
  cell.reasons = result.certificate.reasons;
  return cell;
}

MatrixCell failed_cell(const MatrixPair& pair, const std::string& error) {
  MatrixCell cell;
  cell.source = pair.first;
  cell.target = pair.second;
  cell.values.assign(matrix_metrics().size(), kNan);
  cell.error = error;
  return cell;
}

CompareInput input_of(const Variant& variant) {
  return {&variant.molecule, variant.map ? &*variant.map : nullptr, variant.make_map};
}

}  // namespace

const std::vector<MatrixMetric>& matrix_metrics() {
  static const std::vector<MatrixMetric> all = make_metrics();
  return all;
}

std::size_t find_metric(const std::string& name) {
  std::string list;
  for (std::size_t i = 0; i < matrix_metrics().size(); ++i) {
    if (matrix_metrics()[i].name == name) return i;
    list += (list.empty() ? "" : ", ") + std::string(matrix_metrics()[i].name);
  }
  throw InputError("there is no metric '" + name + "'; there are: " + list);
}

std::string unit_of(const MatrixMetric& metric, const std::string& potential_unit) {
  switch (metric.unit) {
    case MetricUnit::kPotential: return potential_unit;
    case MetricUnit::kAngstrom: return "A";
    case MetricUnit::kSquareAngstrom: return "A^2";
    case MetricUnit::kFraction:
    case MetricUnit::kIndex:
    case MetricUnit::kCount: break;
  }
  return "";
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  long long index = 0, count = 0;
  if (slash == std::string::npos || !parse_integer(text.substr(0, slash), index) ||
      !parse_integer(text.substr(slash + 1), count) || count < 1 || index < 1 || index > count || count > 1000000)
    throw InputError("shard: " + in_quotes(text) + " is not i/n with i from 1 to n, such as 2/8");
  return {static_cast<int>(index), static_cast<int>(count)};
}

std::vector<MatrixPair> matrix_pairs(std::size_t n_variants, const Shard& shard) {
  const std::size_t n = n_variants < 2 ? 0 : n_variants * (n_variants - 1);
  const auto count = static_cast<std::size_t>(shard.count), index = static_cast<std::size_t>(shard.index);
  std::vector<MatrixPair> pairs;
  for (std::size_t p = (index - 1) * n / count; p < index * n / count; ++p) {
    const std::size_t source = p / (n_variants - 1), rest = p % (n_variants - 1);
    pairs.emplace_back(source, rest < source ? rest : rest + 1);
  }
  return pairs;
}

void compute_pairs(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                   const std::vector<MatrixPair>& pairs, bool skip_errors,
                   const std::function<void(const MatrixCell&)>& done, const Progress& progress) {
  std::unique_ptr<Series> series;
  std::size_t prepared = variants.size();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Variant &source = variants.at(pairs[p].first), &target = variants.at(pairs[p].second);
    const std::string name = source.label + " to " + target.label;
    // A pair's stages each begin at 0 again: the whole run's bar moves on with pairs only.
    const Progress stages([&](const std::string& stage, double) {
      progress.report(name + ": " + stage, static_cast<double>(p) / static_cast<double>(pairs.size()));
    });
    MatrixCell cell;
    try {
      if (prepared != pairs[p].first) {
        series = std::make_unique<Series>(engine, input_of(source), options);
        prepared = pairs[p].first;
      }
      cell = cell_of(pairs[p], series->step(input_of(target), StartFrom::kSource, stages));
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (!skip_errors) throw Error(error.error_class(), name + ": " + error.what());
      cell = failed_cell(pairs[p], error.what());
    }
    done(cell);
  }
  progress.report("pairs", 1.0);
}

}  // namespace espdiff
