// ensemble_options.h: the options of an ensemble's statistics; each is a member and its row.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/option_row.h"
#include "ensemble/file/ensemble_columns.h"
#include "ensemble/result/regression_column.h"
#include "statistics/surface/surface_test.h"

namespace espdiff {

struct EarlierPatch;
struct PatchPlacement;

enum class ErrorControl { kTfce, kMaxT };

/// A part of the surface that the user chose before seeing the result.
struct FixedPatch {
  std::string name;
  std::vector<std::uint8_t> residues;  ///< [residue of the template] nonzero in the patch; empty for an earlier one
  std::shared_ptr<const EarlierPatch> earlier{};      ///< a patch of another template, whose place has to be found
  std::shared_ptr<const PatchPlacement> placement{};  ///< how it was found
  double area_A2 = 0;                                 ///< tested
  std::vector<double> means{};                        ///< [group]
};

/// Options of the statistics; they do not change the file's values.
struct EnsembleOptions {
  double alpha = 0.05;        ///< of patches, and 1 - confidence of intervals
  double most_missing = 0.1;  ///< a vertex that a larger share of a group's frames does not trust is left out
  ErrorControl control = ErrorControl::kTfce;  ///< the family-wise p of patches
  Equilibration equilibration;
  SurfaceTestOptions test;
  std::vector<FixedPatch> fixed_patches;  ///< names and residues
  std::optional<RegressionColumn> regression;
};

/// The options of these, where `at` finds them in what is asked for; in the order of the manuals.
template <typename Study, typename At>
std::vector<OptionRow<Study>> statistics_rows(At at) {
  using Rows = RowsOf<Study>;
  const std::string group = "Statistics";
  return {
      Rows::number(
          "alpha", group, {1e-6, 0.5}, [at](auto& o) -> auto& { return at(o).alpha; },
          "Significance level; intervals have the confidence 1 - alpha"),
      Rows::template choice_of<ErrorControl>(
          "control", group, {{"tfce", ErrorControl::kTfce}, {"max-t", ErrorControl::kMaxT}},
          [at](auto& o) -> auto& { return at(o).control; }, "The family-wise p that patches are made of"),
      Rows::parsed(
          "equilibration", group,
          [at](Study& o, const std::string& text) { at(o).equilibration = parse_equilibration(text); },
          [at](const Study& o) { return to_string(at(o).equilibration); },
          "Frames to cut off at the start of each replicate: none, a number, or auto, which leaves the most effective "
          "samples of RMSD and mean potential"),
      Rows::number(
          "most-missing", group, {0, 0.9}, [at](auto& o) -> auto& { return at(o).most_missing; },
          "A vertex that is unmatched or not trusted in a larger share of a group's frames is not tested"),
      Rows::count(
          "permutations", group, {20, 1e6}, [at](auto& o) -> auto& { return at(o).test.max_permutations; },
          "Maximum number of permutations of labels; all are used if there are fewer"),
      Rows::count(
          "seed", group, kNotNegative, [at](auto& o) -> auto& { return at(o).test.seed; },
          "Random seed; written into the result")};
}

}  // namespace espdiff
