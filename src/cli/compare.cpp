// compare.cpp: `espdiff compare SOURCE TARGET -o OUT`.
#include <iostream>

#include "cli/map_options.h"
#include "cli/spelling.h"
#include "cli/verbs.h"
#include "compare/compare.h"
#include "compare/options.h"
#include "compare/result.h"
#include "engine/engine.h"
#include "io/atomic_file.h"
#include "io/check_outputs.h"
#include "io/structure_file.h"
#include "report/provenance.h"
#include "report/residue_values.h"
#include "report/write_compare.h"

namespace espdiff::cli {
namespace {

struct Arguments {
  std::string source, target, output;
  MapArguments maps;
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
  add_map_options(p, a.maps);
  p.add_option(
       "--residue-pdb", a.residue_pdb,
       "Also write the source as a PDB file whose B factors are the residues' --residue-quantity, for coloring in "
       "any program")
      ->group("Residues");
  p.add_option("--residue-quantity", a.residue_quantity,
               "Column of the residue table (mean_abs_difference; without potentials mean_displacement_A)")
      ->check(CLI::IsMember(residue_quantities()))
      ->group("Residues");
  p.add_option("--source-model", a.source_model, "Model of a multi-model source file, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Molecules");
  p.add_option("--target-model", a.target_model, "Model of a multi-model target file, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Molecules");
}

/// One of the two states.
struct Side {
  std::string role, path;
  std::unique_ptr<StructureFile> file;  // until all is read of it
  Molecule molecule;
  std::optional<Grid> map;
  std::optional<ComputedMap> computed;

  CompareInput input() const { return {&molecule, map ? &*map : nullptr, computed ? computed->maker() : MapMaker()}; }
};

StructureOptions structure_options(const Arguments& a, const std::string& role) {
  StructureOptions options = a.structure;
  options.model = role == "source" ? a.source_model : a.target_model;
  return options;
}

Side read_side(const Arguments& a, const std::string& role) {
  Side side;
  side.role = role;
  side.path = role == "source" ? a.source : a.target;
  side.file = std::make_unique<StructureFile>(side.path);
  side.molecule = side.file->read(structure_options(a, role));
  return side;
}

/// The maps of both sides: given, computed, or none. @returns why there is none, where that was not asked for
std::string add_maps(const Arguments& a, Side& source, Side& target, double temperature_K,
                     std::vector<InputFile>& inputs) {
  if (has_given_maps(a.maps)) {
    for (Side* side : {&source, &target}) side->map = given_map(a.maps, side->role, inputs);
    return {};
  }
  std::vector<ChargedFile> files;
  std::vector<PotentialFacts> facts;
  for (const Side* side : {&source, &target}) {
    files.push_back(a.maps.potential == "none" ? ChargedFile()
                                               : read_charged(*side->file, structure_options(a, side->role).model));
    facts.push_back(potential_facts(files.back().everything, files.back().cell));
  }
  const PotentialPlan plan(a.maps, facts, temperature_K);
  for (Side* side : {&source, &target}) {
    if (!plan.computes()) continue;
    side->computed = plan.map_of(side->molecule, files[side == &source ? 0 : 1]);
    inputs.push_back(computed_input(side->role + "_map", *side->computed));
  }
  return plan.because();
}

int run(const Arguments& a, const Context& context) {
  check_map_options(a.maps);
  const CompareOptions options = make_options(a.settings);
  check_outputs({a.source, a.target, a.maps.source_map, a.maps.target_map},
                {a.output + ".json", a.output + ".vtp", a.output + ".residues.csv", a.residue_pdb});
  // An unwritable output is found before the work.
  for (const char* suffix : {".json", ".vtp", ".residues.csv"}) AtomicFile probe(a.output + suffix);
  if (!a.residue_pdb.empty()) AtomicFile probe(a.residue_pdb);
  if (a.residue_pdb.empty() && !a.residue_quantity.empty())
    throw InputError("--residue-quantity needs --residue-pdb FILE");

  context.progress->report("read", 0.0);
  Side source = read_side(a, "source"), target = read_side(a, "target");
  Provenance provenance;
  provenance.command_line = context.command_line;
  for (const Side* side : {&source, &target})
    provenance.inputs.push_back(
        {side->role, side->path, side->file->sha256(), nullptr, structure_options(a, side->role)});
  const std::string because = add_maps(a, source, target, options.temperature_K, provenance.inputs);
  for (Side* side : {&source, &target}) side->file.reset();  // its text is no longer needed
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  provenance.device = engine->back_end();
  provenance.device_description = engine->description();
  provenance.threads = engine->n_threads();
  CompareResult result = compare(*engine, source.input(), target.input(), options, *context.progress);
  if (!result.has_potential) result.shapes_because = because;
  context.progress->report("write", 0.0);
  std::unique_ptr<AtomicFile> pdb;
  if (!a.residue_pdb.empty()) {
    pdb = std::make_unique<AtomicFile>(a.residue_pdb);
    const std::string usual = result.has_potential ? "mean_abs_difference" : "mean_displacement_A";
    write_residue_pdb(*pdb, source.molecule, result, a.residue_quantity.empty() ? usual : a.residue_quantity);
  }
  write_compare(a.output, source.molecule, target.molecule, result, options, provenance, pdb.get());
  context.progress->report("write", 1.0);
  if (!a.quiet) print_table(std::cout, source.molecule, target.molecule, result, spelled_option);
  return 0;
}

}  // namespace

Verb add_compare(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser =
      app.add_subcommand("compare", "Compare the electrostatic surface potentials of two states of a molecule");
  parser->footer(
      "Maps each point of the source's surface to the corresponding point of the target's, compares the potentials "
      "there, and\n"
      "certifies the mapping. Without maps the potentials are computed (--potential).\n\n"
      "Example:\n"
      "  espdiff compare wild.pqr mutant.pqr --source-map wild.dx --target-map mutant.dx -o result\n\n"
      "Writes result.json (numbers, certificate, provenance), result.vtp (mapped surface, for ParaView) and "
      "result.residues.csv.\n"
      "Exit status: 0 done, 1 could not compute, 2 wrong usage or input.");
  add_input_options(*parser, *arguments);
  add_structure_options(*parser, arguments->structure);
  add_settings(*parser, arguments->settings, false);
  add_device_options(*parser, arguments->device);
  parser->add_flag("-q,--quiet", arguments->quiet, "Print no table");
  return {parser, [arguments](const Context& context) { return run(*arguments, context); }};
}

}  // namespace espdiff::cli
