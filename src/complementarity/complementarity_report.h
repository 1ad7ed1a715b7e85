// complementarity_report.h: complementarity as files and in words.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "complementarity/complementarity.h"

namespace espdiff {

struct Provenance;

/// One complex, or two and what changed.
struct ComplementarityResult {
  InterfaceRequest request;
  std::vector<const Complementarity*> states;  ///< one or two
  std::vector<InterfaceChange> changes;        ///< [side] where there are two
};

/// The residues with surface in the interface of any state, in the order of the molecules.
std::vector<InterfaceRow> interface_rows(const ComplementarityResult& result);

/// Writes OUT.json, OUT.interface.csv, and the surfaces OUT.first.vtp and OUT.second.vtp: with both potentials, the
/// interface and the local complementarity; of two complexes mapped from one to the other, with the change at each
/// vertex. All appear, or none.
/// @throws IoError
void write_complementarity(const std::string& prefix, const ComplementarityResult& result,
                           const Provenance& provenance);

/// What write_complementarity() writes.
std::vector<std::string> complementarity_endings();

void print_complementarity(std::ostream& out, const ComplementarityResult& result);

}  // namespace espdiff
