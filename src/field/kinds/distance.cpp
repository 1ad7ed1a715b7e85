// distance.cpp: the distance to the nearest selected atom.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/engine.h"
#include "field/field.h"
#include "io/molecules/select_atoms.h"

namespace espdiff {
namespace {

std::vector<float> distances_to(const std::vector<Vec3d>& centres, const FieldPlace& place) {
  std::vector<Vec3f> moved;
  for (const Vec3d& centre : centres) moved.push_back(static_cast<Vec3f>(place.to_common.apply(centre)));
  std::vector<float> distances;
  for (const Vec3f& p : place.engine.download_positions(place.mesh)) {
    float square = std::numeric_limits<float>::infinity();
    for (const Vec3f& centre : moved) square = std::min(square, dot(p - centre, p - centre));
    distances.push_back(std::sqrt(square));
  }
  return distances;
}

}  // namespace

/// The selection is made in each state by itself.
FieldKind distance_kind() {
  FieldKind kind{{"distance", "Distance to a selection", "A", false},
                 "SELECTION",
                 "Distance to the centre of the nearest selected atom, such as of a ligand or an active site",
                 "",
                 nullptr};
  kind.field = [](const FieldKind& self, const std::string& selection) {
    Field field{self.quantity, "", "", nullptr};
    field.make = [selection](const Molecule& molecule, FieldSide) {
      const std::vector<bool> selected = select_some_atoms(molecule, selection, "field");
      std::vector<Vec3d> centres;
      for (std::size_t i = 0; i < molecule.size(); ++i) {
        if (selected[i]) centres.push_back(molecule.positions[i]);
      }
      StateField of_state;
      of_state.on_surface = [centres](const FieldPlace& place) { return distances_to(centres, place); };
      return of_state;
    };
    return field;
  };
  return kind;
}

}  // namespace espdiff
