// groups.h: what stands beside the chains of a structure: ions, haem, additives of the crystallization, ligands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/types.h"

namespace espdiff {

struct ChargeOptions;

/// Where the charges of a group come from that no force field of PDB2PQR has.
/// (beside the chains), or that it does not know or could not complete (in them).
enum class GroupSource { kNone, kIon, kGas, kHaem, kAdditive, kOpenBabel, kPhosphate, kModified, kCap, kTorn };

/// [residue] of the groups beside the chains: ions of one atom by ion_parameters(); gases (O2, CO, NO,
/// Xe, Kr, Ar), which get no charge; haem (HEM, HEC); additives by a list of names, which are left out, as ions of one
/// charge are that lie 5 Angstrom and more from everything else; every other group by Open Babel, if
/// options.ligands_auto and it is there, as a kCap where it is bound to the end of a chain next to it
/// (is_bound_as_cap()). kNone for all that PDB2PQR charges or that gets no charge: chains, caps, ligands with a MOL2
/// file. Amino acids by amino_acid_source(), of which torn ones are left out as additives are, unless they are more
/// than a tenth.
/// @param ligand_of [residue] nonnegative where a MOL2 file has its charges
std::vector<GroupSource> group_sources(const Molecule& molecule, const std::vector<std::int32_t>& ligand_of,
                                       const ChargeOptions& options);

/// Groups with charges, and those that were left out.
struct Groups {
  Molecule charged;
  Molecule modified;                      ///< residues of chains
  std::vector<LeftOutResidue> additives;  ///< and torn residues
  std::vector<std::string> lines;         ///< each charged group in words: "ZN 301 of chain A: +2 e"
  std::vector<std::string> warnings;      ///< net charges that are not the usual ones, or that nothing confirms
  std::vector<std::string> definitions;   ///< files among ChargeOptions::ligands whose bonds were taken
  std::vector<std::string> guessed;  ///< ligands by Open Babel without a known net charge: "E20 1 of chain A (+1 e)"
};

/// Charges the groups of the sources. Haem gets CHARMM22's charges as PDB2PQR ships them (Kuczera, Kuriyan and Karplus,
/// J. Mol. Biol. 213, 351 (1990)), hydrogens folded into their carbons: iron(II), propionates ionized, -2 e.
/// Hydrogens of Open Babel that lie where another residue is bound (within 1.6 Angstrom of its heavy atoms) are dropped
/// and their charge goes to the atom they are bound to. Where charge_of_group() knows another net charge than Open
/// Babel found, every atom of the ligand gets an equal share of the difference. Where it knows none, the ligand is
/// among the guessed ones. Hydrogens less the net charge follow from the bonds alone: they are compared with the
/// formula of the file (PDB's FORMUL, mmCIF's _chem_comp.formula), where all heavy atoms are there.
/// @throws as charge_by_open_babel()
Groups charge_groups(const Molecule& molecule, const std::vector<GroupSource>& sources, const ChargeOptions& options,
                     const Progress& progress);

}  // namespace espdiff
