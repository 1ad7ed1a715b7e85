// slip.h: the slip of a mapping over its area.
#pragma once

#include <string>
#include <vector>

#include "compare/result.h"

namespace espdiff {

/// [vertex] a third of the area of each matched triangle at the vertex.
std::vector<double> matched_areas(const MappedSurface& surface);

/// The fraction of the area at vertices without a potential on either side.
/// @param areas from matched_areas()
double share_outside(const MappedSurface& surface, const std::vector<double>& areas);

/// @param areas from matched_areas()
SlipSummary summarize_slip(const MappedSurface& surface, const std::vector<double>& areas);

/// [triangle] nonzero where the mean slip of the corners exceeds kMediumSlip_A or is not known.
std::vector<float> slipped_triangles(const MappedSurface& surface);

/// Why the slip makes a result untrustworthy: over the whole area, in a chain or rigid domain, at a ligand. Each reason
/// names where.
std::vector<Message> slip_reasons(const CompareResult& result, const Molecule& source);

/// The residues that slipped by more than kLargeSlip_A on average, farthest first: "ARG 247 of chain B (8.5 A)".
std::vector<std::string> slipped_residues(const CompareResult& result, const Molecule& source);

}  // namespace espdiff
