// earlier_run.cpp: names an earlier run's inputs again, and checks that they are the same.
#include "ensemble/file/earlier_run.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "ensemble/file/ensemble_file.h"
#include "options/settings.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrames = "frames";

void require_file(const std::string& path, const std::string& use, const std::string& of) {
  if (path.empty() || fs::exists(path)) return;
  throw InputError(option("causes") + " solves the frames of " + of + " again, and " + path + " (" + use +
                   ") is not there; start in the folder in which they were mapped, or put the file back");
}

EnsembleRequest request_of(const EnsemblePlan& plan, const std::string& path) {
  if (!plan.sources)
    throw InputError(option("causes") + " solves the frames again, and " + path +
                     " does not say which files they are from (it has those of a matrix, of VMD, or of an earlier "
                     "version); repeat the command that mapped them with " +
                     switched_on("resume") + " and " + option("causes"));
  const FrameSources& sources = *plan.sources;
  EnsembleRequest request;
  for (const EnsembleReplicate& r : plan.replicates) {
    const std::string use = "replicate " + r.name + " of " + r.group;
    for (const std::string& file : r.files) require_file(file, use, path);
    require_file(r.topology, "topology of " + use, path);
    ReplicateRequest asked;
    asked.group = r.group;
    asked.name = r.name;
    asked.files = r.files;
    asked.topology = r.topology;
    request.replicates.push_back(std::move(asked));
  }
  for (const auto& [group, file] : sources.charges) require_file(file, "charges of " + group, path);
  const bool is_number = sources.template_text.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) require_file(sources.template_text, "template", path);
  for (const auto& [name, text] : plan.settings) {
    if (name == kFrames) request.frames = text;
  }
  request.charges = sources.charges;
  request.template_text = sources.template_text;
  request.plugins = sources.plugins;
  request.potential = sources.potential;
  request.structure = sources.structure;
  return request;
}

/// The run's settings; those that were never given are empty.
CompareOptions options_of(const EnsemblePlan& plan, const CompareOptions& asked) {
  CompareOptions options;
  for (const auto& [name, text] : plan.settings) {
    if (name != kFrames && !text.empty()) find_setting(name).set(options, text);
  }
  options.causes = asked.causes;
  options.input.patches = asked.input.patches;
  return options;
}

}  // namespace

EarlierRun::EarlierRun(const EnsembleFile& file, const CompareOptions& options, const Progress& progress)
    : request_(request_of(file.plan(), file.path())), options_(options_of(file.plan(), options)) {
  inputs_ = std::make_unique<EnsembleInputs>(request_, options_, progress);
  inputs_->load_references();
  inputs_->choose_template(request_.template_text, false, progress);
  EnsemblePlan here = inputs_->plan();
  here.device = file.plan().device;  // contributions are the same on all
  const std::string difference = plan_difference(file.plan(), here);
  if (!difference.empty())
    throw InputError(option("causes") + " solves the frames of " + file.path() + " again, and they are others now: " +
                     difference + "; put back what was mapped, or map again without " + option("from"));
}

}  // namespace espdiff
