// write_ensemble.h: writes an ensemble's statistics as files and as a table.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

class EnsembleFile;
struct EnsembleResult;

/// What an ensemble's statistics consist of.
struct EnsembleOutputs {
  bool compares = true;    ///< two groups
  bool regresses = false;  ///< on a value of each replicate
  bool has_states = false;
  bool has_causes = false;
};

/// OUT.json, OUT.vtp, OUT.residues.csv, with two groups OUT.patches.csv and OUT.patch_series.csv, with a regression
/// OUT.regression.csv, with states OUT.states.csv and OUT.components.csv, with causes
/// OUT.causes.csv.
std::vector<std::string> ensemble_outputs(const std::string& output_prefix, const EnsembleOutputs& parts);

/// Writes all outputs, or none. The bytes depend on the file's columns and the options only.
///
/// Of a field, `potential` in the arrays' names is the field's name, and the texts NAME_label, NAME_unit and
/// NAME_signed say what it is. OUT.vtp: the template with means (`potential_source` is the first group's,
/// `potential_target` the second's), `potential_difference`, its interval, standard error, t, p, `p_max_t`, `p_tfce`,
/// effective samples, shares of frames with a counterpart, `patch` (from 1; 0: none). Of a regression:
/// `regression_correlation`, `regression_slope`, `regression_t`, `regression_p_max_t`, `regression_p_tfce`. `untested`
/// marks triangles with a vertex that was not tested.
/// @returns the files' names
/// @throws IoError
std::vector<std::string> write_ensemble(const std::string& output_prefix, const EnsembleFile& file,
                                        const EnsembleResult& result);

}  // namespace espdiff
