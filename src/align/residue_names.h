// residue_names.h: kinds of residues, and equivalent spellings of residue and atom names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Part of a structure that a residue belongs to: a sequence (amino acid, nucleotide), water, or other (ligands, ions,
/// sugars, caps).
enum class ResidueKind { kAminoAcid, kNucleotide, kWater, kOther };

/// One-letter code: upper case for amino acids (IUPAC), lower case for nucleotides (a, c, g, t, u), '?' for other
/// names. Force field names map to their parent: HSD, HIE, HIP to H; CYX to C; ASH to D; RA5, DA, ADE to a. Common
/// modified amino acids map to theirs too (MSE to M).
char residue_letter(const std::string& residue_name);

/// Whether two residue names mean the same residue: equal names, or the same known letter.
bool same_residue_name(const std::string& a, const std::string& b);

/// Normalized atom name for comparisons: leading digits moved to the end (1HB -> HB1), * and " as primes, and old,
/// CHARMM and current names of backbone atoms unified (HN -> H, HT1 -> H1, OT1 -> O, OT2 -> OXT, O1P -> OP1).
/// @param letter residue_letter() of its residue; CHARMM's CD and HD1 of isoleucine are CD1 and HD11 elsewhere
std::string normalized_atom_name(const std::string& atom_name, char letter = '?');

/// Whether one of the 20 amino acids has a heavy atom of this name; true of other letters.
/// @param atom_name normalized
bool is_heavy_atom_of(char letter, const std::string& atom_name);

/// Heavy atoms of an amino acid within a chain; 0 for other letters.
std::size_t n_heavy_atoms_of(char letter);

/// [residue][] indices of its atoms, in file order.
std::vector<std::vector<std::size_t>> atoms_of_residues(const Molecule& molecule);

/// [residue] kind by name if known, otherwise by atoms: N, CA, C make an amino acid; P, C1', C3', C4', O3' a
/// nucleotide.
/// @param residue_atoms from atoms_of_residues()
std::vector<ResidueKind> residue_kinds(const Molecule& molecule,
                                       const std::vector<std::vector<std::size_t>>& residue_atoms);

}  // namespace espdiff
