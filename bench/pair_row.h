// pair_row.h: the result of one comparison, as a row of a table and as a line of a CSV file.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "certificate/result.h"
#include "real_pairs.h"

namespace espdiff_bench {

struct PairRow {
  std::string name;
  double rmsd_A = 0, n_vertices = 0, regularize_iterations = 0, deform_iterations = 0;
  bool converged = false;
  double corrupt_percent = 0, flipped_percent = 0;
  double mapped_to_target_mean_A = 0, mapped_to_target_p95 = 0, mapped_to_target_max_A = 0;
  double target_to_mapped_mean_A = 0, target_to_mapped_max_A = 0;
  double no_counterpart_source_percent = 0, no_counterpart_target_percent = 0;
  double intersecting_pairs = 0, same_residue_percent = 0, round_trip_mean_A = 0, round_trip_p95_A = 0, steps = 0;
  double mean_displacement_A = 0, mean_path_length_A = 0, area_mapped_A2 = 0, dirichlet_median = 0, dirichlet_p95 = 0;
  double area_ratio_p05 = 0, area_ratio_p95 = 0, irregularity_A = 0;
  double slip_median_A = 0, slip_percent_beyond_2_A = 0, slip_percent_beyond_3_A = 0;
  double trustworthy = 0, mapped_twice = 0, local_motions = 0;  ///< 1 or 0
  double cavities_left_out = 0;                                 ///< of both sides
  std::vector<std::pair<std::string, double>> time_ms;          ///< stage, in order; "total" last
  std::optional<PrototypeRow> prototype;

  double time_of(const std::string& stage) const;  ///< NaN if there is no such stage
};

PairRow make_row(const std::string& name, const espdiff::CompareResult& result);

double median(std::vector<double> values);

enum class Summary { kMedian, kWorst };
/// Median or worst value of each column. Times include only the total.
PairRow summarize(const std::vector<PairRow>& rows, Summary summary);

/// "", or which of the prototype's figures (corrupt area, coverage) the row misses and by how much. Half of their last
/// digit counts as reached.
std::string missed(const PairRow& row);

void print_heading();
void print_row(const PairRow& row);
std::string csv_header();
std::string csv_line(const PairRow& row, const std::string& field, int n_threads);

}  // namespace espdiff_bench
