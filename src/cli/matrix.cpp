// matrix.cpp: `espdiff matrix VARIANT... -o OUT`.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "base/error.h"
#include "base/formatted.h"
#include "cli/help.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "compare/options.h"
#include "engine/engine.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#include "ensemble/template_matrix.h"
#endif
#include "io/structure_file.h"
#include "matrix/matrix_run.h"
#include "matrix/write_matrix.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"
#include "report/state_report.h"

namespace espdiff::cli {
namespace {

struct MatrixArguments {
  std::vector<std::string> files;
  std::string list, groups, map_array, shard = "1/1", on_error = "stop", template_text;
  std::size_t exact_sample = 6;
  PotentialRequest potential;
  MatrixRun run;
  bool quiet = false;
  StructureOptions structure;
  DeviceArguments device;
  GivenSettings settings;
};

std::vector<VariantFiles> chosen_variants(const MatrixArguments& a) {
  if (a.files.empty() == a.list.empty())
    throw InputError(a.list.empty() ? "no molecules were given: name files, or a --list of them"
                                    : "files and a --list were given; leave one out");
  std::vector<VariantFiles> variants = a.list.empty() ? variants_of_files(a.files) : read_variant_list(a.list);
  if (!a.groups.empty()) read_groups(a.groups, variants);
  for (const VariantFiles& v : variants) {
    if (a.potential.potential != "auto" && !v.map.empty())
      throw InputError("--potential computes all maps, and the list names one for '" + v.label +
                       "'; leave out one of them");
  }
  return variants;
}

bool has_maps(const std::vector<VariantFiles>& files) {
  return std::any_of(files.begin(), files.end(), [](const VariantFiles& f) { return !f.map.empty(); });
}

/// The molecules of all variants, and their potentials, chosen for all of them together.
struct States {
  std::vector<Variant> variants;
  PotentialPlan plan;
  std::string radii_note;  ///< of set_surface_radii()
};

/// Each structure is read once.
States read_states(const MatrixArguments& a, const std::vector<VariantFiles>& files, const CompareOptions& options,
                   const Progress& progress) {
  matrix_pairs(files.size(), a.run.shard);  // refuses what is too large before anything is read
  States all;
  std::vector<LoadedState> states;
  std::unique_ptr<StructureFile> structure;  // several models of one follow each other
  std::string open_path;
  const bool wants_charges = !has_maps(files);
  for (const VariantFiles& file : files) {
    const double fraction = static_cast<double>(states.size()) / static_cast<double>(files.size());
    progress.report("read " + file.label, fraction);
    if (structure == nullptr || open_path != file.structure) {
      structure = std::make_unique<StructureFile>(file.structure);
      open_path = file.structure;
    }
    StateRequest request{a.structure};
    request.structure.model = file.model;
    request.source = states.empty() ? nullptr : &states.front().molecule;
    states.push_back(load_for(a.potential, wants_charges, *structure, request, options.input, progress));
    if (options.input.region_of.empty()) states.back().whole = {};  // a region near other atoms refers to them
    all.variants.push_back(read_variant(file, *structure, states.back().molecule, a.map_array));
    const auto inputs = state_inputs("structure", all.variants.back().inputs.front(), states.back());
    all.variants.back().inputs.insert(all.variants.back().inputs.end(), inputs.begin() + 1, inputs.end());
  }
  std::vector<const LoadedState*> loaded;
  loaded.reserve(states.size());
  for (const LoadedState& state : states) loaded.push_back(&state);
  check_left_out(options.input, loaded);
  if (wants_charges && a.potential.potential != "none") {
    std::vector<PotentialFacts> facts;
    facts.reserve(states.size());
    for (const LoadedState& state : states) facts.push_back(facts_of(state));
    all.plan = PotentialPlan(a.potential, facts, options.temperature_K);
  }
  std::vector<Molecule*> molecules;
  for (std::size_t i = 0; i < states.size(); ++i) {
    Variant& variant = all.variants[i];
    molecules.push_back(&variant.molecule);
    if (!all.plan.computes()) continue;
    const ComputedMap map = all.plan.map_of(states[i]);
    variant.make_map = map.maker();
    variant.inputs.push_back(computed_input("map", map));
  }
  std::vector<const Molecule*> wholes;
  for (std::size_t i = 0; i < states.size(); ++i)
    wholes.push_back(states[i].whole.size() > 0 ? &states[i].whole : &all.variants[i].molecule);
  set_parts(all.variants, wholes, options.input);
  set_fields(all.variants, options);
  all.radii_note = set_surface_radii(molecules, options.input.radii);
  unite_map_units(all.variants, options.temperature_K);
  return all;
}

void print_template_work(const TemplateWork& work) {
  const std::size_t n = work.n_states - work.n_states_resumed;
  std::cout << n << " states mapped in " << in_words(work.seconds);
  if (n > 0) std::cout << formatted(", %.2f s a state", work.seconds / static_cast<double>(n));
  if (work.n_states_resumed > 0) std::cout << "; " << work.n_states_resumed << " were there already";
  std::cout << "; " << work.n_exact - work.n_exact_resumed << " exact pairs computed in "
            << in_words(work.exact_seconds);
}

void print_report(const MatrixArguments& a, const Engine& engine, const MatrixReport& report) {
  if (report.matrix) {
    print_matrix(std::cout, *report.matrix, metric_to_cluster_by(a.run, *report.matrix));
  }
  const std::size_t n = report.n_pairs - report.n_resumed;
  std::cout << '\n';
  if (report.template_work) {
    print_template_work(*report.template_work);
  } else {
    std::cout << n << " pairs computed in " << in_words(report.seconds);
  }
  if (n > 0 && !report.template_work) {
    std::cout << ", " << formatted("%.2f", report.seconds / static_cast<double>(n)) << " s a pair";
  }
  std::cout << " (" << engine.description() << ")";
  if (report.n_resumed > 0) std::cout << "; " << report.n_resumed << " were there already";
  if (report.cut_off) std::cout << "; the last row of the state file was cut off, and its pair computed again";
  std::cout << "\nwritten:";
  for (const std::string& file : report.files) std::cout << ' ' << file;
  std::cout << '\n';
}

MatrixReport compute(const MatrixArguments& a, Engine& engine, const std::vector<Variant>& variants,
                     const CompareOptions& options, const Progress& progress) {
  if (a.template_text.empty()) return run_matrix(engine, variants, options, a.run, progress);
#ifdef ESPDIFF_HAVE_HDF5
  const TemplateRequest request{a.template_text, a.exact_sample, ensemble_options(a.settings), a.structure};
  return run_template_matrix(engine, variants, options, request, a.run, progress);
#else
  throw InputError("--template: the potentials are kept in an HDF5 file, and this program was built without HDF5");
#endif
}

int matrix_verb(MatrixArguments& a, const Context& context) {
  const CompareOptions options = make_options(a.settings);
  a.run.shard = parse_shard(a.shard);
  a.run.skip_errors = a.on_error == "skip";
  const std::vector<VariantFiles> files = chosen_variants(a);
  a.run.read_files = input_files(options.input);
  a.run.read_files.insert(a.run.read_files.end(), {a.list, a.groups});
  if (std::filesystem::exists(a.template_text)) a.run.read_files.push_back(a.template_text);
  for (const VariantFiles& file : files) a.run.read_files.insert(a.run.read_files.end(), {file.structure, file.map});
  a.run.through_template = !a.template_text.empty();
  check_matrix_files(a.run, {});
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  const States states = read_states(a, files, options, *context.progress);
  a.run.potential = states.plan.computes() ? states.plan.in_words() : "maps";
  a.run.radii_note = states.radii_note;
  const MatrixReport report = compute(a, *engine, states.variants, options, *context.progress);
  context.progress->report("write", 1.0);
  if (!a.quiet) print_report(a, *engine, report);
  return 0;
}

void add_template_options(CLI::App& p, MatrixArguments& a) {
  p.add_option(
       "--template", a.template_text,
       "Map the surface of one structure onto each variant, and compare all variants in its vertices: a mapping "
       "for each variant instead of each pair, and differences of potentials only. medoid: the variant nearest "
       "to all others; a label; a number from 0; a structure file. The potentials stay in OUT.h5")
      ->group("Template");
  p.add_option("--exact-sample", a.exact_sample,
               "Pairs, chosen at random, that are compared by themselves as well, to tell how far the template's are "
               "from exact ones; 0 for none")
      ->capture_default_str()
      ->group("Template");
}

void add_run_options(CLI::App& p, MatrixArguments& a) {
  p.add_flag("--resume", a.run.resume, "Resume an interrupted run from its state file OUT.state")->group("Run");
  p.add_flag("--overwrite", a.run.overwrite, "Start again and replace results and state files")->group("Run");
  p.add_option("--on-error", a.on_error,
               "A pair that cannot be compared stops the run, or is skipped and noted in the results")
      ->check(CLI::IsMember({"stop", "skip"}))
      ->capture_default_str()
      ->group("Run");
  p.add_option("--shard", a.shard,
               "Compute part I of N of the pairs, I/N, into OUT.shard-I-of-N.state; `espdiff merge` merges the parts "
               "together")
      ->capture_default_str()
      ->group("Run");
}

}  // namespace

Verb add_matrix(CLI::App& app) {
  auto a = std::make_shared<MatrixArguments>();
  CLI::App* parser =
      app.add_subcommand("matrix", "Compare many states of a molecule, each with each, in both directions");
  parser->footer(
      "Writes OUT.csv (a row for each ordered pair) and OUT.json (matrices, groups, clusters); `espdiff plot` draws "
      "them.\nA list is a table of comma-separated values whose first row names its columns: structure, and optionally "
      "model, map,\nunit (of the map), label, group. Paths are relative to the list.");
  parser->add_option("VARIANT", a->files, "Structures: PQR, PDB or mmCIF; each model of a file is a variant");
  parser->add_option("-o,--output", a->run.output, "Prefix of the results")->required();
  parser->add_option("--list", a->list, "Table of the variants, instead of files")->group("Molecules");
  parser->add_option("--groups", a->groups, "Table with the columns label and group")->group("Molecules");
  parser->add_option("--cluster-by", a->run.cluster_by,
                     "Metric for clustering (mean_abs_difference; without potentials "
                     "mean_displacement_A)");
  add_structure_options(*parser, a->structure);
  add_computed_map_options(*parser, a->potential);
  parser->add_option("--map-array", a->map_array, "Array of VTI maps with several")->group("Potentials");
  add_template_options(*parser, *a);
  add_run_options(*parser, *a);
  add_settings(*parser, a->settings, SettingsFor::kVariants);
  add_device_options(*parser, a->device);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(
      *parser,
      {"--output --list --resume --overwrite --template --shard --cluster-by --select --potential --region --patch "
       "--offset --threads --quiet",
       {"espdiff matrix m*.pqr -o ubiquitin",
        "espdiff matrix --list variants.csv --template medoid -o variants --resume",
        "espdiff matrix m*.pqr --shard 2/8 -o part      # one of eight; then: espdiff merge part.*.state -o all"}});
  return {parser, [a](const Context& context) { return matrix_verb(*a, context); }};
}

}  // namespace espdiff::cli
