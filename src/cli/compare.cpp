// compare.cpp: `espdiff compare SOURCE TARGET -o OUT`.
#include <iostream>

#include "cli/options.h"
#include "cli/verbs.h"
#include "io/atomic_file.h"
#include "io/sha256.h"
#include "pipeline/residue_values.h"
#include "pipeline/write_compare.h"

namespace espdiff::cli {
namespace {

struct Arguments {
  std::string source, target, output;
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;
  ComputedPotentialArguments potential;
  std::string residue_pdb, residue_quantity;
  int source_model = 1, target_model = 1;
  bool quiet = false;
  StructureOptions structure;
  DeviceArguments device;
  GivenSettings settings;
};

void add_input_options(CLI::App& p, Arguments& a) {
  p.add_option("SOURCE", a.source, "Structure of the first state: PQR, PDB or mmCIF")->required();
  p.add_option("TARGET", a.target, "Structure of the second state")->required();
  p.add_option("-o,--output", a.output, "Prefix of the results OUT.json, OUT.vtp and OUT.residues.csv")->required();
  p.add_option("--source-map", a.source_map,
               "Potential around the source: DX, VTI or cube, in the structure file's coordinates")
      ->group("Potentials");
  p.add_option("--target-map", a.target_map, "Potential around the target")->group("Potentials");
  p.add_option("--source-map-unit", a.source_map_unit,
               "Unit of the source map if the file does not say: kT/e, mV, V, kcal/mol/e, hartree/e")
      ->group("Potentials");
  p.add_option("--target-map-unit", a.target_map_unit, "Unit of the target map if the file does not say")
      ->group("Potentials");
  p.add_option("--map-array", a.map_array, "Array to take from VTI maps that hold several")->group("Potentials");
  p.add_option(
       "--residue-pdb", a.residue_pdb,
       "Also write the source as a PDB file whose B factors are the residues' --residue-quantity, for coloring in "
       "any program")
      ->group("Residues");
  p.add_option("--residue-quantity", a.residue_quantity,
               "Column of the residue table (mean_abs_difference; without potentials mean_displacement_A)")
      ->check(CLI::IsMember(residue_quantities()))
      ->group("Residues");
  add_computed_potential_options(p, a.potential);
  p.add_option("--source-model", a.source_model, "Model of a multi-model source file, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Molecules");
  p.add_option("--target-model", a.target_model, "Model of a multi-model target file, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Molecules");
}

Molecule read_model(const Arguments& a, const std::string& path, int model) {
  StructureOptions options = a.structure;
  options.model = model;
  return read_structure(path, options);
}

int run(const Arguments& a, const Context& context) {
  if (a.potential.wanted() && !(a.source_map.empty() && a.target_map.empty()))
    throw InputError("--potential computes both maps; leave out --source-map and --target-map, or --potential");
  const CompareOptions options = make_options(a.settings);
  // An output that cannot be written is better found before the work than after it.
  for (const char* suffix : {".json", ".vtp", ".residues.csv"}) AtomicFile probe(a.output + suffix);
  if (!a.residue_pdb.empty()) AtomicFile probe(a.residue_pdb);
  if (a.residue_pdb.empty() && !a.residue_quantity.empty())
    throw InputError("--residue-quantity is of --residue-pdb FILE, which is missing");

  context.progress->report("read", 0.0);
  const Molecule source = read_model(a, a.source, a.source_model), target = read_model(a, a.target, a.target_model);
  CompareInput source_input{&source, nullptr}, target_input{&target, nullptr};
  Grid source_map, target_map;
  Provenance provenance;
  provenance.command_line = context.command_line;
  provenance.inputs = {{"source", a.source, sha256_of_file(a.source)}, {"target", a.target, sha256_of_file(a.target)}};
  if (!a.source_map.empty()) {
    source_map = read_map(a.source_map, a.map_array, a.source_map_unit);
    source_input.map = &source_map;
    provenance.inputs.push_back({"source_map", a.source_map, sha256_of_file(a.source_map)});
  }
  if (!a.target_map.empty()) {
    target_map = read_map(a.target_map, a.map_array, a.target_map_unit);
    target_input.map = &target_map;
    provenance.inputs.push_back({"target_map", a.target_map, sha256_of_file(a.target_map)});
  }
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  if (a.potential.wanted()) {
    source_map = computed_map(*engine, a.potential, source, options.temperature_K, *context.progress);
    target_map = computed_map(*engine, a.potential, target, options.temperature_K, *context.progress);
    source_input.map = &source_map;
    target_input.map = &target_map;
  }
  provenance.device = engine->back_end();
  provenance.device_description = engine->description();
  provenance.threads = engine->n_threads();
  const CompareResult result = compare(*engine, source_input, target_input, options, *context.progress);
  context.progress->report("write", 0.0);
  write_compare(a.output, source, target, result, options, provenance);
  if (!a.residue_pdb.empty()) {
    const std::string usual = result.has_potential ? "mean_abs_difference" : "mean_displacement_A";
    write_residue_pdb(a.residue_pdb, source, result, a.residue_quantity.empty() ? usual : a.residue_quantity);
  }
  context.progress->report("write", 1.0);
  if (!a.quiet) print_table(std::cout, source, target, result);
  return 0;
}

}  // namespace

Verb add_compare(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser =
      app.add_subcommand("compare", "Compare the electrostatic surface potentials of two states of a molecule");
  parser->footer(
      "Each point of the source's surface is mapped to its counterpart on the target's, the potentials there are "
      "compared, and the\n"
      "result says how far it can be trusted. Without maps the shapes alone are compared.\n\n"
      "Example:\n"
      "  espdiff compare wild.pqr mutant.pqr --source-map wild.dx --target-map mutant.dx -o result\n\n"
      "Writes result.json (numbers, certificate, provenance), result.vtp (mapped surface, for ParaView) and "
      "result.residues.csv.\n"
      "Exit status: 0 done, 1 could not be computed, 2 wrong usage or input.");
  add_input_options(*parser, *arguments);
  add_structure_options(*parser, arguments->structure);
  add_settings(*parser, arguments->settings, false);
  add_device_options(*parser, arguments->device);
  parser->add_flag("-q,--quiet", arguments->quiet, "Print no table");
  return {parser, [arguments](const Context& context) { return run(*arguments, context); }};
}

}  // namespace espdiff::cli
