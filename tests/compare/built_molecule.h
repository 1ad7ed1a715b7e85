// built_molecule.h: molecules that tests build atom by atom.
#pragma once

#include <cmath>
#include <string>

#include "base/types.h"

namespace espdiff_test {

/// A molecule that is built atom by atom.
struct Builder {
  espdiff::Molecule molecule;

  void add(const std::string& residue, int number, const std::string& name, espdiff::Vec3d p, float radius = 1.7F,
           const std::string& chain = "A") {
    const bool same = !molecule.residues.empty() && molecule.residues.back().number == number &&
                      molecule.residues.back().chain == chain;
    if (!same) molecule.residues.push_back({residue, chain, number, ' '});
    espdiff::Atom atom;
    atom.name = name;
    atom.element = "C";
    atom.residue = static_cast<std::int32_t>(molecule.residues.size() - 1);
    molecule.atoms.push_back(atom);
    molecule.positions.push_back(p);
    molecule.radii.push_back(radius);
    molecule.name = "made.pqr";
  }

  /// A ball of atoms on a cubic lattice, as its own residue.
  void add_ball(int number, espdiff::Vec3d centre, double radius, double spacing = 2.0,
                const std::string& chain = "A") {
    const int n = static_cast<int>(std::ceil(radius / spacing));
    int k = 0;
    for (int x = -n; x <= n; ++x)
      for (int y = -n; y <= n; ++y)
        for (int z = -n; z <= n; ++z) {
          const espdiff::Vec3d d{spacing * x, spacing * y, spacing * z};
          if (norm(d) <= radius) add("BAL", number, "C" + std::to_string(++k), centre + d, 1.7F, chain);
        }
  }
};

}  // namespace espdiff_test
