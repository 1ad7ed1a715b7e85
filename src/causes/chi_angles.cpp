// chi_angles.cpp: dihedral angles by atom names.
#include "causes/chi_angles.h"

#include <cmath>
#include <optional>
#include <string>

#include "align/residue_names.h"

namespace espdiff {
namespace {

std::optional<Vec3d> place_of(const Molecule& m, const std::vector<std::size_t>& atoms, const std::string& name) {
  for (const std::size_t i : atoms) {
    const char letter = residue_letter(m.residues[static_cast<std::size_t>(m.atoms[i].residue)].name);
    if (normalized_atom_name(m.atoms[i].name, letter) == name) return m.positions[i];
  }
  return std::nullopt;
}

/// [angle] degrees, as far as the atoms are there.
std::vector<double> chi_angles(const Molecule& m, const std::vector<std::size_t>& atoms, char letter) {
  std::vector<Vec3d> places;
  for (const std::string& name : side_chain_bonds(letter)) {
    const std::optional<Vec3d> place = place_of(m, atoms, name);
    if (!place) break;
    places.push_back(*place);
  }
  std::vector<double> angles;
  for (std::size_t i = 3; i < places.size(); ++i)
    angles.push_back(dihedral(places[i - 3], places[i - 2], places[i - 1], places[i]));
  return angles;
}

}  // namespace

std::vector<std::string> side_chain_bonds(char letter) {
  switch (letter) {
    case 'R': return {"N", "CA", "CB", "CG", "CD", "NE", "CZ"};
    case 'N': return {"N", "CA", "CB", "CG", "OD1"};
    case 'D': return {"N", "CA", "CB", "CG", "OD1"};
    case 'C': return {"N", "CA", "CB", "SG"};
    case 'Q': return {"N", "CA", "CB", "CG", "CD", "OE1"};
    case 'E': return {"N", "CA", "CB", "CG", "CD", "OE1"};
    case 'H': return {"N", "CA", "CB", "CG", "ND1"};
    case 'I': return {"N", "CA", "CB", "CG1", "CD1"};
    case 'L': return {"N", "CA", "CB", "CG", "CD1"};
    case 'K': return {"N", "CA", "CB", "CG", "CD", "CE", "NZ"};
    case 'M': return {"N", "CA", "CB", "CG", "SD", "CE"};
    case 'F': return {"N", "CA", "CB", "CG", "CD1"};
    case 'S': return {"N", "CA", "CB", "OG"};
    case 'T': return {"N", "CA", "CB", "OG1"};
    case 'W': return {"N", "CA", "CB", "CG", "CD1"};
    case 'Y': return {"N", "CA", "CB", "CG", "CD1"};
    case 'V': return {"N", "CA", "CB", "CG1"};
    default: return {};
  }
}

bool is_symmetric_end(char letter) { return letter == 'D' || letter == 'E' || letter == 'F' || letter == 'Y'; }

double dihedral(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d along = c - b, first = cross(b - a, along), second = cross(along, d - c);
  return std::atan2(norm(along) * dot(b - a, second), dot(first, second)) * 180 / kPi;
}

ChiTurn chi_turn(const Molecule& source, const std::vector<std::size_t>& source_atoms, const Molecule& target,
                 const std::vector<std::size_t>& target_atoms, double least) {
  if (source_atoms.empty() || target_atoms.empty()) return {};
  const auto letter_of = [](const Molecule& m, std::size_t atom) {
    return residue_letter(m.residues[static_cast<std::size_t>(m.atoms[atom].residue)].name);
  };
  const char letter = letter_of(source, source_atoms.front());
  if (letter != letter_of(target, target_atoms.front())) return {};
  const std::vector<double> a = chi_angles(source, source_atoms, letter), b = chi_angles(target, target_atoms, letter);
  const std::size_t n_all = side_chain_bonds(letter).size();
  ChiTurn turn;
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k) {
    double angle = std::fabs(std::remainder(b[k] - a[k], 360.0));
    if (is_symmetric_end(letter) && k + 4 == n_all) angle = std::min(angle, 180 - angle);
    if (turn.chi == 0 || angle > turn.angle) turn = {static_cast<int>(k) + 1, angle};
    if (angle > least) return turn;
  }
  return turn;
}

}  // namespace espdiff
