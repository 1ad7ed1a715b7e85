// ensemble_causes.h: which residues' charges make the difference of a patch between two groups of simulations.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/message.h"
#include "base/progress.h"
#include "mapping/input.h"
#include "statistics/surface/surface_test.h"

namespace espdiff {

class EnsembleFile;
struct CompareOptions;
struct EnsembleResult;

/// What the charges of each residue add to the mean potential of a patch.
struct EnsembleCauses {
  std::string reading;                            ///< "patch site", "patch 1"
  std::vector<std::string> residues;              ///< of the template, then "others": what has no partner there
  std::vector<std::vector<double>> of_replicate;  ///< [replicate][residue] mean over its frames, kT/e
  std::vector<std::vector<double>> means;         ///< [group][residue] of the replicates' means
  PlaceTests tests;                               ///< [residue] the second group less the first; empty for one group
  std::vector<double> adjusted_p;                 ///< for the false discovery rate over the residues
  std::vector<std::size_t> order;                 ///< residues, the largest difference (or mean) first
  std::size_t n_frames = 0;                       ///< solved again
  double sum_error = 0;  ///< the largest deviation of a frame's sum of contributions from its mean, kT/e
};

/// Before any work.
/// @throws InputError (causes of something other than a patch; a scan or side chains, which are of one pair; potentials
///         that are not computed by a linear equation)
void check_ensemble_causes(const CompareOptions& options, const CompareInput& source, bool nonlinear);

/// Maps every frame of the statistics again, and takes the patches of `options.causes` apart: each takes about as long
/// as before, and half as long again for each patch. Replicates are the samples, as they are for potentials.
/// @param result with its patches: `patch NAME` is a fixed one, `patch 2` the second that was found significant
/// @param tell   receives, after the first frame, how long all of them take
/// @param read   a frame of all; called on this thread, in their order, while frames before it are mapped
/// @throws InputError (no such patch), and as TemplateMapping
std::vector<EnsembleCauses> find_ensemble_causes(Engine& engine, const CompareInput& source,
                                                 const CompareOptions& options, const EnsembleFile& file,
                                                 const EnsembleResult& result,
                                                 const std::function<HeldInput(std::size_t)>& read,
                                                 const Progress& progress,
                                                 const std::function<void(const Message&)>& tell);

/// OUT.causes.csv: a row for each reading and residue, in its order.
void write_ensemble_causes(std::ostream& out, const EnsembleResult& result);
void print_ensemble_causes(std::ostream& out, const EnsembleResult& result, const std::string& unit);
/// OUT.json's `causes`: each reading with its twenty largest residues.
nlohmann::ordered_json ensemble_causes_json(const EnsembleResult& result);

}  // namespace espdiff
