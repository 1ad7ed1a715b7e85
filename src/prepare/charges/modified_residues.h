// modified_residues.h: residues of chains that PDB2PQR does not know, or that it could not complete.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/types.h"
#include "prepare/charges/groups.h"
#include "prepare/charges/ligand.h"

namespace espdiff {

struct Preparation;

/// Gives residues the names by which the force fields have them: selenomethionine becomes methionine, with sulfur;
/// the charged residues of Insight II (AR+, LY+, AS-, GL-) those of the PDB; nucleotides of CHARMM (ADE) and
/// deoxynucleotides under the names of RNA, as in files of before 2007, those of their sugar; ASP and GLU with a proton
/// at the carboxyl group are ASH and GLH, and lose it, since PDB2PQR places it; caps as by name_caps(); GROMACS' O1 and
/// O2 at the end of a chain are O and OXT, and so is another oxygen that is bound to C. Drops GROMACS' mass centres of
/// virtual sites, with a note, and the phosphate at the 5' end of a chain, with a warning: no force field has one.
void rename_residues(Molecule& molecule, Preparation& preparation);

/// The names of heavy atoms that an amino acid of this name does not have: a phosphate on a cysteine that is named CYS.
/// Empty for other residues, and where atoms of its own are missing, since these may be they.
std::vector<std::string> foreign_atoms(const Molecule& molecule, std::size_t residue,
                                       const std::vector<std::size_t>& atoms);

/// Where the charges of an amino acid come from: kNone for those that the force fields have. kPhosphate for SEP, TPO
/// and PTR with all atoms of their phosphate. kTorn where fewer than three of N, CA, C, O and CB are there, by which
/// the others could be placed. kModified for other names, and with foreign_atoms(), if options.ligands_auto.
/// @param atoms of the residue
GroupSource amino_acid_source(const Molecule& molecule, std::size_t residue, const std::vector<std::size_t>& atoms,
                              bool ligands_auto);

/// Where the charges of a nucleotide come from: kNone for those that the force fields have, kTorn where fewer than
/// three atoms of their sugar are there; kModified for other names within a chain, kOpenBabel for those beside one
/// (AMP, FMN), if ligands_auto.
/// @param atoms [residue] from atoms_of_residues()
GroupSource nucleotide_source(const Molecule& molecule, std::size_t residue,
                              const std::vector<std::vector<std::size_t>>& atoms, bool ligands_auto);

/// Whether a residue's P is bound to an O3', or its O3' to a P, as that of a triphosphate (GTP) which begins a chain.
bool is_in_nucleic_chain(const Molecule& molecule, std::size_t residue,
                         const std::vector<std::vector<std::size_t>>& atoms);

/// The atoms by which a residue is part of a protein's chain.
struct PeptideBackbone {
  std::size_t n, ca, c, o;
};

/// Those of a residue that has them under other names, as the chromophore of the green fluorescent protein has (N1,
/// CA1, C3, O3): a nitrogen bound to the C of another residue, the carbon behind it, a carbon bound to the N of another
/// residue, and the oxygen at it. Nothing where one is not there.
/// @param atoms [residue] from atoms_of_residues()
std::optional<PeptideBackbone> peptide_backbone(const Molecule& molecule, std::size_t residue,
                                                const std::vector<std::vector<std::size_t>>& atoms);

/// Whether PDB2PQR's force fields have an amino acid of this name; the names of ends (NALA) and of protonation states
/// count.
bool is_known_amino_acid(const std::string& name);

/// What a residue has lost to its neighbours, which each bond of the chain takes from the formula.
struct LostInChain {
  int n_hydrogens = 0, n_oxygens = 0;
};

/// A residue of a chain with hydrogens and charges.
struct ChargedResidue {
  Molecule molecule;
  int net_charge = 0;                ///< elementary charges
  std::optional<LigandBonds> bonds;  ///< nothing where Open Babel perceived them
  LostInChain lost;
};

/// The residue with hydrogens and charges by Open Babel. Neighbours in the chain stand in as an acetyl group at N and a
/// methylamide at C, or methyl groups at P and O3' of a nucleotide, which are taken away again; then each atom of the
/// residue gets an equal share of what its charges lack of the whole number.
/// @param components of bonds_by_definition()  @throws as charge_by_open_babel()
ChargedResidue charge_modified_residue(const Molecule& molecule, std::size_t residue,
                                       const std::vector<Component>& components, double ph, const Progress& progress);

/// What PDB2PQR gets: phosphorylated residues (kPhosphate) as SER, THR or TYR without the phosphate, modified ones
/// (kModified) as glycine, or as a nucleotide of their ring, in their place, so that chains are whole.
/// @param sources [residue]
Molecule with_known_residues(const Molecule& molecule, const std::vector<GroupSource>& sources);

/// Puts back what with_known_residues() took. A phosphate is ionized, as at pH 7 (the second pKa is 5.6 to 6), with
/// CHARMM's charges of phosphoserine as PDB2PQR ships them; they take the place of the hydroxyl group, and its carbon
/// takes the rest, so that the residue has -2 e more than without.
/// @param prepared  by PDB2PQR  @param before as given to with_known_residues()
/// @param modified  residues of charge_modified_residue()
void restore_residues(Molecule& prepared, const Molecule& before, const std::vector<GroupSource>& sources,
                      const Molecule& modified);

/// A residue as a molecule of its own; charges are 0 where the molecule has none.
Molecule residue_alone(const Molecule& molecule, std::size_t residue, const std::vector<std::size_t>& atoms);

/// Appends a molecule of one residue.
void append_residue(Molecule& all, const Molecule& one);

}  // namespace espdiff
