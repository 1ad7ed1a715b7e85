// residue_check.h: a step's differences by residue against those of each residue's potentials on its own surfaces.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "certificate/result.h"
#include "compare/stages/compare_potentials.h"

namespace espdiff {

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
ResidueAgreement check_residues_of(const StatesToMap& states, const PotentialSide& source, const PotentialSide& target,
                                   PotentialUnit unit, const MappedStep& step,
                                   const std::vector<std::int32_t>& target_of, MappedSurface& surface,
                                   std::vector<ResidueRow> rows);

}  // namespace espdiff
