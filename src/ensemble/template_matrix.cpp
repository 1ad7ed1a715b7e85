// template_matrix.cpp: the template, the mappings, the exact pairs, and merging.
#include "ensemble/template_matrix.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/molecule/backbone_trace.h"
#include "compare/stages/readings.h"
#include "engine/engine.h"
#include "ensemble/ensemble_run.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/frames/medoid.h"
#include "ensemble/frames/template_choice.h"
#include "ensemble/result/template_values.h"
#include "io/files/check_outputs.h"
#include "io/files/sha256.h"
#include "mapping/map_recipe.h"
#include "matrix/matrix_state.h"
#include "options/cause_settings.h"
#include "options/settings.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAll = "variants";  // names group and replicate in the ensemble file

/// A variant, or a molecule of its own.
struct Template {
  const Variant* variant = nullptr;
  LoadedState own;
  std::string name;

  const Molecule& molecule() const { return variant != nullptr ? variant->molecule : own.molecule; }
  /// Where the equation's solution for each state starts.
  MapMaker start() const {
    if (variant == nullptr) return nullptr;
    const bool is_pb = std::any_of(variant->inputs.begin(), variant->inputs.end(), [](const InputFile& input) {
      return input.computed && input.computed->method == PotentialMethod::kPoissonBoltzmann;
    });
    return is_pb ? variant->make_map : nullptr;
  }
};

Template choose_template(const std::vector<Variant>& variants, const TemplateRequest& request,
                         const Progress& progress) {
  Template chosen;
  if (request.text == "medoid") {
    chosen.variant = &variants[find_medoid(
        variants.size(), [&](std::size_t i) { return variants[i].molecule; }, progress)];
    chosen.name = "medoid: " + chosen.variant->label;
    return chosen;
  }
  const auto labelled = std::find_if(variants.begin(), variants.end(),
                                     [&](const Variant& variant) { return variant.label == request.text; });
  if (labelled != variants.end()) {
    chosen.variant = &*labelled;
  } else if (is_number(request.text) && std::stoul(request.text) < variants.size()) {
    chosen.variant = &variants[std::stoul(request.text)];
  } else if (!fs::exists(request.text)) {
    throw InputError(option("template", request.text) + " is neither medoid, nor the label of a variant, nor its " +
                     "number from 0 to " + std::to_string(variants.size() - 1) + ", nor a structure file");
  } else {
    chosen.own = read_template(request.text, request.structure, request.options.input, progress);
    set_surface_radii({&chosen.own.molecule}, request.options.input.radii);
  }
  chosen.name = chosen.variant != nullptr ? chosen.variant->label : request.text;
  return chosen;
}

void check_request(const std::vector<Variant>& variants, const CompareOptions& options, const MatrixRun& run) {
  if (variants.size() > kMostTemplateStates)
    throw InputError("a matrix of " + std::to_string(variants.size()) + " states through a template was asked for; " +
                     "the limit is " + std::to_string(kMostTemplateStates));
  if (options.input.has_region())
    throw InputError(option("region") +
                     ": a region is of each pair's source, and a template has one surface for all; " +
                     "name its residues by " + option("patch"));
  const auto without =
      std::find_if(variants.begin(), variants.end(), [](const Variant& variant) { return !variant.has_potential(); });
  if (without != variants.end())
    throw InputError(option("template") + ": a template gives differences of potentials, and " + without->label +
                     " has none; give charges or maps, or leave the option out to compare shapes");
  if (run.cluster_by.empty()) return;
  const PartsAndFields compared = parts_and_fields(options);
  const Metric& metric = matrix_metrics(compared)[find_metric(run.cluster_by, compared)];
  if (!is_given_by_template(metric))
    throw InputError(option("cluster-by", run.cluster_by) +
                     ": a template does not give this metric, only differences of potentials");
}

/// All variants as the frames of one replicate.
EnsemblePlan plan_of(const MatrixPlan& matrix, const Template& chosen, const TemplateRequest& request) {
  EnsemblePlan plan;
  plan.version = matrix.version;
  plan.device = matrix.device;
  for (auto& [name, text] : setting_texts(request.options)) {
    if (name != "patch" && name != "field")
      plan.settings.emplace_back(name, std::move(text));  // changes no value of the file
  }
  plan.potential = matrix.potential;
  plan.potential_unit = matrix.potential_unit;
  plan.template_name = chosen.name;
  plan.template_sha256 = sha256_of_template(chosen.molecule());
  plan.template_backbone = to_text(backbone_trace(chosen.molecule()));
  EnsembleReplicate all{kAll, kAll, {}, {}, matrix.variants.size()};
  for (const MatrixPlan::Item& variant : matrix.variants) {
    Sha256 sum;
    for (const InputFile& input : variant.inputs) sum.update(input.sha256.data(), input.sha256.size());
    all.files.push_back(variant.label);
    all.sha256.push_back(sum.finish());
  }
  plan.replicates = {std::move(all)};
  plan.matrix = std::make_shared<const MatrixPlan>(matrix);
  plan.n_exact = request.n_exact;
  return plan;
}

HeldInput frame_of(const Variant& variant) {
  return {{&variant.molecule, variant.map ? &*variant.map : nullptr, variant.make_map, {}, variant.fields}};
}

/// The shard's part of the sample, source by source.
std::vector<MatrixPair> exact_pairs(std::size_t n_variants, std::size_t n_exact, const Shard& shard) {
  const std::vector<MatrixPair> all = exact_sample(n_variants, n_exact);
  const auto count = static_cast<std::size_t>(shard.count), index = static_cast<std::size_t>(shard.index);
  std::vector<MatrixPair> part(all.begin() + static_cast<std::ptrdiff_t>((index - 1) * all.size() / count),
                               all.begin() + static_cast<std::ptrdiff_t>(index * all.size() / count));
  std::sort(part.begin(), part.end());
  return part;
}

std::vector<EnsembleFile> files_of_fields(const std::vector<std::string>& paths) {
  std::vector<EnsembleFile> files;
  for (const std::string& path : paths) files.emplace_back(path, false);
  return files;
}

/// Progress of a part of the work.
Progress part_of(const Progress& progress, double begin, double end) {
  return Progress([&progress, begin, end](const std::string& stage, double fraction) {
    progress.report(stage, begin + fraction * (end - begin));
  });
}

}  // namespace

MatrixReport run_template_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                                 const TemplateRequest& request, const MatrixRun& run, const Progress& progress) {
  refuse_causes(options, "a matrix");
  refuse_patches_of(options, "a matrix");
  check_request(variants, options, run);
  const std::string path = ensemble_path(run.output, run.shard), state = state_path(run.output, run.shard);
  MatrixRun files = run;
  files.through_template = true;
  if (fs::exists(request.text)) files.read_files.push_back(request.text);
  check_matrix_files(files, variants);
  check_existing(run, fs::exists(path), parts_and_fields(options));
  const MatrixPlan plan = make_plan(engine, variants, options, run.potential, run.radii_note);
  const Template chosen = choose_template(variants, request, progress);
  const std::vector<MatrixPair> sample = exact_pairs(variants.size(), request.n_exact, run.shard);
  const double share = 1 / (1 + static_cast<double>(sample.size()) / static_cast<double>(variants.size()));
  EnsembleRun mapping{run.output, run.shard, run.resume, run.overwrite, run.skip_errors};
  const EnsembleReport mapped = run_ensemble(
      engine, plan_of(plan, chosen, request), {&chosen.molecule(), nullptr, chosen.start(), {}}, request.options,
      mapping, [&](std::size_t i) { return frame_of(variants[i]); }, part_of(progress, 0, share));
  MatrixReport report;
  std::vector<MatrixCell> exact;
  if (!sample.empty())
    exact = compute_and_keep(engine, variants, options, run, plan, sample, part_of(progress, share, 1), report);
  report.template_work = {mapped.n_frames,  mapped.n_resumed, report.n_pairs,
                          report.n_resumed, mapped.seconds,   report.seconds};
  report.seconds += mapped.seconds;
  if (run.shard.count > 1) {
    report.files = {path};
    report.files.insert(report.files.end(), mapped.field_paths.begin(), mapped.field_paths.end());
    if (!sample.empty()) report.files.push_back(state);
    return report;
  }
  exact = sampled(plan, request.n_exact, exact);
  finish_matrix(
      run, matrix_through_template(EnsembleFile(path, false), files_of_fields(mapped.field_paths), std::move(exact)),
      report);
  report.n_pairs = report.matrix->cells.size();
  report.files.push_back(path);
  report.files.insert(report.files.end(), mapped.field_paths.begin(), mapped.field_paths.end());
  std::error_code ignored;
  fs::remove(state, ignored);
  return report;
}

bool are_parts_of_template_matrix(const std::vector<std::string>& paths) {
  const auto file = std::find_if(paths.begin(), paths.end(), is_hdf5_file);
  return file != paths.end() && EnsembleFile(*file, false).plan().matrix != nullptr;
}

MatrixReport merge_template_matrix(const std::vector<std::string>& paths, const MatrixRun& run) {
  std::vector<std::string> files, states;
  std::map<std::string, std::vector<std::string>> of_fields;
  for (const std::string& path : paths) {
    if (!is_hdf5_file(path)) {
      states.push_back(path);
    } else if (const auto field = EnsembleFile(path, false).plan().field) {
      of_fields[field->quantity.name].push_back(path);
    } else {
      files.push_back(path);
    }
  }
  if (files.empty())
    throw InputError(paths.front() +
                     ": this is a part of a field, and the parts of its matrix are missing; name all "
                     "files of all shards");
  check_outputs(paths, {run.output + ".csv", run.output + ".json", ensemble_path(run.output, {})});
  const EnsemblePlan plan = EnsembleFile(files.front(), false).plan();
  check_results(run, run.overwrite, plan.matrix->compared());
  for (const FieldDescription& field : plan.matrix->fields) {
    const std::string& name = field.quantity.name;
    if (of_fields.count(name) == 0)
      throw InputError("the parts of the field " + name + " are missing; name them too, as OUT." + name +
                       ".shard-1-of-2.h5");
  }
  std::vector<MatrixCell> exact;
  for (const std::string& path : states) {
    const MatrixStateContent part = read_matrix_state(path);
    const std::string difference = plan_difference(part.plan, *plan.matrix);
    if (!difference.empty())
      throw InputError(path + ": this is a part of another matrix than " + files.front() + ": " + difference);
    exact.insert(exact.end(), part.cells.begin(), part.cells.end());
  }
  exact = sampled(*plan.matrix, plan.n_exact, exact);
  const EnsembleReport merged = merge_ensemble(files, {run.output, {}, false, run.overwrite, false});
  std::vector<std::string> fields;
  for (const FieldDescription& field : plan.matrix->fields) {
    const std::string& name = field.quantity.name;
    fields.push_back(
        merge_ensemble(of_fields[name], {field_prefix(run.output, name), {}, false, run.overwrite, false}).path);
  }
  MatrixReport report;
  finish_matrix(run,
                matrix_through_template(EnsembleFile(merged.path, false), files_of_fields(fields), std::move(exact)),
                report);
  report.n_pairs = report.n_resumed = report.matrix->cells.size();
  report.files.push_back(merged.path);
  report.files.insert(report.files.end(), fields.begin(), fields.end());
  report.template_work = {merged.n_frames,
                          merged.n_frames,
                          report.matrix->through->exact.size(),
                          report.matrix->through->exact.size(),
                          0,
                          0};
  return report;
}

}  // namespace espdiff
