// caps.h: groups at the ends of chains, in place of a charged end: acetyl, N-methylamide, amide, formyl and others.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "prepare/charges/groups.h"

namespace espdiff {

struct Preparation;

/// Acetyl (ACE), N-methylamide (NME) and amide (NH2), of which charge_caps() knows the charges.
bool is_cap_name(const std::string& residue_name);

/// Gives caps of other names (NHE, NMA, CBX, N-M) these, and their methyl carbon CA the name CH3.
void name_caps(Molecule& molecule, Preparation& preparation);

/// Whether a residue has an N bound to the C of the amino acid before it, or a C bound to the N of that behind it.
/// @param atoms [residue] from atoms_of_residues()
bool is_bound_as_cap(const Molecule& molecule, std::size_t residue, const std::vector<std::vector<std::size_t>>& atoms);

/// Caps as PDB2PQR takes them: their heavy atoms under a name that leaves the neighbour without a charged end and gets
/// no charges.
/// @param sources [residue] of the molecule
Molecule with_bare_caps(const Molecule& molecule, const std::vector<GroupSource>& sources);

/// Gives the caps of `before` back, with charges and radii of the force field (PARSE; CHARMM; AMBER for the others) for
/// those of is_cap_name(), whose net charge is 0 with or without hydrogens at carbon: what is missing is folded into
/// the carbon. Hydrogens at nitrogen are placed where the file has none. Others are taken from `modified`.
void charge_caps(Molecule& prepared, const Molecule& before, const std::vector<GroupSource>& sources,
                 const Molecule& modified, const std::string& force_field);

}  // namespace espdiff
