// paired_residues.cpp: counts the atom pairs of each pair of residues.
#include "align/paired_residues.h"

#include <map>

namespace espdiff {

std::vector<std::int32_t> paired_residues(const Molecule& source, const Molecule& target, const AtomPairing& pairing) {
  std::vector<std::map<std::int32_t, int>> counts(source.residues.size());
  for (const auto& [s, t] : pairing.pairs) {
    ++counts[static_cast<std::size_t>(source.atoms[s].residue)][target.atoms[t].residue];
  }
  std::vector<std::int32_t> paired(source.residues.size(), -1);
  for (std::size_t r = 0; r < counts.size(); ++r) {
    int most = 0;
    for (const auto& [residue, n] : counts[r]) {
      if (n <= most) continue;
      most = n;
      paired[r] = residue;
    }
  }
  return paired;
}

std::vector<std::int32_t> source_residues(const std::vector<std::int32_t>& target_of, std::size_t n_target_residues) {
  std::vector<std::int32_t> source_of(n_target_residues, -1);
  for (std::size_t r = 0; r < target_of.size(); ++r) {
    if (target_of[r] >= 0) source_of[static_cast<std::size_t>(target_of[r])] = static_cast<std::int32_t>(r);
  }
  return source_of;
}

}  // namespace espdiff
