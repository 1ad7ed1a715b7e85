// composition_warnings.h: groups that one molecule has and the other has not.
#pragma once

#include <cstdint>
#include <vector>

#include "certificate/result.h"

namespace espdiff {

/// Groups that one molecule has and the other has not, or has replaced or charged otherwise, and residues that an
/// option left out; each with its charge, and with the area of the surface within 5 A where
/// there is a surface. None of them refuses.
/// @param region [source residue] nonzero in the region, to which distances are given; empty for none
/// @param surface, uncovered empty where there is none: no areas then
std::vector<Warning> composition_warnings(const Molecule& source, const Molecule& target,
                                          const std::vector<std::uint8_t>& region, const Alignment& alignment,
                                          const MappedSurface& surface, const UncoveredSurface& uncovered);

}  // namespace espdiff
