// hydrogen_bonds.cpp: donors and acceptors from elements and distances.
#include "field/hydrogen_bonds.h"

#include <algorithm>

#include "align/residue_names.h"
#include "field/field.h"

namespace espdiff {
namespace {

constexpr double kBondToHydrogen_A = 1.3, kBondOfHeavy_A = 1.9;

/// Neighbours of the atoms within their residue; a backbone nitrogen has one more, the carbon before it.
struct Neighbours {
  std::vector<std::vector<std::size_t>> hydrogens, heavy;
  bool has_hydrogens = false;
};

/// The previous residue's C, if it is bonded.
void add_peptide_bonds(const Molecule& m, const std::vector<std::vector<std::size_t>>& residues, Neighbours& found) {
  for (std::size_t r = 1; r < residues.size(); ++r) {
    for (const std::size_t n : residues[r]) {
      if (m.atoms[n].name != "N") continue;
      for (const std::size_t c : residues[r - 1]) {
        if (m.atoms[c].name == "C" && norm(m.positions[c] - m.positions[n]) < kBondOfHeavy_A)
          found.heavy[n].push_back(c);
      }
    }
  }
}

Neighbours neighbours(const Molecule& m) {
  Neighbours found;
  found.hydrogens.resize(m.size());
  found.heavy.resize(m.size());
  const auto residues = atoms_of_residues(m);
  for (const auto& residue : residues) {
    for (const std::size_t a : residue) {
      found.has_hydrogens = found.has_hydrogens || is_hydrogen(m.atoms[a]);
      if (is_hydrogen(m.atoms[a])) continue;
      for (const std::size_t b : residue) {
        if (a == b) continue;
        const double distance = norm(m.positions[a] - m.positions[b]);
        if (is_hydrogen(m.atoms[b])) {
          if (distance < kBondToHydrogen_A) found.hydrogens[a].push_back(b);
        } else if (distance < kBondOfHeavy_A) {
          found.heavy[a].push_back(b);
        }
      }
    }
  }
  add_peptide_bonds(m, residues, found);
  return found;
}

}  // namespace

std::vector<float> donors(const Molecule& m) {
  const Neighbours near = neighbours(m);
  if (!near.has_hydrogens) return {};
  std::vector<float> values(m.size(), 0.0F);
  for (std::size_t a = 0; a < m.size(); ++a) {
    if (m.atoms[a].element != "N" && m.atoms[a].element != "O") continue;
    for (const std::size_t h : near.hydrogens[a]) values[a] = values[h] = 1;
  }
  return values;
}

std::vector<float> acceptors(const Molecule& m) {
  const Neighbours near = neighbours(m);
  if (!near.has_hydrogens) return {};
  std::vector<float> values(m.size(), 0.0F);
  for (std::size_t a = 0; a < m.size(); ++a) {
    const bool is_free_nitrogen = m.atoms[a].element == "N" && near.hydrogens[a].empty() && near.heavy[a].size() <= 2;
    if (m.atoms[a].element == "O" || is_free_nitrogen) values[a] = 1;
  }
  return values;
}

}  // namespace espdiff
