// own_potentials.h: each residue's potential on its own surface, as a check of the differences by residue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "certificate/result.h"

namespace espdiff {

/// A residue's mean potential over its own surface, weighted by area.
struct OwnPotential {
  double mean = 0;  ///< NaN where it is not used
  double area_A2 = 0;
};

/// [residue] NaN if the surface is less than 5 A^2, or if a residue without a partner touches it there: where that one
/// is absent, the residue shows another part of itself, so that its potentials on the two surfaces are of different
/// places.
/// @param residue   [vertex] -1 for none  @param potential [vertex] NaN outside a map
/// @param partner_of [residue] -1 for none
std::vector<OwnPotential> own_potentials(const Mesh& surface, const std::vector<std::int32_t>& residue,
                                         const std::vector<float>& potential,
                                         const std::vector<std::int32_t>& partner_of);

/// Sets own_difference of each row: the potential of the paired residue on the target's surface minus that of the
/// residue on the source's; and own_area_A2, the harmonic mean of the two areas. No mapping is involved.
/// @param source, target from own_potentials()  @param target_of [source residue] from paired_residues()
void set_own_differences(std::vector<ResidueRow>& rows, const std::vector<OwnPotential>& source,
                         const std::vector<OwnPotential>& target, const std::vector<std::int32_t>& target_of);

/// Root mean square of the rows' own_difference, weighted by own_area_A2; NaN without any.
double rms_own_difference(const std::vector<ResidueRow>& rows);

/// Fewer have no correlation.
constexpr std::size_t kLeastComparedResidues = 5;

/// [residue] nonzero where the mapped difference is off the difference on the residue's own surfaces by more than five
/// standard deviations (from the median of all errors, which single residues do not move) and by more than 25 % of the
/// potentials: other places of the residue were compared, such as those of a side chain that turned over.
/// @param rows with own differences, of what is trusted so far  @param source from own_potentials()
std::vector<std::uint8_t> disagreeing_residues(const std::vector<ResidueRow>& rows,
                                               const std::vector<OwnPotential>& source);

/// Pearson's correlation of the rows' mean_signed_difference with own_difference over the residues with at least 5 A^2
/// of trusted surface that is a quarter of their own at least, and the size of their disagreement; NaN with fewer than
/// kLeastComparedResidues. The weights are own_area_A2: the variance of a mean falls with its area, so that these are
/// the inverse variances of the differences.
/// @param source from own_potentials()
ResidueCheck check_residues(const std::vector<ResidueRow>& rows, const std::vector<OwnPotential>& source);

/// The residues of that correlation, by their share of the disagreement, largest first.
std::vector<const ResidueRow*> most_disagreeing(const std::vector<ResidueRow>& rows);

}  // namespace espdiff
