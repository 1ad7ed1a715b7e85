// map.cpp: fields of any unit from maps.
#include <memory>

#include "field/field_files.h"
#include "io/grids/read_grid.h"

namespace espdiff {

FieldKind map_kind() {
  FieldKind kind{
      {"map", "Map", "", true},
      "SOURCE.FILE,TARGET.FILE",
      "Maps of any unit, each in the frame of its structure: OpenDX, VTI, cube, CCP4 or MRC files, such as water "
      "densities of VMD's volmap, cryo-EM maps, solvation maps",
      "",
      nullptr};
  kind.field = [](const FieldKind& self, const std::string& argument) {
    const SideFiles files(self.quantity.name, argument);
    Field field{self.quantity, "", "", nullptr};
    field.make = [files](const Molecule&, const FieldSide& side) {
      StateField of_state;
      of_state.map = std::make_shared<const Grid>(read_grid(files.own_of(side)));
      of_state.files = files.own_with_sum(side);
      return of_state;
    };
    field.files = files.with_sums();
    return field;
  };
  return kind;
}

}  // namespace espdiff
