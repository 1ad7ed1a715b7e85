// measured_parts.cpp: finds the region and the patches on the mapping, and judges them.
#include "compare/stages/measured_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "certificate/certificate.h"
#include "certificate/place_patch.h"
#include "certificate/untrusted_parts.h"
#include "engine/engine.h"

namespace espdiff {
namespace {

/// Counts the part's vertices, and those of them that lie outside a map.
void count_outside_maps(const SurfacePart& place, const CompareResult& whole, PartResult& part) {
  const MappedSurface& s = whole.surface;
  const PotentialComparison& of_whole = whole.potential;
  PotentialComparison& of_part = part.potential;
  std::vector<bool> in_part(s.positions.size(), false);
  for (std::size_t t = 0; t < place.outside.size(); ++t) {
    const bool counts = place.outside[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
    for (const std::uint32_t v : s.triangles[t]) in_part[v] = in_part[v] || counts;
  }
  std::size_t n = 0;
  for (std::size_t v = 0; v < in_part.size(); ++v) {
    if (!in_part[v]) continue;
    ++n;
    if (!of_whole.compared || of_whole.n_outside_source_map + of_whole.n_outside_target_map == 0) continue;
    of_part.n_outside_source_map += std::isnan(s.potential_source[v]) ? 1 : 0;
    of_part.n_outside_target_map += std::isnan(s.potential_target[v]) ? 1 : 0;
  }
  const double n_outside = static_cast<double>(std::max(of_part.n_outside_source_map, of_part.n_outside_target_map));
  part.certificate.outside_maps = n > 0 ? n_outside / static_cast<double>(n) : 0;
}

}  // namespace

std::vector<MeasuredPart> measure_parts(const StatesToMap& states, const MappedStep& step, const SurfaceParts& asked,
                                        const std::vector<std::int32_t>& target_of) {
  std::vector<MeasuredPart> parts;
  const MappedSurface& s = step.surface;
  const WholeMapping whole{states.engine,    step.mapping,     states.target_surface, states.isovalue(), s,
                           step.certificate, states.alignment, states.source,         states.target,     target_of};
  const auto measure = [&](const std::string& name, const std::vector<std::uint8_t>& inside,
                           const std::vector<std::uint8_t>& residues) {
    SurfacePart place = make_part(inside, residues, s, target_of, states.target.residues.size());
    PartResult result = part_result(whole, place);
    result.name = name;
    parts.push_back({std::move(place), std::move(result)});
  };
  if (!asked.region.empty()) measure(kRegionPart, vertices_of(s.residue, asked.region), asked.region);
  for (const SurfacePatch& patch : asked.patches) {
    if (patch.earlier == nullptr) {
      measure(patch.name, vertices_of(s.residue, patch.residues), patch.residues);
      continue;
    }
    const ResidueSurface on{s.source_positions, s.triangles, s.residue, states.source.residues};
    const PlacedPatch placed = place_patch(*patch.earlier, on, states.source.name);
    measure(patch.name, placed.inside, residues_in_patch(placed.inside, on));
    parts.back().result.placement = placed.placement;
  }
  return parts;
}

void finish_part(MeasuredPart& measured, const CompareResult& whole, const SurfaceAreas& areas, const Molecule& source,
                 double required_share) {
  const SurfacePart& place = measured.place;
  PartResult& part = measured.result;
  part.n_steps = whole.n_steps;
  for (const ResidueRow& row : whole.residues) {
    if (place.source[row.residue] != 0) part.residues.push_back(row);
  }
  count_outside_maps(place, whole, part);
  part.certificate.trusted = sum_trusted(whole.surface, areas, place.outside, part.certificate.unmatched_target);
  part.certificate.turned = turned_area(whole.surface, areas, place.outside, source);
  if (judge_missing_part(part)) return;
  part.certificate.untrusted_parts = untrusted_parts(whole.surface, areas, part.residues, source);
  judge(part, whole.inputs.warnings, source, required_share);
  judge_placement(part);
}

}  // namespace espdiff
