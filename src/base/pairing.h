// pairing.h: which atoms of two molecules are the same, and which of them a superposition uses.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace espdiff {

/// Which paired atoms the superposition uses.
enum class AlignAtoms { kAll, kBackbone, kCAlpha, kNone };

struct AtomPairing {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< (source atom, target atom), ascending in the source atom
  std::string method;                                      ///< "same order" or "sequence alignment"
  std::size_t n_aligned_residues = 0;
  std::size_t n_substituted_residues = 0;  ///< aligned, with different names
};

}  // namespace espdiff
