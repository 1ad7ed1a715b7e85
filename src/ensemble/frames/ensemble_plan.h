// ensemble_plan.h: everything that the columns of an ensemble depend on.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/molecule/structure_options.h"
#include "field/field_result.h"
#include "potential/potential_plan.h"

namespace espdiff {

struct MatrixPlan;

/// One simulation: the models of its files, in order; or where its frames are from, in words, instead of files.
struct EnsembleReplicate {
  std::string group, name;
  std::vector<std::string> files, sha256;
  std::size_t n_frames = 0;
  std::string topology{}, topology_sha256{};  ///< of the atoms of trajectories; empty for none
};

/// How the frames were read, so that they can be read again. Values depend on what the plan says of their content.
struct FrameSources {
  std::map<std::string, std::string> charges;  ///< group: file
  std::string template_text;                   ///< a frame of all, or a file
  std::string plugins;                         ///< folder of VMD's molfile plugins; empty: the usual one
  PotentialRequest potential;
  StructureOptions structure;
};

/// Everything that the values depend on; it identifies an ensemble file, and shards of one run.
struct EnsemblePlan {
  std::string version, device;
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the comparison, by name
  std::string potential, potential_unit;
  std::string template_name;                                 ///< in words
  std::string template_sha256;                               ///< of its atoms: names, positions, radii
  std::string template_backbone{};                           ///< its trace as text, for pages; no value depends on it
  std::vector<std::pair<std::string, std::string>> charges;  ///< group, and where its charges come from
  std::vector<EnsembleReplicate> replicates;                 ///< group by group
  std::vector<std::string> residues;                         ///< labels of the template's
  /// Of a matrix through a template, whose variants are the frames of one replicate; null otherwise.
  std::shared_ptr<const MatrixPlan> matrix{};
  std::optional<FrameSources> sources{};  ///< none where frames came from no file
  std::size_t n_exact = 0;  ///< pairs of the matrix that are compared by themselves too; no value depends on it
  /// The field whose values these are instead of potentials; its label and unit are `potential` and `potential_unit`.
  std::optional<FieldDescription> field{};
  std::size_t n_fields = 0;  ///< of the run, besides the potential; no value depends on it

  std::size_t n_frames() const;
  /// In order of their first replicates.
  std::vector<std::string> groups() const;
  std::vector<std::size_t> replicates_of(const std::string& group) const;
  /// The replicate of a frame of all, and its number there, both from 0.
  std::pair<std::size_t, std::size_t> place_of(std::size_t frame) const;
  /// "wild, replicate w1, frame 3"; of a matrix the variant's label
  std::string name_of(std::size_t frame) const;
};

std::string plan_text(const EnsemblePlan& plan);
/// @throws FormatError that names `path`
EnsemblePlan parse_ensemble_plan(const std::string& text, const std::string& path);

/// The first difference that changes values; empty if there is none. Paths are ignored, contents count.
std::string plan_difference(const EnsemblePlan& there, const EnsemblePlan& here);

/// Refuses what cannot be an ensemble: no group or more than two, a name twice, a file listed twice, one frame.
/// @throws InputError
void check_replicates(const std::vector<EnsembleReplicate>& replicates);

/// What the design can show, before anything is computed; empty where p < 0.05 can be reached by exchanging labels.
std::string design_warning(const EnsemblePlan& plan);

}  // namespace espdiff
