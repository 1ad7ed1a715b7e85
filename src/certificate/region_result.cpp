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
double rmsd_of(const SurfacePart& part, const WholeMapping& whole) {
  double sum = 0;
  std::size_t n = 0;
  for (const auto& [s, t] : whole.alignment.pairing.pairs) {
    if (part.source[static_cast<std::size_t>(whole.source.atoms[s].residue)] == 0) continue;
    const double d =
        norm(whole.alignment.source_to_target.apply(whole.source.positions[s]) - whole.target.positions[t]);
    sum += d * d;
    ++n;
  }
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : std::numeric_limits<double>::quiet_NaN();
}

/// The target's surface of the residues that pair with the part's; null where there is none.
MeshPtr target_part(const SurfacePart& part, const WholeMapping& whole) {
  const Surface& target = whole.target_surface;
  const Mesh shape = whole.engine.download_shape(target.mesh);
  const std::vector<std::int32_t> residues = whole.engine.vertex_residues(target.mesh, target.atoms);
  return what_is_left(whole.engine, target.mesh, outside_of(shape.triangles, vertices_of(residues, part.target)));
}

/// Which of the mapped surface is on the same residue, of the part.
double same_residue_share_of(const SurfacePart& part, const WholeMapping& whole) {
  MappedSurface of_part;
  of_part.positions = whole.surface.positions;
  of_part.triangles = whole.surface.triangles;
  const std::vector<float>& unmatched = whole.mapping.unmatched;
  for (std::size_t t = 0; t < part.outside.size(); ++t)
    of_part.unmatched.push_back(part.outside[t] != 0 || (!unmatched.empty() && unmatched[t] != 0) ? 1 : 0);
  return same_residue_share(of_part, surface_areas(of_part), whole.surface.residue, whole.surface.target_residue,
                            whole.target_of);
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

PartResult part_result(const WholeMapping& whole, const SurfacePart& part) {
  Engine& engine = whole.engine;
  const Mapping of_part = part_of_mapping(engine, whole.mapping, part.outside, whole.target_surface.atoms,
                                          whole.target_surface.mesh, whole.isovalue);
  const MeshPtr target = target_part(part, whole);
  PartResult result;
  result.rmsd_A = rmsd_of(part, whole);
  result.source_surface.area_A2 = of_part.source != nullptr ? engine.area(of_part.source) : 0;
  result.target_surface.area_A2 = target != nullptr ? engine.area(target) : 0;
  result.area_mapped_A2 = of_part.fit.area_A2;
  Certificate& c = result.certificate = certify(engine, of_part, target, whole.mapping.matched);
  c.converged = whole.certificate.converged;
  c.not_checked = unchecked_in_parts();
  c.zero_by_construction = whole.certificate.zero_by_construction;
  c.same_residue_area_fraction = same_residue_share_of(part, whole);
  return result;
}

bool judge_missing_part(PartResult& part) {
  Certificate& c = part.certificate;
  const bool buried = !(part.source_surface.area_A2 > 0), unmatched = !(part.area_mapped_A2 > 0);
  if (buried && part.placement != nullptr) {
    c.reasons.emplace_back("no place of it was found on the source's surface");
  } else if (buried) {
    c.reasons.emplace_back("it has no surface: its residues are buried in the source");
  } else if (unmatched) {
    c.reasons.emplace_back("none of its surface has a counterpart on the target");
  }
  c.trustworthy = false;
  return buried || unmatched;
}

void judge_placement(PartResult& part) {
  if (part.placement == nullptr || part.placement->found_area_fraction >= kLeastFoundArea) return;
  Certificate& c = part.certificate;
  c.reasons.push_back(percent(part.placement->found_area_fraction) +
                      " of the earlier patch's area has a place on the source (at least " + percent(kLeastFoundArea) +
                      ")");
  c.trustworthy = false;
}

const PartResult* part_of(const std::vector<PartResult>& parts, const std::string& name) {
  const auto found =
      std::find_if(parts.begin(), parts.end(), [&](const PartResult& part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

std::vector<std::string> part_names(const std::vector<PartResult>& parts) {
  std::vector<std::string> names;
  for (const PartResult& part : parts) names.push_back(part.name);
  return names;
}

}  // namespace espdiff
