// whole_molecule.cpp: cuts between neighbours in a chain, and the parts on both sides.
#include "whole_molecule.h"

#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "align/geometry/unwrap.h"
#include "base/error.h"
#include "potential/potential.h"

namespace espdiff::vmdplugin {
namespace {

/// Whether two neighbours in a chain are bonded through the cell's border.
bool is_cut(const Molecule& molecule, const std::array<Vec3d, 3>& edges) {
  constexpr double kNear_A = 5;
  for (std::size_t i = 1; i < molecule.size(); ++i) {
    const Residue &a = molecule.residues[static_cast<std::size_t>(molecule.atoms[i - 1].residue)],
                  &b = molecule.residues[static_cast<std::size_t>(molecule.atoms[i].residue)];
    if (a.chain != b.chain || std::abs(static_cast<int>(a.number) - static_cast<int>(b.number)) > 1) continue;
    const Vec3d apart = molecule.positions[i] - molecule.positions[i - 1], near = shortest_image(apart, edges);
    if (norm(near) < kNear_A && norm(apart) > norm(near) + kNear_A) return true;
  }
  return false;
}

/// Lattice vectors of a shift, as whole tenths of an Angstrom.
std::array<long, 3> rounded(Vec3d shift) {
  return {std::lround(10 * shift.x), std::lround(10 * shift.y), std::lround(10 * shift.z)};
}

}  // namespace

std::size_t make_whole(Molecule& molecule, const UnitCell& cell, bool make_whole, const std::string& role) {
  if (molecule.size() < 2) return 0;
  const std::array<Vec3d, 3> edges = cell_from(cell, Vec3d{}).edges;
  if (!is_cut(molecule, edges)) return 0;
  std::vector<Vec3d> whole = unwrapped(molecule.positions, edges, {});
  std::map<std::array<long, 3>, std::size_t> parts;
  for (std::size_t i = 0; i < whole.size(); ++i) ++parts[rounded(whole[i] - molecule.positions[i])];
  std::array<long, 3> largest{};
  std::size_t n_largest = 0;
  for (const auto& [shift, n] : parts) {
    if (n > n_largest) std::tie(largest, n_largest) = std::make_tuple(shift, n);
  }
  const std::size_t n_moved = molecule.size() - n_largest;
  if (!make_whole)
    throw InputError(
        role + ": " + molecule.name + " is cut by its periodic cell: " + std::to_string(n_moved) + " of " +
        std::to_string(molecule.size()) +
        " atoms lie in another image than the rest; `whole 1` in the endpoint (-whole 1 for a trajectory) puts "
        "them together");
  Vec3d stays{};  // not rounded
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (rounded(whole[i] - molecule.positions[i]) == largest) stays = whole[i] - molecule.positions[i];
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Vec3d shift = whole[i] - molecule.positions[i];
    if (rounded(shift) != largest) molecule.positions[i] = molecule.positions[i] + (shift - stays);
  }
  return n_moved;
}

}  // namespace espdiff::vmdplugin
