// earlier_run.h: the frames of a complete ensemble file, read again from the files that its run named.
#pragma once

#include <memory>

#include "base/progress.h"
#include "ensemble/frames/ensemble_inputs.h"
#include "options/options.h"

namespace espdiff {

class EnsembleFile;

/// The inputs of the run that wrote a file, as far as the file's plan names them: paths from the current folder,
/// settings, potential and template. Whatever is read must be what the run read: every content is checked by its
/// SHA-256.
class EarlierRun {
 public:
  /// @param file    before relabel(); its frames keep their numbers here
  /// @param options whose causes and patches are asked for; all other settings are the run's
  /// @throws InputError (the file does not say where its frames are from; a file is not there, or has changed), and as
  ///         EnsembleInputs
  EarlierRun(const EnsembleFile& file, const CompareOptions& options, const Progress& progress);

  EnsembleInputs& inputs() { return *inputs_; }
  const CompareOptions& options() const { return options_; }
  const PotentialRequest& potential() const { return request_.potential; }

 private:
  EnsembleRequest request_;
  CompareOptions options_;
  std::unique_ptr<EnsembleInputs> inputs_;
};

}  // namespace espdiff
