// protonation.h: the protonation states of residues, from the hydrogens they have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"
#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// The state of a titratable residue by its Amber name: ASP or ASH, GLU or GLH, HID, HIE or HIP, LYS or LYN, CYS, CYM
/// or CYX (in a disulfide), TYR or TYM, ARG or AR0.
/// @returns [residue] empty for other residues, and for those without hydrogens
std::vector<std::string> protonation_states(const Molecule& molecule);

/// What a state means, for messages: "protonated", "neutral", "with its hydrogen on ND1"; empty for the usual state
/// at pH 7.
std::string describe_protonation(const std::string& state);

/// "HIS 31 of chain A"; the state's name is not the residue's.
std::string residue_in_words(const Residue& residue);

/// Compares the states of paired residues; ends with charged groups (H2 and H3, OXT) count too. Substituted residues,
/// and molecules without hydrogens, are not compared.
/// @param target_of [source residue] its partner, -1 for none
std::vector<ProtonationDifference> protonation_differences(const Molecule& source, const Molecule& target,
                                                           const std::vector<std::int32_t>& target_of);

/// "HIS 31 of chain A: HIP in the source, HIE in the target".
std::string in_words(const ProtonationDifference& difference, const Molecule& source);

/// All of them in one sentence, with the remedy.
Message protonation_warning(const std::vector<ProtonationDifference>& differences, const Molecule& source);

}  // namespace espdiff
