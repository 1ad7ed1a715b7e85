// The place of a patch on another surface: exact on a rigid copy, whatever moved elsewhere; and where there is none.
#include "certificate/place_patch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "align/geometry/superpose.h"
#include "base/molecule/earlier_patch.h"
#include "base/molecule/surface_parts.h"
#include "support/test_data.h"

using namespace espdiff;  // NOLINT: a test
using espdiff_test::message_of;

namespace {

constexpr int kRows = 24, kColumns = 36, kResidues = 24;
constexpr double kPi = 3.14159265358979323846;

/// A lopsided closed shape of 24 residues of one chain, a ring of vertices after the other; residue 5 to 8 are a patch.
EarlierPatch made_patch() {
  EarlierPatch patch;
  patch.path = "wild.json";
  patch.number = 1;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double a = kPi * (i + 0.5) / kRows, b = 2 * kPi * j / kColumns;
      const double r = 12 + 2 * std::sin(3 * b) * std::sin(a) + 1.5 * std::cos(2 * a);
      patch.positions.push_back(
          {r * std::sin(a) * std::cos(b), 1.4 * r * std::sin(a) * std::sin(b), 0.8 * r * std::cos(a)});
      patch.residue.push_back((i / 6) * 6 + j / 6);
      if (i == 0) continue;
      const auto v = [](int row, int column) { return static_cast<std::uint32_t>(row * kColumns + column % kColumns); };
      patch.triangles.push_back({v(i - 1, j), v(i, j), v(i - 1, j + 1)});
      patch.triangles.push_back({v(i - 1, j + 1), v(i, j), v(i, j + 1)});
    }
  }
  const char* const names[] = {"ALA", "LYS", "GLU", "TRP", "GLY", "SER", "LEU"};
  for (int r = 0; r < kResidues; ++r) {
    Residue residue;
    residue.name = names[(r * r + r / 3) % 7];
    residue.chain = "A";
    residue.number = r + 1;
    patch.residues.push_back(residue);
  }
  for (const std::int32_t r : patch.residue) patch.inside.push_back(r >= 5 && r <= 8 ? 1 : 0);
  return patch;
}

RigidTransform turned() {
  const double c = std::cos(0.7), s = std::sin(0.7);
  RigidTransform t;
  const double rotation[] = {c, -s, 0, s, c, 0, 0, 0, 1};
  std::copy(std::begin(rotation), std::end(rotation), std::begin(t.rotation));
  t.translation = {30, -12, 5};
  return t;
}

PlacedPatch placed_on(const EarlierPatch& patch, const EarlierPatch& other) {
  return place_patch(patch, {other.positions, other.triangles, other.residue, other.residues}, "mutant.pdb");
}

}  // namespace

TEST_CASE("on a rigid copy the patch is found vertex by vertex") {
  const EarlierPatch patch = made_patch();
  EarlierPatch copy = patch;
  for (Vec3d& p : copy.positions) p = turned().apply(p);
  const PlacedPatch placed = placed_on(patch, copy);
  CHECK(placed.inside == patch.inside);
  CHECK(placed.placement->found_area_fraction == doctest::Approx(1));
  CHECK(placed.placement->rmsd_A < 1e-6);
  CHECK(placed.placement->n_left_out == 0);
  CHECK(placed.placement->n_residues >= 6);
  const std::vector<std::uint8_t> residues =
      residues_in_patch(placed.inside, {copy.positions, copy.triangles, copy.residue, copy.residues});
  for (std::size_t r = 0; r < residues.size(); ++r) CHECK(residues[r] == (r >= 5 && r <= 8 ? 1 : 0));
}

TEST_CASE("the patch follows its surroundings: a mutation, other numbers, and a far part that moved change nothing") {
  const EarlierPatch patch = made_patch();
  EarlierPatch other = patch;
  other.residues[7].name = "HIS";
  for (Residue& residue : other.residues) {
    residue.number += 100;
    residue.chain = "B";
  }
  for (std::size_t v = 0; v < other.positions.size(); ++v) {
    if (other.residue[v] >= 18) other.positions[v].z -= 15;
    other.positions[v] = turned().apply(other.positions[v]);
  }
  const PlacedPatch placed = placed_on(patch, other);
  // The triangles between both parts are stretched, which shifts the centres beside them.
  std::size_t n_other = 0;
  for (std::size_t v = 0; v < patch.inside.size(); ++v) n_other += placed.inside[v] != patch.inside[v] ? 1 : 0;
  CHECK(n_other <= 8);  // of 864
  CHECK(placed.placement->found_area_fraction > 0.95);
}

TEST_CASE("a neighbour that turned over is left out of the superposition") {
  const EarlierPatch patch = made_patch();
  EarlierPatch other = patch;
  for (std::size_t v = 0; v < other.positions.size(); ++v) {
    if (other.residue[v] == 0) other.positions[v] = other.positions[v] + Vec3d{0, 0, 9};
  }
  const PlacedPatch placed = placed_on(patch, other);
  CHECK(placed.inside == patch.inside);
  CHECK(placed.placement->n_left_out == 1);
  CHECK(placed.placement->rmsd_A < 0.6);
}

TEST_CASE("a patch whose surface is not there is not found; a molecule that does not pair is refused") {
  const EarlierPatch patch = made_patch();
  EarlierPatch dented = patch;
  for (std::size_t v = 0; v < dented.positions.size(); ++v) {
    if (patch.inside[v] != 0) dented.positions[v] = 0.4 * dented.positions[v];
  }
  CHECK(placed_on(patch, dented).placement->found_area_fraction < kLeastFoundArea);
  EarlierPatch other = patch;
  for (Residue& residue : other.residues) {
    residue.name = "DA";
    residue.chain = "X";
  }
  CHECK(message_of([&] { placed_on(patch, other); }) ==
        "wild.json: patch 1 has no place on mutant.pdb: 0 of its residues pair, and three are needed; compare the same "
        "molecule");
}
