// make_whole.cpp: bonds across the border of a periodic cell.
#include "prepare/make_whole.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "align/geometry/unwrap.h"
#include "align/residue_names.h"
#include "base/vector.h"

namespace espdiff {
namespace {

/// Place of an atom by its name; -1 where there is none.
std::ptrdiff_t find_atom(const Molecule& molecule, const std::vector<std::size_t>& atoms, const char* name) {
  const auto found = std::find_if(atoms.begin(), atoms.end(),
                                  [&](std::size_t i) { return normalized_atom_name(molecule.atoms[i].name) == name; });
  return found == atoms.end() ? -1 : static_cast<std::ptrdiff_t>(*found);
}

/// Bonds that are short in an image of the cell only. Atoms that follow each other in a residue are near each other.
struct Crossings {
  const Molecule& molecule;
  const std::array<Vec3d, 3>& edges;

  std::size_t count() const {
    const auto atoms = atoms_of_residues(molecule);
    const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
    std::size_t n = 0;
    for (std::size_t r = 0; r < atoms.size(); ++r) {
      if (kinds[r] != ResidueKind::kAminoAcid && kinds[r] != ResidueKind::kNucleotide) continue;
      constexpr double kNear_A = 4, kApart_A = 10;
      for (std::size_t k = 1; k < atoms[r].size(); ++k) n += crosses(atoms[r][k - 1], atoms[r][k], kNear_A, kApart_A);
      if (r + 1 == atoms.size() || kinds[r + 1] != kinds[r] ||
          molecule.residues[r].chain != molecule.residues[r + 1].chain)
        continue;
      const bool is_amino_acid = kinds[r] == ResidueKind::kAminoAcid;
      const std::ptrdiff_t end = find_atom(molecule, atoms[r], is_amino_acid ? "C" : "O3'"),
                           begin = find_atom(molecule, atoms[r + 1], is_amino_acid ? "N" : "P");
      constexpr double kBond_A = 2;
      if (end >= 0 && begin >= 0)
        n += crosses(static_cast<std::size_t>(end), static_cast<std::size_t>(begin), kBond_A, kApart_A);
    }
    return n;
  }

  std::size_t crosses(std::size_t a, std::size_t b, double near_A, double apart_A) const {
    const Vec3d v = molecule.positions[b] - molecule.positions[a];
    return norm(v) > apart_A && norm(shortest_image(v, edges)) < near_A ? 1 : 0;
  }
};

}  // namespace

std::size_t make_whole(Molecule& molecule, const UnitCell& cell) {
  if (!can_be(cell)) return 0;  // an error only where the cell is needed
  const std::array<Vec3d, 3> edges = edges_of(cell);
  const std::size_t n = Crossings{molecule, edges}.count();
  if (n > 0) molecule.positions = unwrapped(molecule.positions, edges, {});
  return n;
}

std::string made_whole_in_words(std::size_t n_bonds) {
  return "crossed the border of its periodic cell at " + std::to_string(n_bonds) + (n_bonds == 1 ? " bond" : " bonds") +
         ", and was made whole";
}

}  // namespace espdiff
