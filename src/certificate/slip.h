// slip.h: the slip of a mapping over its area.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/molecule/rigid_domain.h"
#include "certificate/result.h"

namespace espdiff {

SurfaceAreas surface_areas(const MappedSurface& surface);

/// [vertex] a third of the area of each matched triangle at the vertex. @param areas from surface_areas()
std::vector<double> matched_areas(const MappedSurface& surface, const SurfaceAreas& areas);

/// The fraction of the area at vertices without a potential on either side.
/// @param areas from matched_areas()
double share_outside(const MappedSurface& surface, const std::vector<double>& areas);

/// @param areas from matched_areas()
SlipSummary summarize_slip(const MappedSurface& surface, const std::vector<double>& areas);

/// A mapping that slips by more is tried again by local motions: limits of the area beyond kLargeSlip_A. Easy pairs
/// (below 2 A RMSD) have at most 6 %; pairs whose differences by residue do not agree with the residues' own potentials
/// have 10 % and more. Local motions leave less slip: of ten such pairs of ubiquitin, those whose differences do not
/// agree have 5 % and more.
constexpr double kMostSlippedArea = 0.08, kMostSlippedAreaOfLocalMotions = 0.04;

/// Which limits of the slip a mapping exceeds, so that it is tried again (choose_motions.h): over the whole area, in a
/// chain or rigid domain, at a ligand. Each names where.
/// @param follows_local whether the mapping followed local motions, which have a limit of their own
std::vector<Message> slip_reasons(const std::optional<SlipSummary>& slip, const std::vector<ResidueRow>& rows,
                                  const std::vector<RigidDomain>& domains, bool follows_local, const Molecule& source);

/// The residues that slipped by more than kLargeSlip_A on average, farthest first: "ARG 247 of chain B (8.5 A)".
std::vector<std::string> slipped_residues(const std::vector<ResidueRow>& rows, const Molecule& source);

}  // namespace espdiff
