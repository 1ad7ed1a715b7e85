// matrix_study.cpp: the order of a matrix's parts.
#include "study/matrix_study.h"

#include <filesystem>

#include "base/error.h"
#include "base/molecule/structure_options.h"
#include "engine/engine.h"
#include "prepare/input_files.h"
#include "prepare/surface_radii.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#include "ensemble/template_matrix.h"
#endif

namespace espdiff {
namespace {

std::vector<StatePtr> states_of(const MatrixStudy& study) {
  std::vector<StatePtr> states;
  for (const MatrixStudy::Item& item : study.variants) states.push_back(item.state);
  return states;
}

/// Before anything is read: outputs that would replace an input, and matrices that are too large.
MatrixRun checked_run(const MatrixStudy& study) {
  matrix_pairs(study.variants.size(), study.run.shard);
  MatrixRun run = study.run;
  run.through_template = !study.template_text.empty();
  const std::vector<std::string> of_settings = input_files(study.options.input);
  run.read_files.insert(run.read_files.end(), of_settings.begin(), of_settings.end());
  if (std::filesystem::exists(study.template_text)) run.read_files.push_back(study.template_text);
  std::vector<std::string> labels;
  for (const MatrixStudy::Item& item : study.variants) {
    labels.push_back(item.label);
    run.read_files.insert(run.read_files.end(), {item.state->path, item.state->map_path});
  }
  check_matrix_files(run, {});
  check_labels(labels);
  return run;
}

/// Radii that all variants take; by `auto` each pair has its own, unless a template has one surface for all.
/// @returns a note for the results
std::string set_radii(std::vector<Variant>& variants, RadiiChoice choice, bool through_template) {
  std::vector<Molecule*> molecules;
  for (Variant& variant : variants) molecules.push_back(&variant.molecule);
  if (through_template || choice != RadiiChoice::kAuto) return set_surface_radii(molecules, choice);
  for (const Molecule* molecule : molecules) {
    const std::string conflict = radii_conflict(*molecules.front(), *molecule);
    if (!conflict.empty()) return conflict + "; pairs of such take Bondi's radii by element";
  }
  return {};
}

std::vector<Variant> read_variants(const MatrixStudy& study, int n_threads, const Progress& progress, MatrixRun& run) {
  const std::size_t n = study.variants.size();
  const std::vector<StatePtr> given = states_of(study);
  StateReader reader({study.options, study.potential, study.each_by_itself, study.refuses_shapes, n_threads}, given,
                     progress);
  std::vector<ComparedState> states;
  std::vector<ComparedState*> all;
  states.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    progress.report("read " + study.variants[i].label, static_cast<double>(i) / static_cast<double>(n));
    states.push_back(reader.read(StateRole::kOnly, i == 0 ? nullptr : &states.front().loaded.molecule));
    if (study.options.input.region_of.empty()) states.back().loaded.whole = {};  // regions near atoms refer to it
    all.push_back(&states.back());
  }
  const PotentialPlan plan = reader.add_maps(all);
  run.potential = potential_in_words(plan, given, study.options.temperature_K);
  std::vector<Variant> variants(n);
  std::vector<const Molecule*> wholes;
  for (std::size_t i = 0; i < n; ++i) {
    Variant& variant = variants[i];
    ComparedState& state = states[i];
    variant.label = study.variants[i].label;
    variant.group = study.variants[i].group;
    variant.inputs = std::move(state.inputs);
    InputFile& structure = variant.inputs.front();
    if (structure.read_with)
      structure.path = with_model(structure.path, static_cast<std::size_t>(structure.read_with->model));
    structure.read_with.reset();
    variant.inputs.insert(variant.inputs.end(), state.map_inputs.begin(), state.map_inputs.end());
    variant.origin = state.loaded;
    variant.molecule = std::move(state.loaded.molecule);
    if (state.map != nullptr) variant.map = *state.map;
    variant.make_map = state.make_map;
    variant.fields = state.fields;
    wholes.push_back(state.loaded.whole.size() > 0 ? &state.loaded.whole : &variant.molecule);
  }
  set_parts(variants, wholes, study.options.input);
  set_fields(variants, study.options);
  run.radii_note = set_radii(variants, study.options.input.radii, run.through_template);
  unite_map_units(variants, study.options.temperature_K);
  return variants;
}

}  // namespace

MatrixReport run_matrix(const MatrixStudy& study, Engine& engine, const Progress& progress) {
  MatrixRun run = checked_run(study);
  const std::vector<Variant> variants = read_variants(study, engine.n_threads(), progress, run);
  if (study.template_text.empty()) return run_matrix(engine, variants, study.options, run, progress);
#ifdef ESPDIFF_HAVE_HDF5
  const TemplateRequest request{study.template_text, study.n_exact, ensemble_options(study.settings), study.structure};
  return run_template_matrix(engine, variants, study.options, request, run, progress);
#else
  throw InputError(option("template") + ": the potentials are kept in an HDF5 file, and this was built without HDF5");
#endif
}

bool are_template_parts([[maybe_unused]] const std::vector<std::string>& paths) {
#ifdef ESPDIFF_HAVE_HDF5
  return are_parts_of_template_matrix(paths);
#else
  return false;
#endif
}

MatrixReport merge_parts(const std::vector<std::string>& paths, const MatrixRun& run) {
#ifdef ESPDIFF_HAVE_HDF5
  if (are_template_parts(paths)) return merge_template_matrix(paths, run);
#endif
  return merge_matrix(paths, run);
}

}  // namespace espdiff
