// made_molecule.h: molecules that tests build residue by residue.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff_test {

/// Collects residues; atoms lie on a bent line, so that no three are collinear.
struct MadeMolecule {
  espdiff::Molecule molecule;

  explicit MadeMolecule(const std::string& name = "made") { molecule.name = name; }

  void residue(const std::string& chain, int number, const std::string& name, const std::vector<std::string>& atoms) {
    molecule.residues.push_back({name, chain, number, ' '});
    for (const std::string& atom : atoms) {
      const double t = static_cast<double>(molecule.size());
      molecule.atoms.push_back({atom, "", static_cast<std::int32_t>(molecule.residues.size() - 1), false});
      molecule.positions.push_back({t, 0.1 * t * t, 0.01 * t * t * t});
      molecule.radii.push_back(1.5F);
    }
  }

  /// One residue for each letter (one-letter amino acids), with backbone and C-beta, numbered from `first`.
  void peptide(const std::string& chain, int first, const std::string& letters) {
    static const std::pair<char, const char*> names[] = {
        {'A', "ALA"}, {'R', "ARG"}, {'N', "ASN"}, {'D', "ASP"}, {'C', "CYS"}, {'Q', "GLN"}, {'E', "GLU"},
        {'G', "GLY"}, {'H', "HIS"}, {'I', "ILE"}, {'L', "LEU"}, {'K', "LYS"}, {'M', "MET"}, {'F', "PHE"},
        {'P', "PRO"}, {'S', "SER"}, {'T', "THR"}, {'W', "TRP"}, {'Y', "TYR"}, {'V', "VAL"}};
    for (const char letter : letters) {
      for (const auto& [code, name] : names) {
        if (code == letter) residue(chain, first, name, {"N", "CA", "C", "O", "CB"});
      }
      ++first;
    }
  }
};

}  // namespace espdiff_test
