// state_report.h: what a result says about how its states were loaded.
#pragma once

#include <string>
#include <vector>

#include "report/sections/provenance.h"

namespace espdiff {

struct CompareResult;
struct KeptFile;
struct LoadedState;
struct StateOrigin;

/// Where the states come from: their files, as they were read, and the files that charges were taken from.
std::vector<InputFile> state_inputs(const std::string& role, const InputFile& file, const LoadedState& state);

/// The molecule as it is compared, as a PQR file that is kept beside the results; nothing where the input file holds
/// just that. Before set_surface_radii().
std::vector<KeptFile> kept_structure(const std::string& role, const LoadedState& state);

/// Adds what PDB2PQR did, missing loops and replaced radii to a result's lines and warnings, and the time it took.
/// @param radii_note of set_surface_radii(); may be empty
void note_states(CompareResult& result, const StateOrigin& source, const StateOrigin& target,
                 const std::string& radii_note);

}  // namespace espdiff
