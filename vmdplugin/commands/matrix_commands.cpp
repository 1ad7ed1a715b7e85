// matrix_commands.cpp: matrix compares all pairs of variants; merge joins the shards of a matrix.
#include "base/error.h"
#include "commands.h"
#include "engine/engine.h"
#include "options/input_settings.h"
#include "options/options.h"
#include "study/matrix_settings.h"
#include "vmdplugin/objects/ensemble_views.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

/// One element of VARIANTS: an endpoint with `label` and `group`.
MatrixStudy::Item parse_variant(Tcl_Obj* description, std::size_t number) {
  MatrixStudy::Item item;
  Tcl_Obj* const endpoint = Tcl_DuplicateObj(description);
  Tcl_IncrRefCount(endpoint);
  try {
    DictReader reader(endpoint, "variant " + std::to_string(number));
    item.label = to_string(reader.require("label"));
    item.group = reader.text("group");
    for (const char* key : {"label", "group"}) {
      Tcl_Obj* const name = to_obj(key);
      Tcl_IncrRefCount(name);
      Tcl_DictObjRemove(nullptr, endpoint, name);
      Tcl_DecrRefCount(name);
    }
    item.state = shared_endpoint(endpoint, item.label);
  } catch (...) {
    Tcl_DecrRefCount(endpoint);
    throw;
  }
  Tcl_DecrRefCount(endpoint);
  return item;
}

Tcl_Obj* matrix(const Call& call) {
  auto object = std::make_shared<MatrixObject>();
  MatrixStudy& study = object->study;
  DictReader reader(call.arguments[1], "options");
  study.run.output = to_string(reader.require("output"));
  reader.take(matrix_settings(), study);
  object->computation = parse_computation(reader, nullptr);
  study.options = object->computation.options;
  study.settings = reader.rest();
  study.each_by_itself = true;
  if (!study.run.cluster_by.empty())  // reports a wrong one at once
    find_metric(study.run.cluster_by, parts_and_fields(study.options));
  std::vector<std::string> labels;
  for (Tcl_Obj* const variant : to_vector(call.arguments[0], "variants")) {
    study.variants.push_back(parse_variant(variant, labels.size() + 1));
    labels.push_back(study.variants.back().label);
  }
  check_labels(labels);
  object->job = Worker::instance().submit([keep = std::weak_ptr<MatrixObject>(object)](const Progress& progress) {
    if (const auto alive = keep.lock())
      alive->report = run_matrix(alive->study, *engine_for(alive->computation), progress);
  });
  return to_obj(call.handles.add(object));
}

Tcl_Obj* merge(const Call& call) {
  std::vector<std::string> paths;
  for (Tcl_Obj* const path : to_vector(call.arguments[0], "state files")) paths.push_back(to_string(path));
  DictReader reader(call.arguments[1], "options");
  MatrixStudy study;
  MatrixRun& run = study.run;
  run.output = to_string(reader.require("output"));
  reader.take(merge_settings(), study);
  reader.finish();
  if (const auto path = merged_ensemble(paths, run.output, run.overwrite)) return to_list({*path});
  return to_list(merge_parts(paths, run).files);
}

}  // namespace

std::vector<Command> matrix_commands() {
  return {{"matrix", 2, 2, "variants options", matrix}, {"merge", 2, 2, "states options", merge}};
}

}  // namespace espdiff::vmdplugin
