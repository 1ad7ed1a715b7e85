// potentials.h: a step's two potentials: against their molecules and each other, at corresponding vertices, and by
// residue against those on the residues' own surfaces.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "certificate/result.h"
#include "compare/stages/compared_side.h"
#include "compare/stages/mapped_step.h"
#include "compare/stages/measured_parts.h"
#include "input_checks/map_check.h"

namespace espdiff {

struct CompareOptions;

/// What the checks of potentials found.
struct PotentialFindings {
  std::vector<Warning> warnings;
  std::vector<std::string> not_checked;  ///< names of the checks that were not made
};

/// Given maps against the molecules, and the two potentials against each other.
/// @param references of the source's given map, for all steps: made when the first one asks for it
/// @param maps       with the recipes of computed ones; receives the checks of given ones
/// @throws InputError (a potential in vacuum against one in solvent, unless the options trust maps)
PotentialFindings check_potentials(const StatesToMap& states, const CommonFrame& frame, const CompareInput& source,
                                   const CompareInput& target, std::shared_ptr<const MapReferences>& references,
                                   ComparedMaps& maps, const Progress& progress);

/// Both potentials at one distance outside the surfaces.
struct PotentialSamples {
  std::vector<float> source, target;  ///< [vertex] NaN outside a map and inside a surface
  OffsetMetrics counted;              ///< without the metrics
};

/// Samples both potentials at each distance outside the surfaces.
/// @throws as sample_outside(), count_outside()
std::vector<PotentialSamples> sample_potentials(Engine& engine, const ComparedSide& source, const ComparedSide& target,
                                                const CompareOptions& options, const MappedStep& step);

/// The metrics of the difference at each distance: over the trusted area, over all area, and over the trusted area of
/// each part.
/// @param surface says where the area is trusted
/// @param parts receive their comparison
PotentialComparison compare_potentials(Engine& engine, const std::vector<PotentialSamples>& samples, PotentialUnit unit,
                                       const MappedStep& step, const MappedSurface& surface,
                                       std::vector<MeasuredPart>& parts);

/// How the mapped differences agree.
struct ResidueAgreement {
  std::vector<ResidueRow> rows;       ///< with own differences; of what is trusted now
  std::optional<ResidueCheck> check;  ///< empty where it cannot be judged
  bool is_not_checked = false;        ///< although there are potentials
  std::vector<Warning> warnings;
};

/// Each residue's difference from its potentials on its own surfaces, and how the mapped differences agree. Without
/// potentials or pairs the own differences are NaN.
/// @param unit      of both potentials
/// @param target_of [source residue] from paired_residues()
/// @param surface   with potentials; the triangles of residues that disagree are marked
/// @param rows      of that surface
ResidueAgreement check_residues_of(const StatesToMap& states, const ComparedSide& source, const ComparedSide& target,
                                   PotentialUnit unit, const MappedStep& step,
                                   const std::vector<std::int32_t>& target_of, MappedSurface& surface,
                                   std::vector<ResidueRow> rows);

}  // namespace espdiff
