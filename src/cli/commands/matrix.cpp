// matrix.cpp: `espdiff matrix VARIANT... -o OUT`.
#include <iostream>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "io/structures/structure_file.h"
#include "matrix/matrix_table.h"
#include "options/options.h"
#include "study/matrix_settings.h"
#include "study/matrix_study.h"

namespace espdiff::cli {
namespace {

struct MatrixArguments {
  std::vector<std::string> files;
  std::string list, groups, map_array;
  PotentialRequest potential;
  MatrixStudy study;
  bool quiet = false;
  StructureOptions structure;
  ComputingOptions computing;
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

MatrixStudy::Item item_of(const MatrixArguments& a, const VariantFiles& files) {
  State state;
  state.path = files.structure;
  state.input.sha256 = files.sha256;
  state.structure = a.structure;
  state.structure.model = files.model;
  state.map_path = files.map;
  state.map_unit = files.map_unit;
  state.map_array = a.map_array;
  return {std::make_shared<const State>(std::move(state)), files.label, files.group};
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
    print_matrix(std::cout, *report.matrix, metric_to_cluster_by(a.study.run, *report.matrix));
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

int matrix_verb(const MatrixArguments& a, const Context& context) {
  MatrixStudy study = a.study;
  study.options = make_options(a.settings);
  study.settings = a.settings;
  study.potential = a.potential;
  study.structure = a.structure;
  for (const VariantFiles& files : chosen_variants(a)) study.variants.push_back(item_of(a, files));
  study.run.read_files = {a.list, a.groups};
  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  const MatrixReport report = run_matrix(study, *engine, *context.progress);
  if (!a.quiet) print_report(a, *engine, report);
  return 0;
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
  parser->add_option("VARIANT", a->files,
                     "Structures: " + structure_format_names() + "; each model of a file is a variant");
  parser->add_option("-o,--output", a->study.run.output, "Prefix of the results")->required();
  parser->add_option("--list", a->list, "Table of the variants, instead of files")->group("Molecules");
  parser->add_option("--groups", a->groups, "Table with the columns label and group")->group("Molecules");
  add_structure_options(*parser, a->structure);
  add_computed_map_options(*parser, a->potential);
  parser->add_option("--map-array", a->map_array, "Array of VTI maps with several")->group("Potentials");
  add_rows(*parser, matrix_settings(), a->study);
  add_settings(*parser, a->settings, SettingsFor::kVariants);
  add_rows(*parser, computing_settings(), a->computing);
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
