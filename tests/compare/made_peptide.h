// made_peptide.h: a peptide with usual bonds and charges, into which tests plant faults.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff_test {

/// SER, LYS, ASP, SER, ... in one line, each residue 3.8 A after the last; charges like PARSE's: backbone N, H, C and
/// O, and +1 at NZ, -0.5 at OD1 and OD2.
inline espdiff::Molecule made_peptide(int n_residues, const std::string& chain = "A") {
  using Placed = std::pair<const char*, espdiff::Vec3d>;
  static const std::vector<Placed> backbone = {{"N", {0, 0, 0}},        {"H", {0, -0.7, -0.7}},
                                               {"CA", {1.21, 0.81, 0}}, {"C", {2.51, 0.01, 0}},
                                               {"O", {2.51, -1.22, 0}}, {"CB", {1.21, 1.61, 1.3}}};
  static const std::vector<std::pair<const char*, std::vector<Placed>>> side_chains = {
      {"SER", {{"OG", {1.21, 1.61, 2.7}}}},
      {"LYS",
       {{"CG", {1.21, 1.61, 2.8}}, {"CD", {1.21, 2.41, 4.1}}, {"CE", {1.21, 1.61, 5.4}}, {"NZ", {1.21, 2.41, 6.7}}}},
      {"ASP", {{"CG", {1.21, 1.61, 2.8}}, {"OD1", {1.21, 2.67, 3.4}}, {"OD2", {1.21, 0.55, 3.4}}}}};
  const auto charge = [](const std::string& name) {
    if (name == "N") return -0.4F;
    if (name == "H") return 0.4F;
    if (name == "C") return 0.55F;
    if (name == "O") return -0.55F;
    if (name == "NZ") return 1.0F;
    return name == "OD1" || name == "OD2" ? -0.5F : 0.0F;
  };
  espdiff::Molecule molecule;
  molecule.name = "peptide.pqr";
  molecule.radii_origin = espdiff::ValueOrigin::kFile;
  for (int r = 0; r < n_residues; ++r) {
    const auto& [residue, side_chain] = side_chains[static_cast<std::size_t>(r) % side_chains.size()];
    molecule.residues.push_back({residue, chain, r + 1, ' '});
    std::vector<Placed> atoms = backbone;
    atoms.insert(atoms.end(), side_chain.begin(), side_chain.end());
    for (const auto& [name, p] : atoms) {
      molecule.atoms.push_back({name, std::string(name).substr(0, 1), r, false});
      molecule.positions.push_back(p + espdiff::Vec3d{3.8 * r, 0, 0});
      molecule.radii.push_back(name[0] == 'H' ? 1.0F : 1.7F);
      molecule.charges.push_back(charge(name));
    }
  }
  return molecule;
}

/// Adds a group of one atom beside the peptide.
inline void add_ion(espdiff::Molecule& molecule, const std::string& name, float charge, espdiff::Vec3d p = {5, -6, 0}) {
  molecule.residues.push_back({name, "A", 900, ' '});
  molecule.atoms.push_back({name, name, static_cast<std::int32_t>(molecule.residues.size() - 1), true});
  molecule.positions.push_back(p);
  molecule.radii.push_back(1.4F);
  molecule.charges.push_back(charge);
}

}  // namespace espdiff_test
