// molecule_builder.h: turns atoms, one by one in file order, into a Molecule.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/types.h"

namespace espdiff {

/// What an atom can have: elementary charges of either sign, Angstrom.
inline constexpr double kLargestCharge = 1e6, kLargestRadius_A = 1000;

/// Atoms of a molecule at most: beyond it lattices and surfaces no longer fit into a workstation's memory.
constexpr std::size_t kMostAtoms = 5'000'000;

/// One atom as a file gives it.
struct AtomEntry {
  std::string name;
  std::string element;  ///< empty: guessed from the name
  std::string residue_name;
  std::string chain;
  int residue_number = 0;
  char insertion_code = ' ';
  bool hetero = false;
  Vec3d position{};
  float b_factor = std::numeric_limits<float>::quiet_NaN();  ///< and the two below: see Atom
  float occupancy = 1;
  bool has_alternates = false;
  long line = 0;  ///< for messages; 0 when the format has no lines
};

/// Of chains that a format does not name: "A", "B", ..., "a", ..., "0", ..., then numbers. @param chain from 0
std::string chain_letter(std::size_t chain);

/// Whether this is one of the twenty amino acids (also in Amber's and CHARMM's protonation states) or a nucleotide.
bool is_standard_residue(const std::string& residue_name);

/// Collects atoms into residues. Atoms belong to one residue when they share chain, number, insertion code and name; an
/// atom that comes after other residues joins its residue again (hydrogens at the file's end), unless that has an atom
/// of this name (a second molecule without chain, numbers that start over).
class MoleculeBuilder {
 public:
  MoleculeBuilder(std::string path, const StructureOptions& options);

  /// Makes room for so many atoms, where the number is known.
  void reserve(std::size_t n_atoms);

  /// Whether the options keep this atom; counts those they drop, for finish()'s message.
  bool wants(const std::string& residue_name, bool hetero);

  /// Adds an atom with the radius of its element. @throws FormatError (coordinates not finite or beyond 10^6 Angstrom)
  void add(const AtomEntry& entry);

  /// Adds an atom with charge and radius from the file. @throws FormatError (also: out of range; an atom of the same
  /// name, residue and place is there, so that its charge would count twice)
  void add(const AtomEntry& entry, double charge, double radius);

  /// @throws InputError when no atom is left, with the numbers that the options dropped
  Molecule finish();

 private:
  std::int32_t find_residue(const AtomEntry& entry);
  void refuse_double(const AtomEntry& entry);
  void append(const AtomEntry& entry, const std::string& element, float radius);

  std::string path_;
  StructureOptions options_;
  Molecule molecule_;
  std::vector<std::vector<std::size_t>> residue_atoms_;           // [residue][] atom indices
  std::unordered_map<std::string, std::int32_t> latest_residue_;  // by identity
  /// [place] lines and indices of the atoms there, of files with charges.
  std::unordered_multimap<std::size_t, std::pair<long, std::size_t>> at_place_;
  std::size_t n_water_ = 0, n_hetero_ = 0;
};

}  // namespace espdiff
