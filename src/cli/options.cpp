// options.cpp: options that several verbs share.
#include "cli/options.h"

#include "engine/select_engine.h"
#include "io/read_grid.h"

namespace espdiff::cli {

void add_device_options(CLI::App& parser, DeviceArguments& arguments) {
  parser.add_option("--device", arguments.device, "Where to compute: auto takes a GPU if one answers")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str()
      ->group("Computation");
  parser.add_option("--threads", arguments.threads, "CPU threads; 0 takes all. The result is the same for any number")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group("Computation");
}

std::unique_ptr<Engine> make_engine(const DeviceArguments& arguments) {
  return select_engine(parse_device_choice(arguments.device), arguments.threads);
}

void add_structure_options(CLI::App& parser, StructureOptions& options) {
  parser.add_flag("!--no-hetero", options.include_hetero, "Leave out HETATM records (ligands, ions)")
      ->group("Molecules");
  parser.add_flag("--water", options.include_water, "Keep water molecules, which are left out else")
      ->group("Molecules");
}

void add_surface_options(CLI::App& parser, SurfaceOptions& options) {
  parser.add_option("--grid-spacing", options.grid_spacing_A, "Lattice spacing of the density, Angstrom")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Surface");
  parser.add_option("--radius-scale", options.radius_scale, "Width of each atom's Gaussian in units of its radius")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Surface");
  parser.add_option("--isovalue", options.isovalue, "Density at which the surface lies; higher is tighter")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Surface");
  parser.add_flag("--cavities", options.cavities, "Keep closed cavities; they are counted and left out else")
      ->group("Surface");
  parser
      .add_flag("!--no-project", options.project,
                "Leave vertices where the lattice puts them, not on the exact isosurface")
      ->group("Surface");
}

Grid read_map(const std::string& path, const std::string& array, const std::string& unit) {
  GridOptions options;
  options.array = array;
  Grid map = read_grid(path, options);
  if (!unit.empty()) map.unit = parse_potential_unit(unit);
  return map;
}

}  // namespace espdiff::cli
