// region_result.cpp: the mapping's meshes cut to a part, measured like the whole.
#include "certificate/region_result.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "align/geometry/superpose.h"
#include "base/molecule/earlier_patch.h"
#include "base/molecule/surface_parts.h"
#include "base/not_a_number.h"
#include "base/text/short_numbers.h"
#include "certificate/certificate.h"
#include "certificate/place_patch.h"
#include "certificate/result.h"
#include "certificate/slip.h"
#include "engine/engine.h"
#include "mapping/build_surface.h"
#include "mapping/mapping.h"

namespace espdiff {
namespace {

/// [triangle] nonzero where fewer than two vertices are inside.
std::vector<float> outside_of(const std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& inside) {
  std::vector<float> outside;
  for (const Triangle& triangle : triangles) {
    const auto n = std::count_if(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return inside[v] != 0; });
    outside.push_back(n < 2 ? 1.0F : 0.0F);
  }
  return outside;
}

/// The RMSD of the part's paired atoms after the superposition; NaN without such atoms.
double rmsd_of(const SurfacePart& part, const CompareResult& whole, const Molecule& source, const Molecule& target) {
  double sum = 0;
  std::size_t n = 0;
  for (const auto& [s, t] : whole.pairing.pairs) {
    if (part.source[static_cast<std::size_t>(source.atoms[s].residue)] == 0) continue;
    const double d = norm(whole.source_to_target.apply(source.positions[s]) - target.positions[t]);
    sum += d * d;
    ++n;
  }
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : std::numeric_limits<double>::quiet_NaN();
}

/// What is left of a mesh; null where nothing is.
MeshPtr cut(Engine& engine, const MeshPtr& mesh, const std::vector<float>& excluded) {
  if (std::all_of(excluded.begin(), excluded.end(), [](float flag) { return flag != 0; })) return nullptr;
  return engine.without(mesh, engine.upload_scalars(excluded));
}

DistanceSummary nothing() { return {kNaN, kNaN, kNaN, kNaN, kNaN, nullptr}; }

/// What nothing was mapped for cannot be measured; zeros would flatter.
void set_nothing_mapped(Certificate& c) {
  c.corrupt_area_fraction = c.flipped_area_fraction = c.irregularity_A = kNaN;
  c.mapped_to_target = nothing();
  c.distortion = {kNaN, kNaN, kNaN, kNaN, kNaN, nullptr};
}

}  // namespace

const std::vector<std::string>& unchecked_in_parts() {
  static const std::vector<std::string> names = {"round_trip", "slip", "residues", "removed"};
  return names;
}

std::vector<std::uint8_t> vertices_of(const std::vector<std::int32_t>& vertex_residue,
                                      const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint8_t> inside;
  inside.reserve(vertex_residue.size());
  for (const std::int32_t r : vertex_residue)
    inside.push_back(r >= 0 && marked[static_cast<std::size_t>(r)] != 0 ? 1 : 0);
  return inside;
}

SurfacePart make_part(const std::vector<std::uint8_t>& inside, std::vector<std::uint8_t> source,
                      const MappedSurface& surface, const std::vector<std::int32_t>& target_of,
                      std::size_t n_target_residues) {
  SurfacePart part;
  part.outside = outside_of(surface.triangles, inside);
  part.target.assign(n_target_residues, 0);
  for (std::size_t r = 0; r < source.size(); ++r) {
    if (source[r] != 0 && target_of[r] >= 0) part.target[static_cast<std::size_t>(target_of[r])] = 1;
  }
  part.source = std::move(source);
  return part;
}

std::shared_ptr<CompareResult> part_result(Engine& engine, const SurfacePart& part, const Mapping& mapping,
                                           const Surface& target, float isovalue,
                                           const std::vector<std::int32_t>& source_residue,
                                           const std::vector<std::int32_t>& mapped_residue,
                                           const std::vector<std::int32_t>& target_of, const CompareResult& whole,
                                           const Molecule& source_molecule, const Molecule& target_molecule) {
  auto result = std::make_shared<CompareResult>();
  result->has_potential = whole.has_potential;
  result->unit = whole.unit;
  result->morph_report = whole.morph_report;
  result->deform_report = whole.deform_report;
  result->rmsd_A = rmsd_of(part, whole, source_molecule, target_molecule);
  Certificate& c = result->certificate;
  c.converged = whole.certificate.converged;
  c.not_checked = unchecked_in_parts();
  c.zero_by_construction = whole.certificate.zero_by_construction;
  std::vector<float> excluded = part.outside;
  for (std::size_t t = 0; t < mapping.unmatched.size(); ++t) excluded[t] = std::max(excluded[t], mapping.unmatched[t]);
  const MeshPtr source = cut(engine, mapping.source, part.outside), matched = cut(engine, mapping.mapped, excluded),
                matched_source = cut(engine, mapping.source, excluded);
  const Mesh target_shape = engine.download_shape(target.mesh);
  const MeshPtr target_part = cut(
      engine, target.mesh,
      outside_of(target_shape.triangles, vertices_of(engine.vertex_residues(target.mesh, target.atoms), part.target)));
  result->source_surface.area_A2 = source != nullptr ? engine.area(source) : 0;
  result->target_surface.area_A2 = target_part != nullptr ? engine.area(target_part) : 0;
  if (matched != nullptr) {
    const FitReport fit = engine.fit(matched, target.atoms, isovalue);
    c.corrupt_area_fraction = fit.corrupt_area_fraction;
    c.flipped_area_fraction = fit.flipped_area_fraction;
    c.irregularity_A = fit.irregularity_A;
    result->area_mapped_A2 = fit.area_A2;
    c.mapped_to_target = numbers_of(engine.distances(matched, target.mesh, kMatchLimit_A));
    c.distortion = engine.distortion(matched_source, matched, kAreaRatioLimit);
    c.self_intersecting_pairs = engine.self_intersections(matched).n_pairs;
    const double kept = engine.area(matched_source) / engine.area(source);
    c.unmatched_source = 1 - kept * (1 - c.mapped_to_target.area_fraction_beyond_limit);
  } else {
    set_nothing_mapped(c);
    c.unmatched_source = source != nullptr ? 1 : kNaN;
  }
  c.target_to_mapped = nothing();
  c.unmatched_target = target_part != nullptr ? 1 : kNaN;
  if (target_part != nullptr && matched != nullptr) {
    c.target_to_mapped = numbers_of(engine.distances(target_part, mapping.matched, kMatchLimit_A));
    c.unmatched_target = c.target_to_mapped.area_fraction_beyond_limit;
  }
  MappedSurface of_part;
  of_part.positions = whole.surface.positions;
  of_part.triangles = whole.surface.triangles;
  for (const float flag : excluded) of_part.unmatched.push_back(flag != 0 ? 1 : 0);
  c.same_residue_area_fraction =
      same_residue_share(of_part, surface_areas(of_part), source_residue, mapped_residue, target_of);
  return result;
}

bool judge_missing_part(CompareResult& part, const PatchPlacement* placement) {
  Certificate& c = part.certificate;
  const bool buried = !(part.source_surface.area_A2 > 0), unmatched = !(part.area_mapped_A2 > 0);
  if (buried && placement != nullptr) {
    c.reasons.emplace_back("no place of it was found on the source's surface");
  } else if (buried) {
    c.reasons.emplace_back("it has no surface: its residues are buried in the source");
  } else if (unmatched) {
    c.reasons.emplace_back("none of its surface has a counterpart on the target");
  }
  c.trustworthy = false;
  return buried || unmatched;
}

void judge_placement(CompareResult& part, const PatchPlacement& placement) {
  if (placement.found_area_fraction >= kLeastFoundArea) return;
  Certificate& c = part.certificate;
  c.reasons.push_back(percent(placement.found_area_fraction) +
                      " of the earlier patch's area has a place on the source (at least " + percent(kLeastFoundArea) +
                      ")");
  c.trustworthy = false;
}

const CompareResult* part_of(const CompareResult& result, const std::string& name) {
  if (name == kRegionPart) return result.region.get();
  for (const PatchResult& patch : result.patches) {
    if (patch.name == name) return patch.result.get();
  }
  return nullptr;
}

std::vector<std::string> part_names(const CompareResult& result) {
  std::vector<std::string> names;
  if (result.region != nullptr) names.emplace_back(kRegionPart);
  for (const PatchResult& patch : result.patches) names.push_back(patch.name);
  return names;
}

}  // namespace espdiff
