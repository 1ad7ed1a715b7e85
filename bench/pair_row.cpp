// pair_row.cpp: fills, summarizes and writes the rows of pairs.
#include "pair_row.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "align/geometry/rigid_domains.h"
#include "report/records/metrics.h"

namespace espdiff_bench {
namespace {

/// Rounding of the prototype's figures: half of their last digit.
constexpr double kCorruptRounding = 0.005, kCoverageRounding = 0.05;

/// Members that are summarized and written, in the order of the CSV file's columns.
struct Column {
  const char* name;
  double PairRow::*value;
};
constexpr Column kColumns[] = {
    {"rmsd_A", &PairRow::rmsd_A},
    {"n_vertices", &PairRow::n_vertices},
    {"regularize_iterations", &PairRow::regularize_iterations},
    {"deform_iterations", &PairRow::deform_iterations},
    {"corrupt_percent", &PairRow::corrupt_percent},
    {"flipped_percent", &PairRow::flipped_percent},
    {"mapped_to_target_mean_A", &PairRow::mapped_to_target_mean_A},
    {"mapped_to_target_p95_A", &PairRow::mapped_to_target_p95},
    {"mapped_to_target_max_A", &PairRow::mapped_to_target_max_A},
    {"target_to_mapped_mean_A", &PairRow::target_to_mapped_mean_A},
    {"target_to_mapped_max_A", &PairRow::target_to_mapped_max_A},
    {"no_counterpart_source_percent", &PairRow::no_counterpart_source_percent},
    {"no_counterpart_target_percent", &PairRow::no_counterpart_target_percent},
    {"intersecting_pairs", &PairRow::intersecting_pairs},
    {"same_residue_percent", &PairRow::same_residue_percent},
    {"slip_median_A", &PairRow::slip_median_A},
    {"slip_percent_beyond_2_A", &PairRow::slip_percent_beyond_2_A},
    {"slip_percent_beyond_3_A", &PairRow::slip_percent_beyond_3_A},
    {"trustworthy", &PairRow::trustworthy},
    {"mapped_twice", &PairRow::mapped_twice},
    {"local_motions", &PairRow::local_motions},
    {"round_trip_mean_A", &PairRow::round_trip_mean_A},
    {"round_trip_p95_A", &PairRow::round_trip_p95_A},
    {"steps", &PairRow::steps},
    {"mean_displacement_A", &PairRow::mean_displacement_A},
    {"mean_path_length_A", &PairRow::mean_path_length_A},
    {"area_mapped_A2", &PairRow::area_mapped_A2},
    {"dirichlet_median", &PairRow::dirichlet_median},
    {"dirichlet_p95", &PairRow::dirichlet_p95},
    {"area_ratio_p05", &PairRow::area_ratio_p05},
    {"area_ratio_p95", &PairRow::area_ratio_p95},
    {"irregularity_A", &PairRow::irregularity_A},
    {"cavities_left_out", &PairRow::cavities_left_out},
};
constexpr const char* kStages[] = {"align",  "density", "surface",    "project",     "regularize", "field",
                                   "deform", "morph",   "round trip", "certificate", "metrics",    "total"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

double PairRow::time_of(const std::string& stage) const {
  const auto known =
      std::find_if(time_ms.begin(), time_ms.end(), [&](const auto& entry) { return entry.first == stage; });
  return known == time_ms.end() ? std::numeric_limits<double>::quiet_NaN() : known->second;
}

PairRow make_row(const std::string& name, const espdiff::CompareResult& result) {
  const espdiff::Certificate& c = result.certificate;
  PairRow row;
  row.name = name;
  row.rmsd_A = result.rmsd_A;
  row.n_vertices = static_cast<double>(result.surface.positions.size());
  row.regularize_iterations = result.mapping.regularize.iterations;
  row.deform_iterations = result.mapping.deform.iterations;
  row.converged = c.converged;
  row.corrupt_percent = 100 * c.corrupt_area_fraction;
  row.flipped_percent = 100 * c.flipped_area_fraction;
  row.mapped_to_target_mean_A = c.mapped_to_target.mean;
  row.mapped_to_target_p95 = c.mapped_to_target.p95;
  row.mapped_to_target_max_A = c.mapped_to_target.max;
  row.target_to_mapped_mean_A = c.target_to_mapped.mean;
  row.target_to_mapped_max_A = c.target_to_mapped.max;
  row.no_counterpart_source_percent = 100 * c.unmatched_source;
  row.no_counterpart_target_percent = 100 * c.unmatched_target;
  row.cavities_left_out =
      static_cast<double>(result.source_surface.n_cavities_left_out + result.target_surface.n_cavities_left_out);
  row.intersecting_pairs = static_cast<double>(c.self_intersecting_pairs);
  row.same_residue_percent = 100 * c.same_residue_area_fraction;
  const espdiff::SlipSummary slip = c.slip.value_or(espdiff::SlipSummary{});
  row.slip_median_A = slip.median_A;
  row.slip_percent_beyond_2_A = 100 * slip.medium_area_fraction;
  row.slip_percent_beyond_3_A = 100 * slip.large_area_fraction;
  row.trustworthy = c.trustworthy ? 1 : 0;
  row.mapped_twice = result.mapping.other ? 1 : 0;
  row.local_motions = result.mapping.domains == espdiff::kLocalMotions ? 1 : 0;
  row.round_trip_mean_A = row.round_trip_p95_A = std::numeric_limits<double>::quiet_NaN();
  if (c.round_trip) {
    row.round_trip_mean_A = c.round_trip->mean_A;
    row.round_trip_p95_A = c.round_trip->p95_A;
  }
  row.steps = result.mapping.morph.steps;
  const espdiff::Metrics counted = espdiff::counted_metrics(result);
  row.mean_displacement_A = counted.mean_displacement_A;
  row.mean_path_length_A = counted.mean_path_length_A;
  row.area_mapped_A2 = result.area_mapped_A2;
  row.dirichlet_median = c.distortion.dirichlet_median;
  row.dirichlet_p95 = c.distortion.dirichlet_p95;
  row.area_ratio_p05 = c.distortion.area_ratio_p05;
  row.area_ratio_p95 = c.distortion.area_ratio_p95;
  row.irregularity_A = c.irregularity_A;
  row.time_ms = result.time_ms;
  return row;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

PairRow summarize(const std::vector<PairRow>& rows, Summary summary) {
  const auto sum_up = [&](std::vector<double> values) {
    return summary == Summary::kMedian ? median(values) : *std::max_element(values.begin(), values.end());
  };
  PairRow out;
  for (const Column& column : kColumns) {
    std::vector<double> values;
    for (const PairRow& row : rows) values.push_back(row.*column.value);
    out.*column.value = sum_up(values);
  }
  std::vector<double> totals;
  for (const PairRow& row : rows) totals.push_back(row.time_of("total"));
  out.time_ms = {{"total", sum_up(totals)}};
  out.converged = std::all_of(rows.begin(), rows.end(), [](const PairRow& row) { return row.converged; });
  return out;
}

std::string missed(const PairRow& row) {
  if (!row.prototype) return "";
  char text[96] = "";
  std::string out;
  const double more_corrupt = row.corrupt_percent - row.prototype->corrupt_percent;
  const double farther = row.target_to_mapped_max_A - row.prototype->coverage_max_A;
  if (more_corrupt > kCorruptRounding) {
    std::snprintf(text, sizeof text, "corrupt +%.3f %%", more_corrupt);
    out = text;
  }
  if (farther > kCoverageRounding) {
    std::snprintf(text, sizeof text, "%scoverage +%.2f A", out.empty() ? "" : ", ", farther);
    out += text;
  }
  return out;
}

void print_heading() {
  std::printf("%-26s %5s %7s %10s %8s %8s  %-20s %-13s %-11s %8s   %s\n", "pair", "RMSD", "vertices", "iterations",
              "corrupt%", "flipped%", "mapped to target, A", "back, A", "no cp. %", "ms",
              "prototype: corrupt %, coverage max A");
  std::printf("%-26s %5s %7s %10s %8s %8s  %-20s %-13s %-11s\n", "", "", "", "reg/def", "", "", "mean / 95 % / max",
              "mean / max", "src / tgt");
}

void print_row(const PairRow& row) {
  std::printf(
      "%-26s %5.2f %7.0f %5.0f/%-4.0f%c %8.3f %8.3f  %.4f %.3f %6.2f  %.4f %6.2f  %4.2f %5.2f %5.0f %5.1f %6.3f %4.0f "
      "%7.0f "
      "%8.0f",
      row.name.c_str(), row.rmsd_A, row.n_vertices, row.regularize_iterations, row.deform_iterations,
      row.converged ? ' ' : '!', row.corrupt_percent, row.flipped_percent, row.mapped_to_target_mean_A,
      row.mapped_to_target_p95, row.mapped_to_target_max_A, row.target_to_mapped_mean_A, row.target_to_mapped_max_A,
      row.no_counterpart_source_percent, row.no_counterpart_target_percent, row.intersecting_pairs,
      row.same_residue_percent, row.round_trip_mean_A, row.steps, row.time_of("morph"), row.time_of("total"));
  if (row.prototype) {
    const std::string miss = missed(row);
    std::printf("   %5.2f %5.1f %s", row.prototype->corrupt_percent, row.prototype->coverage_max_A,
                miss.empty() ? "reached" : ("MISSED: " + miss).c_str());
  }
  std::printf("\n");
}

std::string csv_header() {
  std::string header = "pair,field,threads,converged";
  for (const Column& column : kColumns) header += std::string(",") + column.name;
  for (const char* stage : kStages) header += std::string(",") + stage + "_ms";
  return header + ",prototype_rmsd_A,prototype_n_vertices,prototype_corrupt_percent,prototype_coverage_max_A,missed";
}

std::string csv_line(const PairRow& row, const std::string& field, int n_threads) {
  std::ostringstream line;
  line << row.name << ',' << field << ',' << n_threads << ',' << (row.converged ? 1 : 0);
  for (const Column& column : kColumns) line << ',' << number(row.*column.value);
  for (const char* stage : kStages) line << ',' << number(row.time_of(stage));
  if (row.prototype) {
    line << ',' << number(row.prototype->rmsd_A) << ',' << number(row.prototype->n_vertices) << ','
         << number(row.prototype->corrupt_percent) << ',' << number(row.prototype->coverage_max_A) << ",\""
         << missed(row) << '"';
  } else {
    line << ",,,,,";
  }
  return line.str();
}

}  // namespace espdiff_bench
