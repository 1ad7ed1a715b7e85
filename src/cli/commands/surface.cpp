// surface.cpp: `espdiff surface MOLECULE`.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "base/formatted.h"
#include "base/units.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/grids/write_grid.h"
#include "io/structures/structure_file.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"
#include "report/sections/preparation_json.h"
#include "report/write_surface.h"

namespace espdiff::cli {
namespace {

struct SurfaceArguments {
  std::string molecule, output, density, map, map_unit, map_array;
  bool regularize = false;
  bool quiet = false, overwrite = false;
  StructureOptions structure;
  PotentialRequest potential;
  ComputingOptions computing;
  GivenSettings settings;
};

/// The structure with charges where a potential is asked for.
LoadedState load(const SurfaceArguments& a, const InputOptions& options, const Progress& progress) {
  const bool asks = a.potential.potential != "none";
  if (!a.map.empty() && asks)
    throw InputError(option("potential") + " computes the map, and --map was given; leave out one of them");
  const StructureFile file(a.molecule);
  LoadedState state = load_for(a.potential, a.map.empty(), file, {a.structure, StateRole::kOnly}, options, progress);
  check_left_out(options, {&state});
  return state;
}

void print_summary(const SurfaceResult& result) {
  std::cout << formatted("surface        %zu vertices, %zu triangles, %zu component%s\n", result.summary.n_vertices,
                         result.summary.n_triangles, result.summary.n_components,
                         result.summary.n_components == 1 ? "" : "s");
  std::cout << formatted("area           %.1f A^2\n", result.summary.area_A2);
  if (result.summary.n_cavities_left_out > 0) {
    std::cout << formatted("cavities       %zu removed, %.1f A^2 (--cavities keeps them)\n",
                           result.summary.n_cavities_left_out, result.summary.cavity_area_A2);
  }
  if (!result.potential.empty()) {
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (const float value : result.potential) {
      if (std::isnan(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    std::cout << formatted("potential      %.3f to %.3f %s%s%s\n", static_cast<double>(least),
                           static_cast<double>(most), to_string(result.unit).c_str(), result.is_vacuum ? kInVacuum : "",
                           result.potential_label.empty() ? "" : (", " + result.potential_label).c_str());
  }
  if (result.outside_map > 0)
    std::cout << formatted("outside map    %.1f %% of the vertices have no potential, since the map ends before them\n",
                           100 * result.outside_map);
  for (const auto& [stage, ms] : result.time_ms) {
    if (stage == "total") std::cout << formatted("time           %.0f ms\n", ms);
  }
}

int surface_verb(SurfaceArguments& a, const Context& context) {
  if (a.output.empty()) a.output = output_file(a.molecule, ".vtp");
  const CompareOptions options = make_options(a.settings);
  std::vector<std::string> inputs = input_files(options.input);
  inputs.insert(inputs.end(), {a.molecule, a.map});
  check_outputs(inputs, {a.output, a.density}, a.overwrite);
  // Outputs that cannot be written are better found before the work than after it.
  AtomicFile surface(a.output);
  std::unique_ptr<AtomicFile> density;
  if (!a.density.empty()) density = std::make_unique<AtomicFile>(a.density);
  context.progress->report("read", 0.0);
  LoadedState state = load(a, options.input, *context.progress);
  Molecule& molecule = state.molecule;
  CompareInput input{&molecule, nullptr};
  const PotentialPlan plan(a.potential, {facts_of(state)}, options.temperature_K);
  if (plan.computes()) input.make_map = plan.map_of(state).maker();
  const std::string note = set_surface_radii({&molecule}, options.input.radii);
  Grid map;
  if (!a.map.empty()) {
    map = read_map(a.map, a.map_array, a.map_unit).grid;
    input.map = &map;
  }
  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  const SurfaceResult result = make_surface(*engine, input, options, a.regularize, *context.progress);
  write_surface(surface, molecule, result, result.unit);
  std::vector<AtomicFile*> files = {&surface};
  if (density != nullptr) {
    write_dx(*density, make_density(*engine, molecule, options.surface));
    files.push_back(density.get());
  }
  context.progress->report("write", 1.0);
  commit_all(files);
  if (a.quiet) return 0;
  print_preparation(std::cout, state);
  if (!plan.because().empty()) std::cout << "potential      none: " << plan.because() << '\n';
  if (!note.empty()) std::cout << "radii          " << note << '\n';
  if (!map.contradicting_title.empty())
    std::cout << "map            calls itself '" << map.contradicting_title << "', but is taken as a potential\n";
  print_summary(result);
  std::cout << "written        " << a.output << (a.density.empty() ? "" : ", " + a.density) << '\n';
  return 0;
}

}  // namespace

Verb add_surface(CLI::App& app) {
  auto a = std::make_shared<SurfaceArguments>();
  CLI::App* parser =
      app.add_subcommand("surface", "Write a molecule's surface, with its potential if one is given or asked for");
  parser->footer(
      "A structure without charges is prepared by PDB2PQR where a potential is asked for, as by `espdiff compare`.");
  parser->add_option("MOLECULE", a->molecule, "Structure: " + structure_format_names())->required();
  parser->add_option("-o,--output", a->output, "Surface to write; MOLECULE.vtp in the working folder");
  parser->add_option("--map", a->map, "Potential map: DX, VTI or cube")->group("Potentials");
  parser->add_option("--map-unit", a->map_unit, "Unit of the map if the file does not give it")->group("Potentials");
  parser->add_option("--map-array", a->map_array, "Array of a VTI map with several")->group("Potentials");
  add_model_option(*parser, a->structure);
  parser->add_option("--density", a->density, "Also write the surface's density (.dx, for VMD)");
  parser->add_flag("--regularize", a->regularize, "Regularize the triangles");
  add_overwrite(*parser, a->overwrite);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  a->potential.potential = "none";
  add_computed_map_options(*parser, a->potential);
  add_structure_options(*parser, a->structure);
  add_settings(*parser, a->settings, SettingsFor::kSurface);
  add_rows(*parser, computing_settings(), a->computing);
  set_help(*parser,
           {"--output --overwrite --map --potential --select --ph --ligand --grid-spacing --regularize --threads",
            {"espdiff surface protein.pqr --map protein.dx --regularize -o surface.vtp",
             "espdiff surface entry.pdb --select '//A;polymer' --potential pb -o surface.vtp"}});
  return {parser, [a](const Context& context) { return surface_verb(*a, context); }};
}

}  // namespace espdiff::cli
