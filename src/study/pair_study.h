// pair_study.h: the whole of a comparison of two states in one call. Command line, Tcl and Python start here.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "certificate/result.h"
#include "options/options.h"
#include "report/write_compare.h"
#include "study/state.h"

namespace espdiff {

/// What is asked for.
struct PairStudy {
  StatePtr source, target;
  CompareOptions options;
  PotentialRequest potential{};
  bool each_by_itself = false, refuses_shapes = false;  ///< see StatesRequest
  std::string command_line{};
  /// Called with the structures that are kept beside the results, when the states were read and nothing is computed
  /// yet; may be empty. It throws where one of them would replace an input.
  std::function<void(const std::vector<KeptFile>&)> check_kept{};
};

/// The result, and all that its files are written of.
struct PairAnswer {
  Molecule source_molecule, target_molecule;  ///< as they were compared
  std::vector<KeptFile> kept;                 ///< structures that no file holds as they were compared
  CompareOptions options;
  Provenance provenance;
  CompareResult result;
};

/// Reads both states, plans their potentials, radii, region and patches, and compares them.
/// @throws as StateReader, set_surface_radii(), source_parts(), compare()
PairAnswer run_pair(const PairStudy& study, Engine& engine, const Progress& progress);

/// What made a result of two states: their structures first, then their maps, and what PDB2PQR did.
Provenance provenance_of(const Engine& engine, const std::string& command_line, const ComparedState& source,
                         const ComparedState& target);

}  // namespace espdiff
