// pairing.h: which atoms of two molecules are the same, and which of them a superposition uses.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace espdiff {

/// Which paired atoms the superposition uses.
enum class AlignAtoms { kAll, kBackbone, kCAlpha, kNone };

/// A ligand or ion that both molecules have, in different places.
struct MovedResidue {
  std::size_t source = 0, target = 0;  ///< residues
  double distance_A = 0;               ///< from where the polymer's motion puts it
};

struct AtomPairing {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< (source atom, target atom), ascending in the source atom
  std::string method;  ///< "same order", "sequence alignment" or "names of residues"
  std::size_t n_aligned_residues = 0;
  std::size_t n_substituted_residues = 0;  ///< aligned, with different names
  std::vector<MovedResidue> moved{};       ///< not paired
  /// Equal chains that pair by their arrangement although their names pair otherwise: (source, target).
  std::vector<std::pair<std::string, std::string>> exchanged_chains{};
};

/// A chain of the source and the chain of the target that most of its residues pair with.
struct ComparedChains {
  std::string source, target;  ///< chain names, empty where the file has none
  std::size_t n_residues = 0;  ///< pairs of residues
};

/// How a chain of the source moved against all others: its own superposition after undoing theirs.
struct ChainMotion {
  std::string chain;            ///< of the source
  double rotation_degrees = 0;  ///< 0 to 180
  double shift_A = 0;           ///< of the centre of its paired atoms
  double rmsd_A = 0;            ///< of its atoms where the others put them
  double own_rmsd_A = 0;        ///< after its own superposition
};

/// Two paired residues of one kind in different protonation states, or a chain's end in one molecule only.
struct ProtonationDifference {
  std::size_t source = 0, target = 0;      ///< residues
  std::string source_state, target_state;  ///< "ASP", "ASH"; "N-terminus", "C-terminus" or "within the chain"
};

}  // namespace espdiff
