// select_atoms.h: atoms chosen by selections in gemmi's syntax, which is MMDB's.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/types.h"

namespace espdiff {

/// Evaluates a selection such as "//A", "//A/10-20,26", "(AP5,CL)", "//A;polymer" or "//B/*/CA[C]"; several, separated
/// by blanks, add up. Chains, numbers, insertion codes and names are those of the molecule. `;polymer`, `;ligand` and
/// `;water` tell amino acids and nucleotides (by their backbone atoms), everything else, and water apart. Models,
/// alternate locations, occupancies and B factors are not known to a molecule and are refused.
/// @returns [atom]
/// @throws InputError (syntax, with the option's name; this build lacks gemmi)
std::vector<bool> select_atoms(const Molecule& molecule, const std::string& selection, const std::string& option_name);

/// As select_atoms().
/// @throws InputError also when no atom is selected, with what the molecule has instead
std::vector<bool> select_some_atoms(const Molecule& molecule, const std::string& selection,
                                    const std::string& option_name);

/// The molecule's chains with their residues, for messages: "chain A (1-214, AP5), chain B (1-214)".
std::string describe_chains(const Molecule& molecule);

/// The molecule without the other atoms, and without residues that have none left.
Molecule keep_atoms(const Molecule& molecule, const std::vector<bool>& keep);

/// @throws InputError, with the options that keep these atoms
[[noreturn]] void refuse_left_out(const std::string& name, std::size_t n_water, std::size_t n_hetero);

/// The part of a molecule that the options of reading keep: without water, without HETATM records.
Molecule keep_kinds(const Molecule& molecule, const StructureOptions& options);

/// The molecule with the first atom of each name in a residue: VMD loads all alternate locations of a file.
Molecule without_repeated_atoms(const Molecule& molecule);

}  // namespace espdiff
