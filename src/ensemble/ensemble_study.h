// ensemble_study.h: the whole of an ensemble in one call: frames, mapping, statistics, files. Command line, Tcl and
// Python start here.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/message.h"
#include "base/progress.h"
#include "base/text/option_row.h"
#include "ensemble/ensemble_run.h"
#include "ensemble/frames/ensemble_inputs.h"
#include "ensemble/result/ensemble_result.h"
#include "options/options.h"

namespace espdiff {

/// What is asked for.
struct EnsembleStudy {
  EnsembleRequest inputs;
  CompareOptions options;  ///< ensemble_options(); its patches are of the template
  EnsembleRun run;
  EnsembleOptions statistics;
  std::string regress;                  ///< FILE.csv:COLUMN; see read_regression_column()
  bool check_template = false;          ///< also through the medoid of each group
  bool states = false;                  ///< also each frame with each other one
  std::string from;                     ///< a complete file: its statistics, without mapping, and those of the
                                        ///< files of fields beside it; replicates of `inputs` are then its members,
                                        ///< see relabel()
  std::vector<std::string> read_files;  ///< further files that no output may replace, such as a list
};

/// The options of an ensemble besides those of a comparison, once for the command line, Tcl and Python, in the order of
/// the manuals.
const std::vector<OptionRow<EnsembleStudy>>& ensemble_settings();

/// A field besides the potential: its file, and its statistics, which are those of an ensemble of its own.
struct FieldAnswer {
  std::string name;
  std::unique_ptr<EnsembleFile> file;
  std::unique_ptr<EnsembleResult> result;
};

/// The result. A shard has a report only.
struct EnsembleAnswer {
  std::vector<EnsembleReport> reports;  ///< of the run, and of each template that was checked
  std::string device;                   ///< in words; empty where nothing was mapped
  std::unique_ptr<EnsembleFile> file;
  std::unique_ptr<EnsembleResult> result;
  std::vector<FieldAnswer> fields;  ///< that could be tested
  std::vector<std::string> written;

  EnsembleAnswer();
  EnsembleAnswer(EnsembleAnswer&&) noexcept;
  EnsembleAnswer& operator=(EnsembleAnswer&&) noexcept;
  ~EnsembleAnswer();
};

/// The comparison's options from given settings. Atoms move by 0.7 A a step instead of 0.35 unless `max-step` is among
/// them: between NMR models of ubiquitin that changes potentials by 0.0015 kT/e on average, where frames differ by
/// 0.45, and saves a quarter of the time.
/// @throws as make_options()
CompareOptions ensemble_options(const std::vector<std::pair<std::string, std::string>>& given);

/// Maps what is missing in OUT.h5, computes the statistics, and writes the results. Everything that can be checked
/// before the first frame is mapped, is.
/// @param make_engine called when the inputs have been checked
/// @param warn        receives what the design cannot show, before the work
/// @throws as EnsembleInputs, run_ensemble(), analyse_ensemble(), write_ensemble(); InputError (parts of the study that
///         exclude each other)
EnsembleAnswer run_study(const EnsembleStudy& study, const std::function<std::unique_ptr<Engine>()>& make_engine,
                         const Progress& progress, const std::function<void(const Message&)>& warn);

}  // namespace espdiff
