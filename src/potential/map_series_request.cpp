// map_series_request.cpp: the table of a map's options.
#include "potential/map_series_request.h"

#include "base/error.h"
#include "io/structures/read_unit_cells.h"

namespace espdiff {

const std::vector<OptionRow<MapSeriesRequest>>& map_series_settings() {
  using Rows = RowsOf<MapSeriesRequest>;
  static const std::vector<Rows::Row> all{
      Rows::choice_of<PotentialMethod>(
          "method", "Method",
          {{"pme", PotentialMethod::kPme},
           {"pb", PotentialMethod::kPoissonBoltzmann},
           {"coulomb", PotentialMethod::kCoulomb}},
          [](auto& o) -> auto& { return o.method; },
          "pme: particle-mesh Ewald in a periodic cell (mean zero; a net charge is neutralized by a uniform "
          "background). pb: in salt water, by the Poisson-Boltzmann equation. coulomb: the bare law, isolated, summed "
          "directly"),
      Rows::text(
          "cell", "Cell", [](auto& o) -> auto& { return o.cell; },
          "Cell of every frame, '{{ox oy oz} {ax ay az} {bx by bz} {cx cy cz}}', o its centre. Default: each frame's "
          "own; without it, a box around the atoms"),
      Rows::file(
          "xscfile", "Cell", [](auto& o) -> auto& { return o.xsc_file; }, "Cell of every frame from a NAMD .xsc file"),
      Rows::choice_of<AlignAtoms>(
          "align", "Frames",
          {{"all", AlignAtoms::kAll},
           {"backbone", AlignAtoms::kBackbone},
           {"ca", AlignAtoms::kCAlpha},
           {"none", AlignAtoms::kNone}},
          [](auto& o) -> auto& { return o.align; },
          "Superpose each frame on the first by these atoms; the maps then follow the molecule"),
      Rows::choice_of<bool>(
          "averaging", "Frames", {{"mean", false}, {"each", true}}, [](auto& o) -> auto& { return o.each; },
          "mean: one map, the mean over the frames. each: a map for each frame, OUT.0000.dx and so on, by frame "
          "number"),
      Rows::count(
          "block", "Frames", {1}, [](auto& o) -> auto& { return o.frames_per_block; },
          "Frames in a block, for the standard error; more than the correlation time in frames")};
  return all;
}

PotentialOptions options_of(const MapSeriesRequest& request, const GivenPotentialSettings& given,
                            double temperature_K) {
  PotentialOptions o = make_potential_options(request.method, given, temperature_K, true);
  if (!request.cell.empty() && !request.xsc_file.empty())
    throw InputError(option("cell") + " and " + option("xscfile") + " were given; leave one out");
  if (request.method == PotentialMethod::kPoissonBoltzmann && !(request.cell.empty() && request.xsc_file.empty()))
    throw InputError("a cell was given, and " + option("method", "pb") + " has none; leave it out, or take " +
                     option("method", "pme"));
  if (!request.cell.empty()) o.cell = parse_cell(request.cell);
  if (!request.xsc_file.empty()) {
    const auto [centre, edge_a, edge_b, edge_c] = read_xsc(request.xsc_file);
    o.cell = PmeCell{centre, {edge_a, edge_b, edge_c}};
  }
  o.align = request.align;
  o.frames_per_block = request.frames_per_block;
  return o;
}

}  // namespace espdiff
