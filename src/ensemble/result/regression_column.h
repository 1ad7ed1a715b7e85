// regression_column.h: the user's values of replicates, and what a regression on them says.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensemble/frames/ensemble_plan.h"
#include "statistics/regression.h"
#include "statistics/surface/patches.h"

namespace espdiff {

/// A column of a table: one value for each replicate.
struct RegressionColumn {
  std::string name;
  std::vector<double> values{};  ///< [replicate]; NaN where the table has none
};

/// A regression on the surface, with its significant patches.
struct EnsembleRegression {
  RegressionColumn column;
  SurfaceRegression surface;
  struct Patch {
    SignificantPatch patch;
    double correlation = 0, slope = 0;                       ///< area-weighted means
    double smallest_p = 1;                                   ///< family-wise
    std::vector<std::pair<std::string, double>> residues{};  ///< shares of the area, largest first
  };
  std::vector<Patch> patches{};
};

/// Reads FILE.csv:COLUMN. The table has the columns `replicate`, `group` unless names of replicates are unique, and
/// COLUMN; a replicate without a row, or with an empty field, does not count.
/// @throws InputError (no column is named; a row that is no replicate, or the same one twice), as read_csv()
RegressionColumn read_regression_column(const std::string& text, const EnsemblePlan& plan);

}  // namespace espdiff
