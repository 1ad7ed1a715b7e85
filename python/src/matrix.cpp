// matrix.cpp: matrix(): every state with every other one, saved as it grows.
#include "matrix.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "engine/engine.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#include "ensemble/template_matrix.h"
#endif
#include "inputs.h"
#include "matrix/matrix_run.h"
#include "matrix/write_matrix.h"
#include "prepare/surface_radii.h"
#include "run.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

/// Each pair by itself, or all through a template.
MatrixReport compute_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                            const Settings& settings, const std::string& template_text, std::size_t n_exact,
                            const MatrixRun& order, const Progress& progress) {
  if (template_text.empty()) return run_matrix(engine, variants, options, order, progress);
#ifdef ESPDIFF_HAVE_HDF5
  const TemplateRequest request{template_text, n_exact, ensemble_options(settings)};
  return run_template_matrix(engine, variants, options, request, order, progress);
#else
  throw DeviceError(
      "a matrix through a template needs HDF5, which was not found when this was built "
      "(Debian: libhdf5-dev)");
#endif
}

/// @returns the content of OUT.json; empty for a shard
std::string compute(const std::vector<StatePtr>& states, const std::vector<std::string>& labels,
                    const std::vector<std::string>& groups, const Settings& settings, const std::string& potential,
                    const std::string& pme_cell, const std::string& device, int threads, const std::string& output,
                    bool resume, bool overwrite, bool skip_errors, const std::string& shard,
                    const std::string& template_text, std::size_t n_exact, const nb::object& progress) {
  if (labels.size() != states.size())
    throw InputError("labels: there are " + std::to_string(labels.size()) + " for " + std::to_string(states.size()) +
                     " states");
  if (!groups.empty() && groups.size() != states.size())
    throw InputError("groups: there are " + std::to_string(groups.size()) + " for " + std::to_string(states.size()) +
                     " states");
  const Computation computation(settings, potential, pme_cell, device, threads);
  MatrixRun order;
  order.output = output;
  order.resume = resume;
  order.overwrite = overwrite;
  order.skip_errors = skip_errors;
  if (!shard.empty()) order.shard = parse_shard(shard);
  std::string text;
  run(progress, [&](const Progress& told) {
    std::vector<const State*> given;
    std::vector<LoadedState> loaded;
    std::vector<const LoadedState*> all;
    loaded.reserve(states.size());
    for (const StatePtr& state : states) {
      given.push_back(state.get());
      const Molecule* const first = loaded.empty() ? nullptr : &loaded.front().molecule;
      loaded.push_back(load(*state, StateRole::kOnly, computation, first, told));
      if (computation.options.input.region_of.empty()) loaded.back().whole = {};  // regions refer to it
      all.push_back(&loaded.back());
    }
    const PotentialPlan plan = plan_potential(computation, given, all);
    order.potential = plan.computes() ? plan.in_words() : "maps";
    std::vector<Variant> variants(states.size());
    std::vector<Molecule*> molecules;
    for (std::size_t i = 0; i < states.size(); ++i) {
      Variant& variant = variants[i];
      variant.label = labels[i];
      if (!groups.empty()) variant.group = groups[i];
      note_inputs(*states[i], loaded[i], "structure", variant.inputs);
      const CompareInput side = side_of(*states[i], loaded[i], plan, "structure", variant.inputs);
      variant.make_map = side.make_map;
      variant.fields = side.fields;
      for (InputFile& input : variant.inputs) {
        if (input.role == "structure_map") input.role = "map";
      }
      variant.molecule = loaded[i].molecule;
      if (states[i]->map != nullptr) variant.map = *states[i]->map;
      molecules.push_back(&variant.molecule);
    }
    std::vector<const Molecule*> wholes;
    for (std::size_t i = 0; i < states.size(); ++i)
      wholes.push_back(loaded[i].whole.size() > 0 ? &loaded[i].whole : &variants[i].molecule);
    set_parts(variants, wholes, computation.options.input);
    set_fields(variants, computation.options);
    order.radii_note = set_surface_radii(molecules, computation.options.input.radii);
    check_labels(labels);
    unite_map_units(variants, computation.options.temperature_K);
    const std::unique_ptr<Engine> engine = computation.make_engine();
    const MatrixReport report =
        compute_matrix(*engine, variants, computation.options, settings, template_text, n_exact, order, told);
    if (report.matrix)
      text = matrix_json(*report.matrix, metric_to_cluster_by(order, *report.matrix))
                 .dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  });
  return text;
}

/// @returns the content of OUT.json
std::string merge_shards(const std::vector<std::string>& parts, const std::string& output, bool overwrite,
                         const nb::object& progress) {
  MatrixRun order;
  order.output = output;
  order.overwrite = overwrite;
  std::string text;
  run(progress, [&](const Progress&) {
#ifdef ESPDIFF_HAVE_HDF5
    const MatrixReport report =
        are_parts_of_template_matrix(parts) ? merge_template_matrix(parts, order) : merge_matrix(parts, order);
#else
    const MatrixReport report = merge_matrix(parts, order);
#endif
    text = matrix_json(*report.matrix, metric_to_cluster_by(order, *report.matrix))
               .dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  });
  return text;
}

}  // namespace

void add_matrix(nb::module_& module) {
  module.def(
      "is_template_matrix",
      []([[maybe_unused]] const std::vector<std::string>& parts) {
#ifdef ESPDIFF_HAVE_HDF5
        return are_parts_of_template_matrix(parts);
#else
        return false;
#endif
      },
      nb::arg("parts"));
  module.def("merge_matrix", &merge_shards, nb::arg("parts"), nb::arg("output"), nb::arg("overwrite"),
             nb::arg("progress").none());
  module.def("matrix", &compute, nb::arg("states"), nb::arg("labels"), nb::arg("groups"), nb::arg("settings"),
             nb::arg("potential"), nb::arg("pme_cell"), nb::arg("device"), nb::arg("threads"), nb::arg("output"),
             nb::arg("resume"), nb::arg("overwrite"), nb::arg("skip_errors"), nb::arg("shard"), nb::arg("template"),
             nb::arg("exact_sample"), nb::arg("progress").none());
}

}  // namespace espdiff::python
