// ensemble_inputs.h: the groups, replicates and frames of an ensemble, and how a frame is loaded.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/text/option_row.h"
#include "ensemble/frames/ensemble_plan.h"
#include "ensemble/frames/given_maps.h"
#include "ensemble/frames/replicate_request.h"
#include "frames/frame_files.h"
#include "io/frames/molfile_plugins.h"
#include "mapping/input.h"
#include "options/options.h"
#include "potential/potential_plan.h"

namespace espdiff {

/// What names an ensemble.
struct EnsembleRequest {
  std::vector<ReplicateRequest> replicates;
  std::map<std::string, std::string> charges;  ///< group: PQR file of the same atoms
  std::string frames = "all";                  ///< of each replicate of files, as in a trajectory
  std::string template_text = "medoid";        ///< medoid, medoid:GROUP, a frame of all, or a file
  GivenMapRequest maps;                        ///< potentials of other programs, instead of computed ones
  std::string plugins;                         ///< folder of VMD's molfile plugins; empty: find_molfile_folder()
  PotentialRequest potential;
  StructureOptions structure;
};

/// The options of these, where `at` finds them in what is asked for; in the order of the manuals.
template <typename Study, typename At>
std::vector<OptionRow<Study>> input_rows(At at) {
  using Rows = RowsOf<Study>;
  const std::string group = "Groups";
  return {
      Rows::text(
          "map-unit", group, [at](auto& o) -> auto& { return at(o).maps.unit; },
          "Unit of given maps if the files do not give it: kT/e, mV, V, kcal/mol/e, kJ/mol/e, hartree/e"),
      Rows::text(
          "map-array", group, [at](auto& o) -> auto& { return at(o).maps.array; },
          "Array of given VTI maps with several"),
      Rows::text(
          "frames", group, [at](auto& o) -> auto& { return at(o).frames; },
          "Frames of each replicate that names none, from 0: all, begin:end or begin:step:end, as of a trajectory"),
      Rows::text(
          "template", group, [at](auto& o) -> auto& { return at(o).template_text; },
          "The structure whose surface is mapped onto every frame. medoid: the frame nearest to all others (of at most "
          "200, evenly spread); medoid:GROUP: among the group's frames; a number: that frame, counted from 0 through "
          "all groups; a structure file"),
      Rows::text(
          "plugins", group, [at](auto& o) -> auto& { return at(o).plugins; }, kMolfileFolderHelp)};
}

/// The frames of an ensemble. One file is in memory at a time, whatever the number of replicates.
class EnsembleInputs {
 public:
  /// Reads every file once, to count its frames.
  /// @throws InputError as check_replicates(), GivenMaps, TrajectoryOpener
  EnsembleInputs(const EnsembleRequest& request, const CompareOptions& options, const Progress& progress);
  ~EnsembleInputs();

  /// Loads the first frame of each group with its charges, which PDB2PQR may make. Once, before all that follows.
  /// @throws InputError (a group without charges), as load_for()
  void load_references();

  /// Of the groups and files, then of the references, and then of the template. Device and residues are the run's.
  const EnsemblePlan& plan() const { return plan_; }
  /// Every file that is read.
  std::vector<std::string> files() const;
  /// Reads the template; searches for the medoid.
  /// @param text as EnsembleRequest::template_text
  /// @param skip_errors frames that cannot be read are not the medoid
  /// @throws InputError (no such frame or group), as find_medoid()
  void choose_template(const std::string& text, bool skip_errors, const Progress& progress);
  /// The superposition of the present template onto an earlier one. @throws as superpose()
  RigidTransform onto(const Molecule& earlier) const;
  CompareInput source() const;
  /// A frame of all. One file is open at a time: frames are read fastest in their order.
  HeldInput frame(std::size_t number);

 private:
  void name_replicates();
  OpenStructure opener_of(const std::string& topology);
  void count_frames();
  void find_maps();
  LoadedState reference_of(const std::string& group, PotentialFacts& facts);
  LoadedState load(std::size_t frame);
  std::size_t medoid(const std::string& group, bool skip_errors, const Progress& progress);
  /// @param state stays where it is as long as the maker
  MapMaker maker_of(const LoadedState& state) const;

  const EnsembleRequest& request_;
  const CompareOptions& options_;
  const Progress& progress_;
  EnsemblePlan plan_;
  std::vector<ReplicateRequest> replicates_;                          // group by group
  std::map<std::string, LoadedState> references_;                     // by group: what its frames have in common
  std::vector<std::vector<int>> chosen_;                              // [replicate] models, from 0
  std::map<std::string, std::unique_ptr<TrajectoryOpener>> openers_;  // by topology
  std::optional<std::size_t> open_;                                   // the replicate whose files are open
  std::unique_ptr<FrameFiles> frames_;
  PotentialPlan potential_;  // nothing where maps are given
  GivenMaps maps_;
  LoadedState template_;
  MapMaker template_map_;
};

}  // namespace espdiff
