// pair_maps.cpp: the table of the options of given maps.
#include "study/pair_maps.h"

namespace espdiff {

State PairMaps::of(bool is_source) const {
  State state;
  state.map_path = is_source ? source_map : target_map;
  state.map_unit = is_source ? source_map_unit : target_map_unit;
  state.map_array = map_array;
  return state;
}

const std::vector<OptionRow<PairMaps>>& pair_map_settings() {
  using Rows = RowsOf<PairMaps>;
  const std::string group = "Potentials";
  static const std::vector<Rows::Row> all{
      Rows::file(
          "source-map", group, [](auto& o) -> auto& { return o.source_map; },
          "Potential around the source: DX, VTI or cube, in the structure file's coordinates"),
      Rows::file(
          "target-map", group, [](auto& o) -> auto& { return o.target_map; }, "Potential around the target"),
      Rows::text(
          "source-map-unit", group, [](auto& o) -> auto& { return o.source_map_unit; },
          "Unit of the source map if the file does not give it: kT/e, mV, V, kcal/mol/e, kJ/mol/e, hartree/e"),
      Rows::text(
          "target-map-unit", group, [](auto& o) -> auto& { return o.target_map_unit; },
          "Unit of the target map if the file does not give it"),
      Rows::text(
          "map-array", group, [](auto& o) -> auto& { return o.map_array; }, "Array of VTI maps with several")};
  return all;
}

}  // namespace espdiff
