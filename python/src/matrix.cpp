// matrix.cpp: matrix(): every state with every other one, saved as it grows.
#include "matrix.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "engine/engine.h"
#include "inputs.h"
#include "matrix/matrix_run.h"
#include "matrix/write_matrix.h"
#include "run.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

/// @returns the content of OUT.json; empty for a shard
std::string compute(const std::vector<StatePtr>& states, const std::vector<std::string>& labels,
                    const std::vector<std::string>& groups, const Settings& settings, const std::string& potential,
                    const std::string& pme_cell, const std::string& device, int threads, const std::string& output,
                    bool resume, bool overwrite, bool skip_errors, const std::string& shard,
                    const nb::object& progress) {
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
    std::vector<const State*> all;
    for (const StatePtr& state : states) all.push_back(state.get());
    const MapPlan plan(computation, all);
    order.potential = plan.in_words();
    std::vector<Variant> variants;
    for (std::size_t i = 0; i < states.size(); ++i) {
      Variant variant;
      variant.label = labels[i];
      if (!groups.empty()) variant.group = groups[i];
      variant.molecule = states[i]->molecule;
      if (states[i]->map != nullptr) variant.map = *states[i]->map;
      variant.make_map = plan.input_of(*states[i], "structure", variant.inputs).make_map;
      for (InputFile& input : variant.inputs) {
        if (input.role == "structure_map") input.role = "map";
      }
      variants.push_back(std::move(variant));
    }
    check_labels(labels);
    unite_map_units(variants, computation.options.temperature_K);
    const std::unique_ptr<Engine> engine = computation.make_engine();
    const MatrixReport report = run_matrix(*engine, variants, computation.options, order, told);
    if (report.matrix)
      text = matrix_json(*report.matrix, metric_to_cluster_by(order, *report.matrix))
                 .dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  });
  return text;
}

}  // namespace

void add_matrix(nb::module_& module) {
  module.def("matrix", &compute, nb::arg("states"), nb::arg("labels"), nb::arg("groups"), nb::arg("settings"),
             nb::arg("potential"), nb::arg("pme_cell"), nb::arg("device"), nb::arg("threads"), nb::arg("output"),
             nb::arg("resume"), nb::arg("overwrite"), nb::arg("skip_errors"), nb::arg("shard"),
             nb::arg("progress").none());
}

}  // namespace espdiff::python
