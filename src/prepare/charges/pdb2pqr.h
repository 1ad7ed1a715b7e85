// pdb2pqr.h: charges, radii and hydrogens from PDB2PQR, which is run as a program.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/types.h"
#include "prepare/charges/preparation.h"

namespace espdiff {

struct ChargeOptions;

/// The path of PDB2PQR: $ESPDIFF_PDB2PQR, otherwise pdb2pqr30 or pdb2pqr on PATH; empty where there is none.
std::string find_pdb2pqr();
/// What to do where there is none: "install it (Debian: pdb2pqr; PyPI: pdb2pqr)".
extern const char* const kPdb2pqrRemedy;

/// The force field for `auto`: AMBER where the molecule, or the source that it is compared with, has nucleotides, of
/// which PARSE has RNA only; PARSE otherwise.
/// @param source null where there is none
/// @param asked of ChargeOptions; returned as it is unless it is auto
/// @throws InputError (auto, and only the target has nucleotides, so that the source has charges of PARSE)
std::string force_field_for(const Molecule& molecule, const Molecule* source, const std::string& asked);

/// Whether every residue can get charges, as far as names tell; runs nothing.
/// @throws UnchargedError, and as read_mol2()
void require_charges(const Molecule& molecule, const ChargeOptions& options);

/// A molecule with charges, and what was done to it.
struct Prepared {
  Molecule molecule;
  Preparation preparation;
};

/// Adds missing heavy atoms and hydrogens, and assigns charges and radii: PDB2PQR with PROPKA's protonation states at
/// the pH of the options (Dolinsky et al., Nucleic Acids Res. 35, W522 (2007); Olsson et al., J. Chem. Theory Comput.
/// 7, 525 (2011)). It gets the molecule as a PDB file of one conformation without water. Chains and residue numbers
/// that its columns or PROPKA's keys cannot hold (long names, insertion codes, more than four digits) are renumbered
/// for it and restored afterwards; pieces_of_chains() are chains of their own. Selenomethionine is charged as
/// methionine. Hydrogens are placed anew where PDB2PQR does not know their names. Groups that the molecule leaves out
/// (Molecule::left_out) are in the file, so that PROPKA sees them, and get no charges; so are ions, haem and ligands
/// that get charges otherwise (charge_groups()), which follow the chains in the result, and alone need no
/// PDB2PQR. Additives of the
/// crystallization become left out. PROPKA is not run without amino
/// acids, nor where it refuses a chain as too short. Phosphorylated and other modified residues are those of
/// restore_residues(). Names that the force field lacks are refused before the program runs.
/// @param states [residue] the protonation state to give a residue, as protonation_states() names it; empty strings
///               and an empty list leave the choice to PROPKA, which is not run if any state is given
/// @throws DeviceError (no PDB2PQR, it failed), InputError (nothing it could charge, atoms without charge, a MOL2 file
///         that cannot be read), Cancelled
Prepared prepare_molecule(const Molecule& molecule, const ChargeOptions& options,
                          const std::vector<std::string>& states, const Progress& progress);

}  // namespace espdiff
