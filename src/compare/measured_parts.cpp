// measured_parts.cpp: finds the region and the patches on the mapping, and judges them.
#include "compare/measured_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "certificate/certificate.h"
#include "certificate/place_patch.h"
#include "engine/engine.h"

namespace espdiff {
namespace {

/// Counts the part's vertices, and those of them that lie outside a map.
void count_outside_maps(const SurfacePart& place, const CompareResult& whole, CompareResult& part) {
  const MappedSurface& s = whole.surface;
  std::vector<bool> in_part(s.positions.size(), false);
  for (std::size_t t = 0; t < place.outside.size(); ++t) {
    const bool counts = place.outside[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
    for (const std::uint32_t v : s.triangles[t]) in_part[v] = in_part[v] || counts;
  }
  std::size_t n = 0;
  for (std::size_t v = 0; v < in_part.size(); ++v) {
    if (!in_part[v]) continue;
    ++n;
    if (!whole.has_potential || whole.n_outside_source_map + whole.n_outside_target_map == 0) continue;
    part.n_outside_source_map += std::isnan(s.potential_source[v]) ? 1 : 0;
    part.n_outside_target_map += std::isnan(s.potential_target[v]) ? 1 : 0;
  }
  const double n_outside = static_cast<double>(std::max(part.n_outside_source_map, part.n_outside_target_map));
  part.certificate.outside_maps = n > 0 ? n_outside / static_cast<double>(n) : 0;
}

}  // namespace

std::vector<MeasuredPart> measure_parts(Engine& engine, const CompareInput& source, const CompareInput& target,
                                        const Surface& target_surface, float isovalue,
                                        const std::vector<std::int32_t>& target_of, MappedStep& step) {
  std::vector<MeasuredPart> parts;
  CompareResult& result = step.result;
  const MappedSurface& s = result.surface;
  const auto measure = [&](const std::vector<std::uint8_t>& inside, const std::vector<std::uint8_t>& residues) {
    SurfacePart place = make_part(inside, residues, s, target_of, target.molecule->residues.size());
    auto part = part_result(engine, place, step.mapping, target_surface, isovalue, s.residue, s.target_residue,
                            target_of, result, *source.molecule, *target.molecule);
    parts.push_back({std::move(place), part, nullptr});
    return part;
  };
  const std::vector<std::uint8_t>& region = source.parts.region;
  if (!region.empty()) result.region = measure(vertices_of(s.residue, region), region);
  for (const SurfacePatch& patch : source.parts.patches) {
    if (patch.earlier == nullptr) {
      result.patches.push_back({patch.name, measure(vertices_of(s.residue, patch.residues), patch.residues)});
      continue;
    }
    const ResidueSurface on{s.source_positions, s.triangles, s.residue, source.molecule->residues};
    const PlacedPatch placed = place_patch(*patch.earlier, on, source.molecule->name);
    result.patches.push_back(
        {patch.name, measure(placed.inside, residues_in_patch(placed.inside, on)), placed.placement});
    parts.back().placement = placed.placement;
  }
  return parts;
}

void finish_part(const MeasuredPart& measured, const CompareResult& whole, const SurfaceAreas& areas,
                 const Molecule& source, double required_share) {
  const SurfacePart& place = measured.place;
  CompareResult& part = *measured.result;
  for (const Warning& warning : whole.warnings) {
    if (warning.refuses) part.warnings.push_back(warning);
  }
  for (const ResidueRow& row : whole.residues) {
    if (place.source[row.residue] != 0) part.residues.push_back(row);
  }
  count_outside_maps(place, whole, part);
  part.certificate.trusted = sum_trusted(whole.surface, areas, place.outside, part.certificate.unmatched_target);
  part.certificate.turned = turned_area(whole.surface, areas, place.outside, source);
  if (judge_missing_part(part, measured.placement.get())) return;
  part.certificate.untrusted_parts = untrusted_parts(whole.surface, areas, part.residues, source);
  judge(part, source, required_share);
  if (measured.placement != nullptr) judge_placement(part, *measured.placement);
}

}  // namespace espdiff
