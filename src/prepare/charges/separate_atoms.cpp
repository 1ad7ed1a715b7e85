// separate_atoms.cpp: counts atoms with too near a neighbour, by cells of that distance, and beads by their names.
#include "prepare/charges/separate_atoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/molecule/residue_label.h"
#include "base/types.h"

namespace espdiff {
namespace {

constexpr double kTooNear_A = 0.5, kMostNearShare = 0.1;
constexpr std::size_t kLeastNear = 10;

using Cell = std::array<std::int64_t, 3>;

Cell cell_at(const Vec3d& p) {
  return {std::llround(std::floor(p.x / kTooNear_A)), std::llround(std::floor(p.y / kTooNear_A)),
          std::llround(std::floor(p.z / kTooNear_A))};
}

/// An atom of the cells around one that lies too near, other than itself.
std::optional<std::size_t> near_atom(const Molecule& molecule, const std::map<Cell, std::vector<std::size_t>>& cells,
                                     std::size_t atom) {
  const Vec3d& at = molecule.positions[atom];
  const Cell centre = cell_at(at);
  for (int k = 0; k < 27; ++k) {
    const auto found = cells.find({centre[0] + k % 3 - 1, centre[1] + k / 3 % 3 - 1, centre[2] + k / 9 - 1});
    if (found == cells.end()) continue;
    for (const std::size_t other : found->second) {
      if (other != atom && norm(molecule.positions[other] - at) < kTooNear_A) return other;
    }
  }
  return std::nullopt;
}

std::string named_atom(const Molecule& molecule, std::size_t atom) {
  const auto residue = static_cast<std::size_t>(molecule.atoms[atom].residue);
  return molecule.atoms[atom].name + " of " + residue_label(molecule.residues[residue]);
}

/// Atoms that lie too near to another one, and the first two of them.
struct NearAtoms {
  std::size_t n = 0;
  std::pair<std::size_t, std::size_t> first;
};

/// @param counts whether an atom counts, and one that is near to it
template <typename Counts>
NearAtoms near_atoms(const Molecule& molecule, Counts counts) {
  std::map<Cell, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (counts(i)) cells[cell_at(molecule.positions[i])].push_back(i);
  }
  NearAtoms near;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (!counts(i)) continue;
    const std::optional<std::size_t> other = near_atom(molecule, cells, i);
    if (other && near.n++ == 0) near.first = {i, *other};
  }
  return near;
}

std::string in_words(const Molecule& molecule, const NearAtoms& near) {
  return " atoms lie within 0.5 A of another (" + named_atom(molecule, near.first.first) + " and " +
         named_atom(molecule, near.first.second) + ")";
}

}  // namespace

std::string misplaced_hydrogens(const Molecule& molecule) {
  const NearAtoms near = near_atoms(molecule, [](std::size_t) { return true; });
  if (near.n < kLeastNear) return {};
  const NearAtoms heavy = near_atoms(molecule, [&](std::size_t i) { return molecule.atoms[i].element != "H"; });
  return heavy.n > 0 ? std::string() : std::to_string(near.n) + in_words(molecule, near);
}

void require_separate_atoms(const Molecule& molecule) {
  const NearAtoms near = near_atoms(molecule, [](std::size_t) { return true; });
  if (near.n < kLeastNear || static_cast<double>(near.n) < kMostNearShare * static_cast<double>(molecule.size()))
    return;
  throw InputError(molecule.name + ": " + std::to_string(near.n) + " of " + std::to_string(molecule.size()) +
                   in_words(molecule, near) +
                   ": give coordinates in Angstrom, not in nm, and each chain and model once");
}

void require_all_atoms(const Molecule& molecule) {
  std::size_t n_beads = 0, n_alpha = 0, n_backbone = 0, first = 0;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const std::string& name = molecule.atoms[i].name;
    const bool is_bead = name.rfind("BB", 0) == 0 || name.rfind("SC", 0) == 0 || name == "SHA";
    if (is_bead && n_beads++ == 0) first = i;
    if (molecule.atoms[i].element != "C" && molecule.atoms[i].element != "N" && molecule.atoms[i].element != "O")
      continue;
    n_alpha += name == "CA" ? 1 : 0;
    n_backbone += name == "CA" || name == "N" || name == "C" || name == "O" || name == "CB" ? 1 : 0;
  }
  constexpr std::size_t kLeastResidues = 5;
  const bool has_long_ones =
      std::any_of(molecule.residues.begin(), molecule.residues.end(),
                  [](const Residue& residue) { return residue.name != "GLY" && residue.name != "ALA"; });
  if (n_alpha >= kLeastResidues && n_backbone == molecule.size() && (has_long_ones || n_alpha == molecule.size()))
    throw InputError(molecule.name + ": has no charges, and PDB2PQR cannot prepare it: it has " +
                     (n_alpha == molecule.size() ? "C-alpha atoms only" : "a backbone without side chains") +
                     "; give the structure with all atoms, or charges (" + option("topology", "FILE") +
                     " of a PSF or prmtop, or a PQR)");
  if (2 * n_beads <= molecule.size()) return;
  throw FormatError(molecule.name, 0,
                    "has coarse-grained beads (" + named_atom(molecule, first) +
                        "), which have neither hydrogens nor charges of atoms; give the structure with all atoms, or a "
                        "PQR with each bead's charge and radius");
}

}  // namespace espdiff
