// ensemble_settings.cpp: the table of an ensemble's own options.
#include "ensemble/ensemble_settings.h"

#include <cstdint>

namespace espdiff {
namespace {

using Rows = RowsOf<EnsembleStudy>;

std::string words_of(const Equilibration& how) {
  return how.kind == Equilibration::Kind::kNone        ? "none"
         : how.kind == Equilibration::Kind::kAutomatic ? "auto"
                                                       : std::to_string(how.n_frames);
}

std::vector<Rows::Row> group_rows() {
  const std::string group = "Groups";
  return {
      Rows::text(
          "map-unit", group, [](auto& o) -> auto& { return o.inputs.maps.unit; },
          "Unit of given maps if the files do not give it: kT/e, mV, V, kcal/mol/e, hartree/e"),
      Rows::text(
          "map-array", group, [](auto& o) -> auto& { return o.inputs.maps.array; },
          "Array of given VTI maps with several"),
      Rows::text(
          "frames", group, [](auto& o) -> auto& { return o.inputs.frames; },
          "Frames of each replicate that names none, from 0: all, begin:end or begin:step:end, as of a trajectory"),
      Rows::text(
          "template", group, [](auto& o) -> auto& { return o.inputs.template_text; },
          "The structure whose surface is mapped onto every frame. medoid: the frame nearest to all others (of at most "
          "200, evenly spread); medoid:GROUP: among the group's frames; a number: that frame, counted from 0 through "
          "all groups; a structure file"),
      Rows::text(
          "plugins", group, [](auto& o) -> auto& { return o.inputs.plugins; },
          "Folder of VMD's molfile plugins, which read trajectories and topologies (that of $VMDDIR, or of the `vmd` "
          "on "
          "PATH)")};
}

std::vector<Rows::Row> run_rows() {
  const std::string group = "Run";
  return {Rows::boolean(
              "resume", group, [](auto& o) -> auto& { return o.run.resume; },
              "Continue OUT.h5 of an interrupted run; a complete one gets new statistics"),
          Rows::boolean(
              "overwrite", group, [](auto& o) -> auto& { return o.run.overwrite; }, "Replace OUT.h5 if it exists"),
          Rows::choice_of<bool>(
              "on-error", group, {{"stop", false}, {"skip", true}}, [](auto& o) -> auto& { return o.run.skip_errors; },
              "A frame that cannot be mapped stops the run, or has no values"),
          Rows::parsed(
              "shard", group, [](EnsembleStudy& o, const std::string& text) { o.run.shard = parse_shard(text); },
              [](const EnsembleStudy& o) { return to_string(o.run.shard); },
              "Map part I of N of the frames, I/N, into OUT.shard-I-of-N.h5; `espdiff merge` merges the parts")};
}

std::vector<Rows::Row> answer_rows() {
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

std::vector<Rows::Row> statistics_rows() {
  const std::string group = "Statistics";
  return {
      Rows::number(
          "alpha", group, {1e-6, true, "a number from 1e-06 to 0.5", 0.5},
          [](auto& o) -> auto& { return o.statistics.alpha; },
          "Significance level; intervals have the confidence 1 - alpha"),
      Rows::choice_of<ErrorControl>(
          "control", group, {{"tfce", ErrorControl::kTfce}, {"max-t", ErrorControl::kMaxT}},
          [](auto& o) -> auto& { return o.statistics.control; }, "The family-wise p that patches are made of"),
      Rows::parsed(
          "equilibration", group,
          [](EnsembleStudy& o, const std::string& text) { o.statistics.equilibration = parse_equilibration(text); },
          [](const EnsembleStudy& o) { return words_of(o.statistics.equilibration); },
          "Frames to cut off at the start of each replicate: none, a number, or auto, which leaves the most effective "
          "samples of RMSD and mean potential"),
      Rows::number(
          "most-missing", group, {0, true, "a number from 0 to 0.9", 0.9},
          [](auto& o) -> auto& { return o.statistics.most_missing; },
          "A vertex that is unmatched or not trusted in a larger share of a group's frames is not tested"),
      Rows::count(
          "permutations", group, {20, true, "a whole number from 20 to 1000000", 1e6},
          [](auto& o) -> auto& { return o.statistics.test.max_permutations; },
          "Maximum number of permutations of labels; all are used if there are fewer"),
      Rows::count(
          "seed", group, kFromZero, [](auto& o) -> auto& { return o.statistics.test.seed; },
          "Random seed; written into the result")};
}

}  // namespace

const std::vector<OptionRow<EnsembleStudy>>& ensemble_settings() {
  static const std::vector<OptionRow<EnsembleStudy>> all = [] {
    std::vector<OptionRow<EnsembleStudy>> rows;
    for (auto made : {group_rows, run_rows, answer_rows, statistics_rows}) {
      for (auto& row : made()) rows.push_back(std::move(row));
    }
    return rows;
  }();
  return all;
}

}  // namespace espdiff
