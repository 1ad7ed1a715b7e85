// matrix.cpp: matrix(): every state with every other one, saved as it grows.
#include "matrix.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "engine/engine.h"
#include "matrix/write_matrix.h"
#include "python/src/boundary/run.h"
#include "python/src/states/inputs.h"
#include "study/matrix_settings.h"
#include "study/matrix_study.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

/// The content of OUT.json; empty for a shard.
std::string text_of(const MatrixReport& report, const MatrixRun& run) {
  if (!report.matrix) return {};
  return matrix_json(*report.matrix, metric_to_cluster_by(run, *report.matrix))
      .dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// @returns the content of OUT.json; empty for a shard
std::string compute(const std::vector<StatePtr>& states, const std::vector<std::string>& labels,
                    const std::vector<std::string>& groups, const Settings& settings, const std::string& output,
                    const Settings& own, const nb::object& progress) {
  if (labels.size() != states.size())
    throw InputError("labels: there are " + std::to_string(labels.size()) + " for " + std::to_string(states.size()) +
                     " states");
  if (!groups.empty() && groups.size() != states.size())
    throw InputError("groups: there are " + std::to_string(groups.size()) + " for " + std::to_string(states.size()) +
                     " states");
  const Computation computation(settings);
  MatrixStudy study;
  for (std::size_t i = 0; i < states.size(); ++i)
    study.variants.push_back({states[i], labels[i], groups.empty() ? std::string() : groups[i]});
  study.options = computation.options;
  study.settings = computation.settings;
  study.potential = computation.potential;
  study.refuses_shapes = true;
  study.run.output = output;
  set_rows(matrix_settings(), study, own);
  std::string text;
  run(progress,
      [&](const Progress& told) { text = text_of(run_matrix(study, *computation.make_engine(), told), study.run); });
  return text;
}

/// @returns the content of OUT.json
std::string merge_shards(const std::vector<std::string>& parts, const std::string& output, bool overwrite,
                         const nb::object& progress) {
  MatrixRun order;
  order.output = output;
  order.overwrite = overwrite;
  std::string text;
  run(progress, [&](const Progress&) { text = text_of(merge_parts(parts, order), order); });
  return text;
}

}  // namespace

void add_matrix(nb::module_& module) {
  module.def("is_template_matrix", &are_template_parts, nb::arg("parts"));
  module.def("merge_matrix", &merge_shards, nb::arg("parts"), nb::arg("output"), nb::arg("overwrite"),
             nb::arg("progress").none());
  module.def("matrix", &compute, nb::arg("states"), nb::arg("labels"), nb::arg("groups"), nb::arg("settings"),
             nb::arg("output"), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace espdiff::python
