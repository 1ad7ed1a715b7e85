// residue_charges.h: the net charges that residues and ions of known names can have.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace espdiff {

/// The net charges, in elementary charges, that an amino acid or nucleotide can have within a chain: {-1, 0} for ASP,
/// {0} for ASH. Names of Amber, CHARMM, Gromacs, OPLS and PARSE say a protonation state; names of the PDB allow all
/// states. A charged end of a chain adds 1 or -1.
/// @returns empty for names that are not known, and for modified residues whose charge has no one value
std::vector<int> possible_charges(const std::string& residue_name);

/// The net charge that a residue with these hydrogens has within a chain.
/// @param state of protonation_states(); "ASH"
/// @returns empty where the hydrogens do not say it
std::vector<int> charges_of_state(const std::string& state);

/// The usual charge of an ion of this name, or of a small group or cofactor at pH 7: 2 for ZN, -2 for SO4. Ions have
/// one atom: CO of two is carbon monoxide.
/// @returns empty for names that are not known
std::optional<int> charge_of_group(const std::string& residue_name, std::size_t n_atoms);

/// Whether the name is that of an ion of one atom.
bool is_ion_name(const std::string& residue_name);

}  // namespace espdiff
