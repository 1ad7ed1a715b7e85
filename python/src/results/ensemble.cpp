// ensemble.cpp: ensemble(): groups of simulations from files, or frames that Python has.
#include "ensemble.h"

#include "base/error.h"
#ifdef ESPDIFF_HAVE_HDF5
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "engine/engine.h"
#include "ensemble/ensemble_study.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble_result.h"
#include "frames/frame_range.h"
#include "matrix/matrix_run.h"
#include "python/src/boundary/held.h"
#include "python/src/boundary/run.h"
#include "python/src/states/inputs.h"
#endif

namespace espdiff::python {

namespace nb = nanobind;

#ifdef ESPDIFF_HAVE_HDF5
namespace {

std::string text_in(const nb::dict& dict, const char* key) { return nb::cast<std::string>(dict[key]); }

/// {group, name, origin, sha256, n_frames, read}: read(frame, everything) gives a State.
ReplicateRequest python_replicate(const nb::dict& given) {
  ReplicateRequest replicate;
  replicate.group = text_in(given, "group");
  replicate.name = text_in(given, "name");
  replicate.origin = text_in(given, "origin");
  replicate.sha256 = text_in(given, "sha256");
  replicate.n_frames = nb::cast<std::size_t>(given["n_frames"]);
  const auto read = std::make_shared<Held>(nb::object(given["read"]));
  replicate.read = [read](std::size_t frame, bool with_everything) {
    StatePtr state;
    {
      const nb::gil_scoped_acquire locked;
      state = nb::cast<StatePtr>(read->object(frame, with_everything));
    }
    return loaded_arrays(*state);
  };
  return replicate;
}

/// Groups in their order: (name, files), as on the command line, or (name, replicates of Python's).
std::vector<ReplicateRequest> replicates_of(const nb::list& groups) {
  std::vector<std::vector<std::string>> of_files;
  std::vector<ReplicateRequest> all;
  for (const nb::handle entry : groups) {
    const auto [name, members] = nb::cast<std::pair<std::string, nb::list>>(entry);
    std::vector<std::string> files{name};
    for (const nb::handle member : members) {
      if (nb::isinstance<nb::str>(member)) {
        files.push_back(nb::cast<std::string>(member));
      } else {
        all.push_back(python_replicate(nb::cast<nb::dict>(member)));
      }
    }
    if (members.size() + 1 == files.size()) of_files.push_back(files);
  }
  // Names of files depend on all of them.
  if (of_files.size() == groups.size()) return replicates_of_groups(of_files);
  for (const auto& group : of_files) {
    for (ReplicateRequest& replicate : replicates_of_groups({group})) all.push_back(std::move(replicate));
  }
  return all;
}

EnsembleStudy study_of(const nb::list& groups, const nb::dict& order) {
  EnsembleStudy study;
  if (order.contains("list")) {
    study.inputs.replicates = replicates_of_list(text_in(order, "list"), study.inputs.charges);
    study.read_files.push_back(text_in(order, "list"));
  } else if (groups.size() > 0) {
    study.inputs.replicates = replicates_of(groups);
  }
  for (const auto& [group, file] : nb::cast<nb::dict>(order["charges"]))
    study.inputs.charges[nb::cast<std::string>(group)] = nb::cast<std::string>(file);
  for (const auto& [group, pattern] : nb::cast<nb::dict>(order["maps"]))
    study.inputs.maps.of_group[nb::cast<std::string>(group)] = nb::cast<std::string>(pattern);
  study.run.output = text_in(order, "output");
  set_rows(ensemble_settings(), study, nb::cast<Settings>(order["options"]));
  return study;
}

/// @returns None for a shard
nb::object ensemble(const nb::list& groups, const nb::dict& order, const Settings& settings,
                    const nb::object& progress) {
  const Computation computation(settings);
  auto made = std::make_shared<PyEnsemble>();
  {
    EnsembleStudy study = study_of(groups, order);
    study.options = ensemble_options(computation.settings);
    study.inputs.potential = computation.potential;
    run(progress, [&](const Progress& told) {
      made->answer = run_study(
          study, [&] { return computation.make_engine(); }, told,
          [&](const Message& text) { made->warnings.push_back(text.plain()); });
    });
  }
  if (made->answer.result == nullptr) return nb::none();
  for (FieldAnswer& field : made->answer.fields) {
    auto own = std::make_shared<PyEnsemble>();
    own->answer.file = std::move(field.file);
    own->answer.result = std::move(field.result);
    made->fields.emplace_back(field.name, std::move(own));
  }
  return nb::cast(made);
}

/// @returns the number of frames in OUT.h5
std::size_t merge_parts(const std::vector<std::string>& parts, const std::string& output, bool overwrite,
                        const nb::object& progress) {
  EnsembleRun order;
  order.output = output;
  order.overwrite = overwrite;
  std::size_t n_frames = 0;
  run(progress, [&](const Progress&) { n_frames = merge_ensemble(parts, order).n_frames; });
  return n_frames;
}

}  // namespace

void add_ensemble(nb::module_& module) {
  add_ensemble_result(module);
  module.def("ensemble", &ensemble, nb::arg("groups"), nb::arg("order"), nb::arg("settings"),
             nb::arg("progress").none());
  module.def("merge_ensemble", &merge_parts, nb::arg("parts"), nb::arg("output"), nb::arg("overwrite"),
             nb::arg("progress").none());
  module.def(
      "parse_frames", [](const std::string& text, int n_frames) { return parse_frames(text, {n_frames}); },
      nb::arg("text"), nb::arg("n_frames"), "Numbers of the frames that a text names.");
}

#else

void add_ensemble(nb::module_& module) {
  const auto missing = [](const nb::args&, const nb::kwargs&) {
    throw DeviceError("ensembles need HDF5, which was not found when this was built (Debian: libhdf5-dev)");
  };
  for (const char* const name : {"ensemble", "merge_ensemble", "parse_frames"}) module.def(name, missing);
}

#endif

}  // namespace espdiff::python
