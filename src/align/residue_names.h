// residue_names.h: what a residue is, and the spellings of residue and atom names that mean the same.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// What part of a structure a residue is: an item of a sequence (amino acid, nucleotide), water, or all else (ligands,
/// ions, sugars, caps).
enum class ResidueKind { kAminoAcid, kNucleotide, kWater, kOther };

/// One-letter code: upper case for amino acids (IUPAC), lower case for nucleotides (a, c, g, t, u), '?' for other
/// names. Force field names stand for what they are forms of: HSD, HIE, HIP for H; CYX for C; ASH for D; RA5, DA, ADE
/// for a. So do common modified amino acids, for their parents (MSE for M).
char residue_letter(const std::string& residue_name);

/// Whether two residue names mean the same residue: equal, or of the same known letter.
bool same_residue_name(const std::string& a, const std::string& b);

/// The spelling under which atom names are compared: leading digits moved to the end (1HB -> HB1), * and " as primes,
/// and the old, CHARMM and current names of backbone atoms brought together (HN -> H, HT1 -> H1, OT1 -> O, OT2 -> OXT,
/// O1P -> OP1).
/// @param letter residue_letter() of its residue; CHARMM's CD and HD1 of isoleucine are CD1 and HD11 elsewhere
std::string normalized_atom_name(const std::string& atom_name, char letter = '?');

/// [residue][] indices of its atoms, in file order.
std::vector<std::vector<std::size_t>> atoms_of_residues(const Molecule& molecule);

/// [residue] by name where it is known, else by atoms: N, CA, C make an amino acid; P, C1', C3', C4', O3' a nucleotide.
/// @param residue_atoms as atoms_of_residues() gives them
std::vector<ResidueKind> residue_kinds(const Molecule& molecule,
                                       const std::vector<std::vector<std::size_t>>& residue_atoms);

}  // namespace espdiff
