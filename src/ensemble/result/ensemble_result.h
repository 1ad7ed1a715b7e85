// ensemble_result.h: what an ensemble says: means, differences, their errors, and where they are significant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/file/ensemble_columns.h"
#include "ensemble/result/ensemble_causes.h"
#include "ensemble/result/ensemble_options.h"
#include "ensemble/result/regression_column.h"
#include "ensemble/result/states.h"
#include "ensemble/result/template_check.h"
#include "statistics/drift.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/patches.h"
#include "statistics/surface/surface_test.h"

namespace espdiff {

class EnsembleFile;

/// A replicate in numbers.
struct ReplicateSummary {
  std::string group, name;
  std::size_t n_frames = 0, n_cut_off = 0, n_failed = 0, n_not_trustworthy = 0;
  double inefficiency = 0, effective = 0;  ///< medians over the tested vertices
  double error_ratio = 0;                  ///< of the standard errors by blocks and by inefficiency: median; near 1
  double mean_potential = 0, mean_rmsd_A = 0;
  double trusted_area_fraction = 0;  ///< of the template, mean over the frames
  Drift drift;                       ///< NaN with fewer than kBlocks frames
};

/// A group at each vertex.
struct GroupColumns {
  std::string name;
  std::size_t n_replicates = 0;
  std::vector<double> mean;       ///< [vertex] of the replicates' means
  std::vector<double> deviation;  ///< [vertex] standard deviation of frames within replicates
  std::vector<double> effective;  ///< [vertex] samples, over all replicates
  std::vector<double> trusted;    ///< [vertex] share of the frames that could be mapped that trust it
};

/// Mean absolute differences over the tested area that need no difference between the groups.
struct NoiseFloor {
  /// By group: of the means of first and second halves of the replicates; mean over pairs of replicates, NaN with one.
  std::vector<double> halves, replicates;
  double across = 0;  ///< mean over pairs of replicates of different groups, which compares with `replicates`
};

struct EnsembleResidue {
  std::string label;
  double area_A2 = 0, significant_area_A2 = 0;
  std::vector<double> means;  ///< [group]
  double adjusted_p = 0;      ///< for the false discovery rate
};

/// A patch, with each residue's share of its area, largest first.
struct EnsemblePatch {
  SignificantPatch patch;
  double smallest_p = 1;
  std::vector<std::pair<std::string, double>> residues;
};

struct EnsembleResult {
  EnsembleOptions options;
  MeshGraph graph;
  std::vector<ReplicateSummary> replicates;
  std::vector<GroupColumns> groups;
  std::vector<char> tested;  ///< [vertex]
  double area_A2 = 0, tested_area_A2 = 0, significant_area_A2 = 0;
  double tested_share() const { return tested_area_A2 / area_A2; }
  std::size_t n_together = 1;  ///< fields whose surfaces the family-wise p are over
  bool compares = false;       ///< two groups; otherwise what follows is empty
  SurfaceTest test;
  NoiseFloor noise;
  std::vector<EnsembleResidue> residues;  ///< of the template
  PlaceTests residue_tests;
  std::vector<EnsemblePatch> patches;
  PlaceTests patch_tests;
  std::vector<FixedPatch> fixed_patches;
  PlaceTests fixed_patch_tests;                  ///< p of each alone: a patch chosen beforehand needs no correction
  std::vector<TemplateCheck> template_checks;    ///< where they were asked for; see check_template()
  std::optional<StateTable> states;              ///< where they were asked for; see compare_states()
  std::optional<EnsembleRegression> regression;  ///< of the options' column
  std::vector<EnsembleCauses> causes;            ///< where they were asked for; see find_ensemble_causes()
  /// Why the replicates are not samples of states in equilibrium; empty where nothing speaks against it.
  std::vector<std::string> not_equilibrium;
  std::vector<std::string> warnings;
  std::string conclusion;  ///< see conclusion_of()

  /// Whether a family-wise p at the options' alpha can be reached; otherwise why not.
  bool has_p() const { return why_no_p().empty(); }
  std::string why_no_p() const;
  /// What is exchanged between the groups, replicates or blocks of frames: all, and those of the first group.
  std::size_t n_exchanged() const;
  std::size_t n_exchanged_first() const;
  /// [vertex] the family-wise p that the options ask for.
  const std::vector<double>& family_wise() const {
    return options.control == ErrorControl::kTfce ? test.p_tfce : test.p_max_t;
  }
};

/// Values of vertices as floats; NaN where a vertex was not tested.
std::vector<float> where_tested(const std::vector<double>& values, const std::vector<char>& tested);

/// A replicate drifts where its trend has at most this p, divided by the number of replicates, and at least this share
/// of the variance between its tenths: 1/9 is expected of a run that samples a state, 0.6 of diffusion that has no
/// state at all (1 - (1/15) / (1/6), the variances of Brownian motion about its trend and about its mean). The limit
/// between these two is a choice: it was one third until four of eight short Trp-cage runs exceeded that.
constexpr double kDriftLevel = 0.01, kDriftShare = 0.5;

/// Computes the statistics of a complete file. The same bits at any number of threads.
/// @throws InputError (frames are missing; values of a replicate that do not change; no vertex is left to test)
EnsembleResult analyse_ensemble(const EnsembleFile& file, const EnsembleOptions& options);

/// The statistics of a field, or why there are none.
struct FieldStatistics {
  std::optional<EnsembleResult> result;
  std::string why_not;
};

/// Computes the statistics of the fields of one run, each as analyse_ensemble() does, but for family-wise p: these are
/// over the surfaces of all fields together (control_together()). Blocks within runs are those of the field whose
/// frames tell least, so that all fields exchange the same ones.
std::vector<FieldStatistics> analyse_fields(const std::vector<const EnsembleFile*>& files,
                                            const EnsembleOptions& options);

}  // namespace espdiff
