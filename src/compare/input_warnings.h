// input_warnings.h: what is wrong with the two molecules as a pair, before any surface is made.
#pragma once

#include <vector>

#include "compare/result.h"

namespace espdiff {

struct ResidueView;

/// Looks for inputs that cannot be compared, or that differ in more than their state:
/// - residues that follow each other farther apart than a chain can stretch, as in molecules cut by a periodic cell;
/// - paired residues of opposite chirality, as in mirror images;
/// - residues that lie on the place of another residue, all shifted alike along the chain;
/// - an RMSD so large that the superposition means nothing (relative to the radii of gyration);
/// - chains that fit by themselves but are arranged differently;
/// - ligands that moved, and equal chains that pair by their arrangement against their names;
/// - hydrogens, or other radii, on one side only.
/// Time is linear in the number of atoms.
/// @param result with pairing, superposition and domains
std::vector<Warning> input_warnings(const Molecule& source, const Molecule& target, const CompareResult& result);

/// The check of shifted residues (register_warning.cpp).
void check_register(const ResidueView& source, const ResidueView& target, const CompareResult& result,
                    std::vector<Warning>& warnings);

}  // namespace espdiff
