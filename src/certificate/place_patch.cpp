// place_patch.cpp: superposes the surroundings of a patch, and takes the nearest vertices.
#include "certificate/place_patch.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "align/geometry/nearest_point.h"
#include "align/geometry/superpose.h"
#include "align/pair_residues.h"
#include "base/error.h"
#include "base/molecule/earlier_patch.h"

namespace espdiff {
namespace {

constexpr double kNear_A = 10, kPruned_A = 3;
constexpr std::size_t kFewest = 6, kLeast = 3;

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// [vertex] a third of its triangles' area.
std::vector<double> vertex_areas(const ResidueSurface& s) {
  std::vector<double> areas(s.positions.size(), 0);
  for (const Triangle& t : s.triangles) {
    const Vec3d &a = s.positions[t[0]], &b = s.positions[t[1]], &c = s.positions[t[2]];
    for (const std::uint32_t v : t) areas[v] += norm(cross(b - a, c - a)) / 6;
  }
  return areas;
}

/// A molecule of one atom a residue, at the centre of its surface; `has` says which residues have surface.
Molecule centres_of(const ResidueSurface& s, std::vector<bool>& has) {
  const std::vector<double> areas = vertex_areas(s);
  std::vector<double> weight(s.residues.size(), 0);
  Molecule centres;
  centres.residues = s.residues;
  centres.positions.assign(s.residues.size(), Vec3d{});
  Vec3d middle{};
  double all = 0;
  for (std::size_t v = 0; v < s.positions.size(); ++v) {
    if (s.residue[v] < 0) continue;
    const auto r = static_cast<std::size_t>(s.residue[v]);
    centres.positions[r] = centres.positions[r] + areas[v] * s.positions[v];
    weight[r] += areas[v];
    middle = middle + areas[v] * s.positions[v];
    all += areas[v];
  }
  has.clear();
  for (std::size_t r = 0; r < s.residues.size(); ++r) {
    has.push_back(weight[r] > 0);
    // A buried residue counts for the sequence only.
    centres.positions[r] = weight[r] > 0 ? (1 / weight[r]) * centres.positions[r] : (1 / all) * middle;
    Atom atom;
    atom.name = "CA";
    atom.element = "C";
    atom.residue = static_cast<std::int32_t>(r);
    centres.atoms.push_back(atom);
  }
  centres.radii.assign(centres.size(), 1.0F);
  return centres;
}

/// The pairs near the patch, the nearest first: those within kNear_A, and at least kFewest.
Pairs pairs_near(const EarlierPatch& patch, const Molecule& centres, const Pairs& pairs) {
  std::vector<Vec3d> of_patch;
  for (std::size_t v = 0; v < patch.positions.size(); ++v) {
    if (patch.inside[v] != 0) of_patch.push_back(patch.positions[v]);
  }
  const NearestPoint nearest(of_patch);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Vec3d& centre = centres.positions[pairs[k].first];
    order.emplace_back(norm(centre - of_patch[nearest(centre)]), k);
  }
  std::sort(order.begin(), order.end());
  Pairs near;
  for (const auto& [distance, k] : order) {
    if (distance <= kNear_A || near.size() < kFewest) near.push_back(pairs[k]);
  }
  return near;
}

/// Superposes, and drops the worst pair until all are within kPruned_A or half of them are left.
Superposition superpose_most(const Molecule& from, const Molecule& to, Pairs& pairs) {
  const std::size_t fewest = std::max(kLeast, (pairs.size() + 1) / 2);
  for (;;) {
    const Superposition result = superpose(from.positions, to.positions, pairs);
    const auto distance = [&](const auto& pair) {
      return norm(result.transform.apply(from.positions[pair.first]) - to.positions[pair.second]);
    };
    const auto worst = std::max_element(pairs.begin(), pairs.end(),
                                        [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (distance(*worst) <= kPruned_A || pairs.size() <= fewest) return result;
    pairs.erase(worst);
  }
}

[[noreturn]] void refuse(const EarlierPatch& patch, const std::string& surface_name, const std::string& why) {
  throw InputError(patch.path + ": patch " + std::to_string(patch.number) + " has no place on " + surface_name + ": " +
                   why);
}

}  // namespace

PlacedPatch place_patch(const EarlierPatch& patch, const ResidueSurface& surface, const std::string& surface_name) {
  const ResidueSurface own{patch.positions, patch.triangles, patch.residue, patch.residues};
  std::vector<bool> own_has, has;
  const Molecule own_centres = centres_of(own, own_has), centres = centres_of(surface, has);
  Pairs paired;
  for (const auto& pair : pair_residues(ResidueView(own_centres), ResidueView(centres), PairOthers::kByNumber).pairs) {
    if (own_has[pair.first] && has[pair.second]) paired.push_back(pair);
  }
  Pairs near = pairs_near(patch, own_centres, paired);
  const std::size_t n_near = near.size();
  if (n_near < kLeast)
    refuse(patch, surface_name,
           std::to_string(n_near) + " of its residues pair, and three are needed; compare the same molecule");
  Superposition fit;
  try {
    fit = superpose_most(own_centres, centres, near);
  } catch (const GeometryError&) {
    refuse(patch, surface_name, "the residues near it lie on a line");
  }
  std::vector<Vec3d> moved;
  for (const Vec3d& p : patch.positions) moved.push_back(fit.transform.apply(p));
  PlacedPatch placed;
  const NearestPoint on_template(moved), on_surface(surface.positions);
  for (const Vec3d& p : surface.positions) {
    const std::size_t v = on_template(p);
    placed.inside.push_back(patch.inside[v] != 0 && norm(moved[v] - p) <= kPatchReach_A ? 1 : 0);
  }
  double found = 0, all = 0;
  const std::vector<double> areas = vertex_areas(own);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    if (patch.inside[v] == 0) continue;
    all += areas[v];
    const std::size_t nearest = on_surface(moved[v]);
    if (placed.inside[nearest] != 0 && norm(surface.positions[nearest] - moved[v]) <= kPatchReach_A) found += areas[v];
  }
  placed.placement =
      std::make_shared<PatchPlacement>(PatchPlacement{patch.path, patch.sha256, patch.number, patch.area_A2,
                                                      near.size(), n_near - near.size(), fit.rmsd_A, found / all});
  return placed;
}

std::vector<std::uint8_t> residues_in_patch(const std::vector<std::uint8_t>& inside, const ResidueSurface& surface) {
  const std::vector<double> areas = vertex_areas(surface);
  std::vector<double> all(surface.residues.size(), 0), in(surface.residues.size(), 0);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (surface.residue[v] < 0) continue;
    const auto r = static_cast<std::size_t>(surface.residue[v]);
    all[r] += areas[v];
    if (inside[v] != 0) in[r] += areas[v];
  }
  std::vector<std::uint8_t> residues(all.size(), 0);
  for (std::size_t r = 0; r < all.size(); ++r) residues[r] = in[r] > 0 && in[r] >= 0.5 * all[r] ? 1 : 0;
  const auto most = std::max_element(in.begin(), in.end());
  if (most != in.end() && *most > 0 && std::find(residues.begin(), residues.end(), 1) == residues.end())
    residues[static_cast<std::size_t>(most - in.begin())] = 1;
  return residues;
}

}  // namespace espdiff
