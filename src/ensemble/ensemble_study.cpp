// ensemble_study.cpp: the order of an ensemble's parts.
#include "ensemble/ensemble_study.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "engine/engine.h"
#include "ensemble/file/earlier_run.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/relabel.h"
#include "ensemble/result/template_patches.h"
#include "ensemble/result/write_ensemble.h"
#include "field/field_kinds.h"
#include "io/files/check_outputs.h"
#include "options/settings.h"
#include "prepare/input_files.h"

namespace espdiff {
namespace {

/// The options of the study itself.
std::vector<OptionRow<EnsembleStudy>> answer_rows() {
  using Rows = RowsOf<EnsembleStudy>;
  const std::string group = "Statistics";
  return {
      Rows::file(
          "from", group, [](auto& o) -> auto& { return o.from; },
          "Compute the statistics of this complete OUT.h5 again; maps nothing, unless causes are asked for. Groups are "
          "then of its replicates: a name and members, each NAME, GROUP/NAME, or with some of its frames, w1@0:49"),
      Rows::boolean(
          "check-template", group, [](auto& o) -> auto& { return o.check_template; },
          "Map the medoid of each group onto every frame as well, and tell how much of the answer stays. Takes as long "
          "again for each group; files OUT.template-GROUP.h5"),
      Rows::text(
          "regress", group, [](auto& o) -> auto& { return o.regress; },
          "FILE.csv:COLUMN: a value of each replicate, such as an activity, regressed on the surface, with the same "
          "control of errors, and predicted from the other replicates (OUT.regression.csv). The table has the columns "
          "replicate and COLUMN, and group unless names are unique"),
      Rows::boolean(
          "states", group, [](auto& o) -> auto& { return o.states; },
          "Compare every frame with every other one through the template (OUT.states.csv), and find the principal "
          "components of the potential: scores in OUT.components.csv, modes as component_1 to 3 in OUT.vtp")};
}

/// The file of FILE.csv:COLUMN.
std::string file_of_column(const std::string& text) { return text.substr(0, text.rfind(':')); }

std::vector<std::string> inputs_of(const EnsembleStudy& study, std::vector<std::string> files) {
  files.insert(files.end(), study.read_files.begin(), study.read_files.end());
  const std::vector<std::string> of_settings = input_files(study.options.input);
  files.insert(files.end(), of_settings.begin(), of_settings.end());
  files.push_back(file_of_column(study.regress));
  for (const FieldRequest& field : study.options.fields) {
    for (const std::string& path : files_of(field)) files.push_back(path);
  }
  return files;
}

/// Results of one group are fewer.
std::vector<std::string> outputs_of(const EnsembleStudy& study) {
  std::vector<std::string> all =
      ensemble_outputs(study.run.output, {true, !study.regress.empty(), study.states, !study.options.causes.empty()});
  for (const FieldRequest& field : study.options.fields) {
    const std::string prefix = field_prefix(study.run.output, field.name);
    const std::vector<std::string> of_field =
        ensemble_outputs(prefix, {true, !study.regress.empty(), study.states, false});
    all.insert(all.end(), of_field.begin(), of_field.end());
    all.push_back(ensemble_path(prefix, study.run.shard));
  }
  return all;
}

std::string output_of_check(const EnsembleStudy& study, const std::string& group) {
  return study.run.output + ".template-" + group;
}

bool is_nonlinear(const PotentialRequest& potential) {
  return std::any_of(potential.given.begin(), potential.given.end(),
                     [](const auto& setting) { return setting.second == "nonlinear"; });
}

/// The statistics of the fields, all together; one that has none does not take the others' away.
void test_fields(const EnsembleStudy& study, const std::vector<std::string>& paths, const EnsembleOptions& statistics,
                 EnsembleAnswer& answer) {
  std::vector<std::unique_ptr<EnsembleFile>> files;
  std::vector<const EnsembleFile*> all;
  for (const std::string& path : paths) {
    files.push_back(std::make_unique<EnsembleFile>(path, false));
    if (!study.from.empty() && !study.inputs.replicates.empty()) relabel(*files.back(), study.inputs.replicates);
    all.push_back(files.back().get());
  }
  std::vector<FieldStatistics> found = analyse_fields(all, statistics);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::string& name = study.options.fields[k].name;
    if (found[k].result) {
      answer.fields.push_back(
          {name, std::move(files[k]), std::make_unique<EnsembleResult>(std::move(*found[k].result))});
    } else {
      answer.result->warnings.push_back("field " + name + " was not tested: " + found[k].why_not);
    }
  }
}

/// The files of fields beside that of a run. @throws InputError (it has no such field)
std::vector<std::string> field_files_beside(const std::string& path, const std::vector<FieldRequest>& fields) {
  std::vector<std::string> paths;
  const std::string prefix = path.substr(0, path.rfind(".h5"));
  for (const FieldRequest& field : fields) {
    paths.push_back(ensemble_path(field_prefix(prefix, field.name), {}));
    if (!std::filesystem::exists(paths.back()))
      throw InputError(paths.back() + ": no such file; " + option("from", path) + " with " +
                       option("field", field.name) +
                       " reads the field's values there, and only a run that maps makes it");
  }
  return paths;
}

/// A study while it runs.
class Study {
 public:
  Study(const EnsembleStudy& study, const Progress& progress)
      : study_(study), progress_(progress), inputs_(study.inputs, study.options, progress) {
    if (study.options.input.has_region())
      throw InputError(option("region") +
                       ": an ensemble tells residues and patches of the whole surface; leave it out");
    if (!study.regress.empty()) regression_ = read_regression_column(study.regress, inputs_.plan());
    std::vector<std::string> outputs = outputs_of(study);
    outputs.push_back(ensemble_path(study.run.output, study.run.shard));
    for (const std::string& group : inputs_.plan().groups()) {
      if (study.check_template) outputs.push_back(ensemble_path(output_of_check(study, group), {}));
    }
    check_outputs(inputs_of(study, inputs_.files()), outputs);
    inputs_.load_references();
    if (study.check_template && (inputs_.plan().groups().size() < 2 || study.run.shard.count > 1))
      throw InputError(option("check-template") + " compares the answers of two groups, in one process; leave it out");
  }

  std::string design() const { return design_warning(inputs_.plan()); }

  void run(Engine& engine, EnsembleAnswer& answer, const std::function<void(const Message&)>& warn) {
    answer.device = engine.description();
    EnsembleOptions statistics = study_.statistics;
    statistics.regression = regression_;
    inputs_.choose_template(study_.inputs.template_text, study_.run.skip_errors, progress_);
    check_ensemble_causes(study_.options, inputs_.source(), is_nonlinear(study_.inputs.potential));
    // A wrong selection is refused before the work. Patches are of the first template.
    statistics.fixed_patches = fixed_patches(study_.options, *inputs_.source().molecule);
    map(engine, study_.run, answer);
    if (study_.run.shard.count > 1) return;
    answer.file = std::make_unique<EnsembleFile>(answer.reports.back().path, false);
    progress_.report("statistics", 1.0);
    answer.result = std::make_unique<EnsembleResult>(analyse_ensemble(*answer.file, statistics));
    EnsembleResult& result = *answer.result;
    result.warnings.insert(result.warnings.end(), answer.reports.back().notes.begin(),
                           answer.reports.back().notes.end());
    test_fields(study_, answer.reports.back().field_paths, statistics, answer);
    if (!study_.options.causes.empty()) {
      result.causes = find_ensemble_causes(
          engine, inputs_.source(), study_.options, *answer.file, result,
          [this](std::size_t frame) { return inputs_.frame(frame); }, progress_, warn);
    }
    if (study_.check_template) check_templates(engine, answer);
  }

 private:
  void map(Engine& engine, const EnsembleRun& run, EnsembleAnswer& answer, bool with_fields = true) {
    EnsemblePlan plan = inputs_.plan();
    plan.device = engine.back_end();
    CompareOptions options = study_.options;
    if (!with_fields) options.fields.clear();
    answer.reports.push_back(run_ensemble(
        engine, plan, inputs_.source(), options, run, [this](std::size_t frame) { return inputs_.frame(frame); },
        progress_));
  }

  void check_templates(Engine& engine, EnsembleAnswer& answer) {
    const Molecule first = *inputs_.source().molecule;
    for (const std::string& group : inputs_.plan().groups()) {
      EnsembleRun part = study_.run;
      part.output = output_of_check(study_, group);
      inputs_.choose_template("medoid:" + group, part.skip_errors, progress_);
      map(engine, part, answer, false);
      const EnsembleFile other(answer.reports.back().path, false);
      const EnsembleResult result = analyse_ensemble(other, study_.statistics);
      answer.result->template_checks.push_back(
          check_template(*answer.file, *answer.result, other, result, inputs_.onto(first)));
    }
  }

  const EnsembleStudy& study_;
  const Progress& progress_;
  EnsembleInputs inputs_;
  std::optional<RegressionColumn> regression_;
};

/// Statistics of a complete file; for causes its frames are read again, from their files.
void open_earlier(const EnsembleStudy& study, const std::function<std::unique_ptr<Engine>()>& make_engine,
                  const Progress& progress, const std::function<void(const Message&)>& warn, EnsembleAnswer& answer) {
  check_outputs(inputs_of(study, {study.from}), outputs_of(study));
  const std::vector<std::string> of_fields = field_files_beside(study.from, study.options.fields);
  answer.file = std::make_unique<EnsembleFile>(study.from, false);
  std::unique_ptr<EarlierRun> run;
  if (!study.options.causes.empty()) {
    run = std::make_unique<EarlierRun>(*answer.file, study.options, progress);
    check_outputs(run->inputs().files(), outputs_of(study));
    check_ensemble_causes(study.options, run->inputs().source(), is_nonlinear(run->potential()));
  }
  if (!study.inputs.replicates.empty()) relabel(*answer.file, study.inputs.replicates);
  EnsembleOptions statistics = study.statistics;
  statistics.fixed_patches = fixed_patches(study.options, residues_of_template(answer.file->plan()));
  if (!study.regress.empty()) statistics.regression = read_regression_column(study.regress, answer.file->plan());
  progress.report("statistics", 1.0);
  answer.result = std::make_unique<EnsembleResult>(analyse_ensemble(*answer.file, statistics));
  test_fields(study, of_fields, statistics, answer);
  if (!run) return;
  const std::unique_ptr<Engine> engine = make_engine();
  answer.device = engine->description();
  const EnsembleFile& file = *answer.file;
  answer.result->causes = find_ensemble_causes(
      *engine, run->inputs().source(), run->options(), file, *answer.result,
      [&](std::size_t frame) { return run->inputs().frame(file.place_in_run(frame)); }, progress, warn);
}

}  // namespace

const std::vector<OptionRow<EnsembleStudy>>& ensemble_settings() {
  static const std::vector<OptionRow<EnsembleStudy>> all = [] {
    std::vector<OptionRow<EnsembleStudy>> rows;
    for (const auto& made : {input_rows<EnsembleStudy>([](auto& o) -> auto& { return o.inputs; }),
                             run_rows<EnsembleStudy>([](auto& o) -> auto& { return o.run; }), answer_rows(),
                             statistics_rows<EnsembleStudy>([](auto& o) -> auto& { return o.statistics; })})
      rows.insert(rows.end(), made.begin(), made.end());
    return rows;
  }();
  return all;
}

EnsembleAnswer::EnsembleAnswer() = default;
EnsembleAnswer::EnsembleAnswer(EnsembleAnswer&&) noexcept = default;
EnsembleAnswer& EnsembleAnswer::operator=(EnsembleAnswer&&) noexcept = default;
EnsembleAnswer::~EnsembleAnswer() = default;

CompareOptions ensemble_options(const std::vector<std::pair<std::string, std::string>>& given) {
  CompareOptions options = make_options(given);
  const bool has_step =
      std::any_of(given.begin(), given.end(), [](const auto& setting) { return setting.first == "max-step"; });
  if (!has_step) options.morph.max_step_A = 0.7;
  return options;
}

EnsembleAnswer run_study(const EnsembleStudy& study, const std::function<std::unique_ptr<Engine>()>& make_engine,
                         const Progress& progress, const std::function<void(const Message&)>& warn) {
  EnsembleAnswer answer;
  if (!study.from.empty()) {
    open_earlier(study, make_engine, progress, warn, answer);
  } else {
    progress.report("read", 0.0);
    Study part(study, progress);
    const std::string warning = part.design();
    if (!warning.empty()) warn(warning);
    part.run(*make_engine(), answer, warn);
  }
  if (answer.result == nullptr) return answer;
  EnsembleResult& result = *answer.result;
  if (study.states) result.states = compare_states(*answer.file, result);
  answer.written = write_ensemble(study.run.output, *answer.file, result);
  for (FieldAnswer& field : answer.fields) {
    if (study.states) field.result->states = compare_states(*field.file, *field.result);
    const std::string prefix = field_prefix(study.run.output, field.name);
    const std::vector<std::string> paths = write_ensemble(prefix, *field.file, *field.result);
    answer.written.insert(answer.written.end(), paths.begin(), paths.end());
  }
  return answer;
}

}  // namespace espdiff
