// charge_warnings.h: charges that cannot be right, of one molecule and of a pair.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct ResidueView;

/// The charges of one molecule: backbones whose charges have another unit, sign or place, and
/// residues and ions whose net charge is not whole or not one that their name can have. Refuses what is systematic.
/// Nothing for molecules without charges. Source of the net charges: residue_charges.h.
/// @returns whether the charges of single residues can be told: false where all are wrong
bool check_charges(const char* role, const ResidueView& view, std::vector<Warning>& warnings);

/// The charges of paired residues of one name: of two force fields, or different by 1 e although their hydrogens are
/// the same (those that differ are in InputReport::protonation).
void check_paired_charges(const ResidueView& source, const ResidueView& target, const AtomPairing& pairing,
                          std::vector<Warning>& warnings);

}  // namespace espdiff
