// ensemble_inputs.h: the groups, replicates and frames that the command line names, and how a frame is loaded.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/structure_options.h"
#include "compare/input.h"
#include "compare/options.h"
#include "ensemble/ensemble_plan.h"
#include "potential/potential_plan.h"
#include "trajectory/frame_files.h"

namespace espdiff::cli {

/// What names an ensemble on the command line.
struct EnsembleInputArguments {
  std::vector<std::vector<std::string>> groups;  ///< NAME FILE...
  std::string list, frames = "all", template_text = "medoid";
  std::vector<std::string> charges;  ///< GROUP=FILE
  PotentialRequest potential;
  StructureOptions structure;
};

/// The frames of an ensemble. One file is in memory at a time, whatever the number of replicates.
class EnsembleInputs {
 public:
  /// Reads every file once, to count its frames, and the first frame of each group with its charges.
  /// @throws InputError as check_replicates(); for a group without charges; for lists and charges that do not fit
  EnsembleInputs(const EnsembleInputArguments& arguments, const CompareOptions& options, const Progress& progress);

  /// Of the groups and files, and then of the template. Device and residues are the run's.
  const EnsemblePlan& plan() const { return plan_; }
  /// Every file that is read.
  std::vector<std::string> files() const;
  /// Reads the template; searches for the medoid.
  /// @param text medoid, medoid:GROUP, a frame, or a file
  /// @throws InputError (no such frame or group), as find_medoid()
  void choose_template(const std::string& text, const Progress& progress);
  /// The superposition of the present template onto an earlier one. @throws as superpose()
  RigidTransform onto(const Molecule& earlier) const;
  CompareInput source() const;
  /// A frame of all; it lives until the next one is asked for.
  CompareInput frame(std::size_t number);

 private:
  /// What a group's frames have in common.
  struct Group {
    LoadedState reference;
    bool is_prepared = false;
  };

  void read_groups();
  void read_list();
  void count_frames();
  void read_references();
  LoadedState load(std::size_t frame);
  std::size_t medoid(const std::string& group, const Progress& progress);
  MapMaker maker_of(const LoadedState& state) const;

  const EnsembleInputArguments& a_;
  const CompareOptions& options_;
  const Progress& progress_;
  EnsemblePlan plan_;
  std::map<std::string, std::string> charge_files_;  // by group
  std::map<std::string, Group> groups_;
  std::vector<std::vector<int>> chosen_;  // [replicate] models, from 0
  std::optional<std::size_t> open_;       // the replicate whose files are open
  std::unique_ptr<FrameFiles> frames_;
  PotentialPlan potential_;
  LoadedState template_, frame_;
  MapMaker template_map_;
};

void add_ensemble_inputs(CLI::App& parser, EnsembleInputArguments& arguments);

}  // namespace espdiff::cli
