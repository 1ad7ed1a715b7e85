// input_warnings.h: what is wrong with the two molecules as a pair, before any surface is made.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct PairedMolecules;
struct ResidueView;

/// Looks for inputs that cannot be compared, or that differ in more than their state:
/// - residues that follow each other farther apart than a chain can stretch, as in molecules cut by a periodic cell,
///   unless both molecules have the gap;
/// - paired residues of opposite chirality, as in mirror images;
/// - residues that lie on the place of another residue, all shifted alike along the chain, or a stretch of eight;
/// - side chains that lie in each other's places;
/// - an RMSD so large that the superposition means nothing (relative to the radii of gyration);
/// - chains that fit by themselves but are arranged differently;
/// - ligands that moved or turned, and equal chains that pair by their arrangement against their names;
/// - charges and coordinates that cannot be right, and charges of two force fields;
/// - hydrogens, or other radii, on one side only.
/// Time is linear in the number of atoms, but for logarithms.
/// @param alignment with domains and the chains' motions
std::vector<Warning> input_warnings(const Molecule& source, const Molecule& target, const Alignment& alignment);

/// The checks that have files of their own: broken_chains.cpp, register_warning.cpp, exchanged_side_chains.cpp.
void check_chains(const PairedMolecules& pair, std::vector<Warning>& warnings);
void check_register(const PairedMolecules& pair, const Alignment& alignment, std::vector<Warning>& warnings);
void check_side_chains(const PairedMolecules& pair, std::vector<Warning>& warnings);

/// The charges of one molecule (charge_warnings.cpp): backbones whose charges have another unit, sign or place, and
/// residues and ions whose net charge is not whole or not one that their name can have. Refuses what is systematic.
/// Nothing for molecules without charges. Source of the net charges: residue_charges.h.
/// @returns whether the charges of single residues can be told: false where all are wrong
bool check_charges(const char* role, const ResidueView& view, std::vector<Warning>& warnings);

/// The charges of paired residues of one name: of two force fields, or different by 1 e although their hydrogens are
/// the same (those that differ are in InputReport::protonation).
void check_paired_charges(const ResidueView& source, const ResidueView& target, const AtomPairing& pairing,
                          std::vector<Warning>& warnings);

/// The coordinates of one molecule (geometry_warnings.cpp): their unit, rounding, bonds within residues, side chains
/// that are missing throughout, and residues that lie on each other. Refuses what is systematic.
void check_geometry(const char* role, const ResidueView& view, std::vector<Warning>& warnings);

/// Groups that one molecule has and the other has not, or has replaced or charged otherwise, and residues that an
/// option left out (composition_warnings.cpp); each with its charge, and with the area of the surface within 5 A where
/// there is a surface. None of them refuses.
/// @param region [source residue] nonzero in the region, to which distances are given; empty for none
/// @param surface, uncovered empty where there is none: no areas then
std::vector<Warning> composition_warnings(const Molecule& source, const Molecule& target,
                                          const std::vector<std::uint8_t>& region, const Alignment& alignment,
                                          const MappedSurface& surface, const UncoveredSurface& uncovered);

}  // namespace espdiff
