// matrix_commands.cpp: matrix compares all pairs of variants; merge joins the shards of a matrix.
#include "base/error.h"
#include "commands.h"
#include "compare/input_settings.h"
#include "compare/options.h"
#include "engine/engine.h"
#include "ensemble_views.h"
#include "prepare/surface_radii.h"
#include "tcl_values.h"
#include "template_matrix.h"

namespace espdiff::vmdplugin {
namespace {

/// One element of VARIANTS: an endpoint with `label` and `group`.
void add_variant(Tcl_Obj* description, MatrixObject& object) {
  Tcl_Obj* const endpoint = Tcl_DuplicateObj(description);
  Tcl_IncrRefCount(endpoint);
  try {
    DictReader reader(endpoint, "variant " + std::to_string(object.labels.size() + 1));
    object.labels.push_back(to_string(reader.require("label")));
    object.groups.push_back(reader.text("group"));
    for (const char* key : {"label", "group"}) {
      Tcl_Obj* const name = to_obj(key);
      Tcl_IncrRefCount(name);
      Tcl_DictObjRemove(nullptr, endpoint, name);
      Tcl_DecrRefCount(name);
    }
    object.endpoints.push_back(parse_endpoint(endpoint, object.labels.back()));
  } catch (...) {
    Tcl_DecrRefCount(endpoint);
    throw;
  }
  Tcl_DecrRefCount(endpoint);
}

/// Reads the files and empties the endpoints; computes the requested potentials.
std::vector<Variant> load_variants(MatrixObject& object, const Progress& progress) {
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < object.endpoints.size(); ++i) {
    progress.report("read " + object.labels[i], static_cast<double>(i) / static_cast<double>(object.endpoints.size()));
    Endpoint& endpoint = object.endpoints[i];
    load(endpoint, object.computation.options, nullptr, progress);
    Variant variant;
    variant.label = object.labels[i];
    variant.group = object.groups[i];
    variant.inputs = std::move(endpoint.inputs);
    for (InputFile& input : variant.inputs) input.role = input.role == endpoint.role ? "structure" : "map";
    variant.fields = endpoint.fields;
    variant.molecule = std::move(*endpoint.molecule);
    variant.map = std::move(endpoint.map);
    if (endpoint.computed_map) variant.make_map = endpoint.computed_map->maker();
    variants.push_back(std::move(variant));
  }
  std::vector<const Molecule*> wholes;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const Molecule& whole = object.endpoints[i].state.whole;
    wholes.push_back(whole.size() > 0 ? &whole : &variants[i].molecule);
  }
  set_parts(variants, wholes, object.computation.options.input);
  set_fields(variants, object.computation.options);
  object.endpoints.clear();
  std::vector<Molecule*> molecules;
  molecules.reserve(variants.size());
  for (Variant& variant : variants) molecules.push_back(&variant.molecule);
  object.run.radii_note = set_surface_radii(molecules, object.computation.options.input.radii);
  unite_map_units(variants, object.computation.options.temperature_K);
  return variants;
}

MatrixRun parse_run(DictReader& reader) {
  MatrixRun run;
  run.output = to_string(reader.require("output"));
  run.shard = parse_shard(reader.text("shard", "1/1"));
  run.resume = reader.boolean("resume", false);
  run.overwrite = reader.boolean("overwrite", false);
  run.skip_errors = reader.text("on_error", "stop") == "skip";
  run.cluster_by = reader.text("cluster_by");
  return run;
}

Tcl_Obj* matrix(const Call& call) {
  auto object = std::make_shared<MatrixObject>();
  DictReader reader(call.arguments[1], "options");
  object->run = parse_run(reader);
  object->template_text = reader.text("template");
  const int n_exact = reader.integer("exact_sample", 6);
  if (n_exact < 0) throw InputError(option("exact-sample") + ": " + std::to_string(n_exact) + " is negative");
  object->n_exact = static_cast<std::size_t>(n_exact);
  object->computation = parse_computation(reader, nullptr);
  object->settings = reader.rest();
  if (!object->run.cluster_by.empty())  // reports a wrong one at once
    find_metric(object->run.cluster_by, parts_and_fields(object->computation.options));
  for (Tcl_Obj* const variant : to_vector(call.arguments[0], "variants")) add_variant(variant, *object);
  check_labels(object->labels);
  object->run.potential = "maps";
  for (const Endpoint& endpoint : object->endpoints) {
    if (endpoint.map_request)
      object->run.potential = potential_in_words(make_potential_options(
          endpoint.map_request->method, endpoint.map_request->given, object->computation.options.temperature_K));
  }
  object->job = Worker::instance().submit([keep = std::weak_ptr<MatrixObject>(object)](const Progress& progress) {
    const auto alive = keep.lock();
    if (alive == nullptr) return;
    const std::unique_ptr<Engine> engine = engine_for(alive->computation);
    const std::vector<Variant> variants = load_variants(*alive, progress);
    alive->report = alive->template_text.empty()
                        ? run_matrix(*engine, variants, alive->computation.options, alive->run, progress)
                        : matrix_by_template(*alive, *engine, variants, progress);
  });
  return to_obj(call.handles.add(object));
}

Tcl_Obj* merge(const Call& call) {
  std::vector<std::string> paths;
  for (Tcl_Obj* const path : to_vector(call.arguments[0], "state files")) paths.push_back(to_string(path));
  DictReader reader(call.arguments[1], "options");
  const MatrixRun run = parse_run(reader);
  reader.finish();
  if (const auto path = merged_ensemble(paths, run.output, run.overwrite)) return to_list({*path});
  return to_list(merged_matrix(paths, run).files);
}

}  // namespace

std::vector<Command> matrix_commands() {
  return {{"matrix", 2, 2, "variants options", matrix}, {"merge", 2, 2, "states options", merge}};
}

}  // namespace espdiff::vmdplugin
