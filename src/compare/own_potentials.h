// own_potentials.h: each residue's potential on its own surface, as a check of the differences by residue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "compare/result.h"

namespace espdiff {

/// [residue] mean potential over the residue's surface, weighted by area; NaN if that is less than 5 A^2.
/// @param residue   [vertex] -1 for none  @param potential [vertex] NaN outside a map
std::vector<double> own_potentials(const Mesh& surface, const std::vector<std::int32_t>& residue,
                                   const std::vector<float>& potential, std::size_t n_residues);

/// Sets own_difference of each row: the potential of the paired residue on the target's surface minus that of the
/// residue on the source's. No mapping is involved.
/// @param source, target from own_potentials()  @param target_of [source residue] from paired_residues()
void set_own_differences(std::vector<ResidueRow>& rows, const std::vector<double>& source,
                         const std::vector<double>& target, const std::vector<std::int32_t>& target_of);

/// Pearson's correlation of the rows' mean_signed_difference with own_difference over the residues with at least 5 A^2
/// of compared surface, and the size of their disagreement; NaN with fewer than 5 residues.
/// @param source from own_potentials()
ResidueCheck check_residues(const std::vector<ResidueRow>& rows, const std::vector<double>& source);

}  // namespace espdiff
