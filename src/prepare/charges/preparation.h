// preparation.h: what a preparation by PDB2PQR did to a structure.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "prepare/charges/groups.h"

namespace espdiff {

/// What of a residue PDB2PQR leaves as it was.
using ResidueKey = std::tuple<std::string, std::int32_t, char>;
inline ResidueKey key_of(const Residue& residue) { return {residue.chain, residue.number, residue.insertion_code}; }

/// A residue that gets no charge, or of whose atoms some get none.
struct UnchargedResidue : Residue {
  std::vector<std::string> atoms{};  ///< those of an amino acid or a nucleotide that others of its name do not have
  bool can_be_made = false;          ///< by Open Babel, although it has the name of an amino acid
};

/// Residues that get no charge. The first one is named, so that who knows the file can add the line.
struct UnchargedError : InputError {
  /// @param name of the molecule
  UnchargedError(const std::string& name, const Message& lack, const Message& advice, Residue first,
                 std::vector<UnchargedResidue> all = {})
      : InputError(name + ": " + lack + advice),
        text(lack),
        remedy(advice),
        residue(std::move(first)),
        residues(std::move(all)) {}

  Message text;    ///< without the molecule's name and the remedy
  Message remedy;  ///< begins with "; "
  Residue residue;
  std::vector<UnchargedResidue> residues;  ///< empty where no residue of the molecule can be charged
};

/// What to do about residues without charges: Open Babel for ligands, or a MOL2 file, or charges of all atoms, or to
/// leave them out; and the command that does the first of these, which installs Open Babel where it is not there.
/// @param residues of all states  @param force_field of ChargeOptions, not auto
Message uncharged_remedy(const std::vector<UnchargedResidue>& residues, const std::string& force_field);

/// What PDB2PQR added, repaired and protonated.
struct Preparation {
  std::string program;      ///< "PDB2PQR v3.5.2"; "Open Babel" for ligands alone
  std::string force_field;  ///< lower case; never auto; "none" for ligands alone
  double ph = 7;
  bool propka = true;                ///< whether PROPKA chose protonation states; false where nothing titrates
  std::vector<std::string> ligands;  ///< MOL2 files and definitions of residues that were there
  bool from_cache = false;
  double seconds = 0;
  std::size_t n_atoms_before = 0, n_atoms = 0, n_hydrogens_added = 0;
  double net_charge = 0;                 ///< elementary charges
  std::vector<std::string> added;        ///< heavy atoms: "CG, CD of GLU 12 of chain A"
  std::vector<std::string> removed;      ///< heavy atoms in the same words, such as OXT within a chain
  std::vector<std::string> renamed;      ///< "MSE 5 of chain A as MET"
  std::vector<std::string> protonation;  ///< states other than the usual one: "HIS 31 of chain A: HIP (protonated)"
  std::vector<std::string> groups;       ///< charges of what PDB2PQR has none for: "ZN 301 of chain A: +2 e (...)"
  std::vector<std::string> warnings;     ///< what is doubtful about these
  std::vector<std::string> notes;        ///< what was chosen, and why: "force field AMBER, since ..."
  std::string topology_beside;           ///< a PSF or prmtop of the file's atoms, whose charges were not taken
  std::vector<std::string> gaps;         ///< "between GLY 10 and ALA 15 of chain A"
};

/// Lists what differs between the molecule given to PDB2PQR and its answer.
/// @param before as given to the program
/// @param preparation with the force field
/// @throws UnchargedError naming atoms of `before` without a charge, with the ways on
void compare_with_input(const Molecule& before, const Molecule& after, Preparation& preparation);

/// Selects atoms of a residue: "//A/107/P,O1P".
std::string atom_selection(const Residue& residue, const std::vector<std::string>& names);

/// Whether PDB2PQR has charges for all names, as far as names tell: run before the program.
/// @param sources [residue] where groups get their charges from otherwise
/// @param ligand_of [residue] nonnegative where a MOL2 file has its charges
/// @param force_field of ChargeOptions, not auto
/// @throws UnchargedError as compare_with_input()
void require_known_names(const Molecule& before, const std::vector<GroupSource>& sources,
                         const std::vector<std::int32_t>& ligand_of, const std::string& force_field);

/// [residue] how often its chain changes between protein and nucleic acid, or begins anew with a nucleotide that is not
/// bound to the one before, or an amino acid that is not and has a lower number, up to it: files that merge chains have
/// several molecules under one name. Ligands count with what stands before them.
std::vector<std::size_t> pieces_of_chains(const Molecule& molecule);

/// Breaks of a chain: C and N of residues that follow each other lie more than 2.5 A apart.
std::vector<std::string> chain_gaps(const Molecule& molecule);

}  // namespace espdiff
