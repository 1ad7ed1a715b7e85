// composition_warnings.cpp: what one molecule has and the other has not, and what was left out of both.
#include "input_checks/composition_warnings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "align/geometry/superpose.h"
#include "align/pair_residues.h"
#include "align/paired_residues.h"
#include "align/residue_charges.h"
#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

/// Salt lets a charge be felt for about 8 A, at the surface mostly within 5 A.
constexpr double kNear_A = 5;
/// A group replaces another one whose centre is this near, as pair_by_place() takes a group for the same.
constexpr double kReplaced_A = 4;
constexpr double kRechargedCharge = 0.3;
constexpr std::size_t kGroupsNamed = 4;

std::string signed_charge(double q) {
  // Sums of a file's charges err in the last digits.
  return std::isfinite(q) ? formatted("%+.3g e", std::round(1000 * q) / 1000 + 0.0) : "charge unknown";
}

/// Atoms of one residue, or of several of a chain, without counterpart.
struct UnpairedGroup {
  std::string label;  ///< "HEM 154 of chain A"
  std::vector<Vec3d> positions;
  std::size_t n_atoms = 0;
  double charge = 0;
};

bool is_in_chain(ResidueKind kind) { return kind == ResidueKind::kAminoAcid || kind == ResidueKind::kNucleotide; }

/// One side: its residues, and which of its atoms and residues have counterparts.
struct ComposedSide {
  const char* role;
  const ResidueView& view;
  std::vector<bool> atom_is_paired, residue_is_paired;
  const MappedSurface& surface;
  const std::vector<Vec3d>& vertices;  ///< of the surface in this side's frame; empty where there is none
  const UncoveredSurface* uncovered;   ///< the target's

  double charge(std::size_t residue, const std::vector<std::size_t>& atoms) const {
    if (view.molecule->charges.empty()) {
      const std::string& name = view.molecule->residues[residue].name;
      const auto known =
          atoms.size() == view.atoms[residue].size() ? charge_of_group(name, atoms.size()) : std::nullopt;
      return known ? *known : std::numeric_limits<double>::quiet_NaN();
    }
    double sum = 0;
    for (const std::size_t i : atoms) sum += static_cast<double>(view.molecule->charges[i]);
    return sum;
  }
  UnpairedGroup group(std::size_t residue, const std::vector<std::size_t>& atoms) const {
    UnpairedGroup made{residue_label(view.molecule->residues[residue]), {}, atoms.size(), charge(residue, atoms)};
    for (const std::size_t i : atoms) made.positions.push_back(view.molecule->positions[i]);
    return made;
  }
  /// The residue's heavy atoms without counterpart.
  std::vector<std::size_t> unpaired_atoms(std::size_t residue) const {
    std::vector<std::size_t> atoms;
    for (const std::size_t i : view.atoms[residue]) {
      const Atom& atom = view.molecule->atoms[i];
      if (!atom_is_paired[i] && atom.element != "H" && atom.element != "D" && normalized_atom_name(atom.name) != "OXT")
        atoms.push_back(i);
    }
    return atoms;
  }
};

/// The area of the side's surface within kNear_A of any of the positions.
class NearbyArea {
 public:
  explicit NearbyArea(const std::vector<Vec3d>& positions) : positions_(positions) {
    for (const Vec3d& p : positions) {
      low_ = {std::min(low_.x, p.x - kNear_A), std::min(low_.y, p.y - kNear_A), std::min(low_.z, p.z - kNear_A)};
      high_ = {std::max(high_.x, p.x + kNear_A), std::max(high_.y, p.y + kNear_A), std::max(high_.z, p.z + kNear_A)};
    }
  }
  /// @param counts [triangle] empty for all
  /// @param wanted the value of `counts` where a triangle counts
  double of(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles,
            const std::vector<std::uint8_t>& counts, bool wanted) const {
    double area = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!counts.empty() && (counts[t] != 0) != wanted) continue;
      const Triangle& v = triangles[t];
      const Vec3d &a = vertices[v[0]], &b = vertices[v[1]], &c = vertices[v[2]];
      if (is_near((1.0 / 3) * (a + b + c))) area += triangle_area(vertices, v);
    }
    return area;
  }

 private:
  bool is_near(const Vec3d& p) const {
    if (!(p.x >= low_.x && p.y >= low_.y && p.z >= low_.z && p.x <= high_.x && p.y <= high_.y && p.z <= high_.z))
      return false;
    return std::any_of(positions_.begin(), positions_.end(), [&](const Vec3d& q) {
      const Vec3d d = p - q;
      return dot(d, d) <= kNear_A * kNear_A;
    });
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();
  const std::vector<Vec3d>& positions_;
  Vec3d low_{kFar, kFar, kFar}, high_{-kFar, -kFar, -kFar};
};

/// "43 atoms, -2 e, 320 A^2 of the surface near it"
std::string described(const UnpairedGroup& group, const ComposedSide& side) {
  std::string text = std::to_string(group.n_atoms) + (group.n_atoms == 1 ? " atom, " : " atoms, ");
  text += signed_charge(group.charge);
  if (side.vertices.empty()) return text;
  const NearbyArea area(group.positions);
  const MappedSurface& s = side.surface;
  // Where the mapping has lost the target, its vertices lie anywhere; the target's own surface is there instead.
  double near =
      area.of(side.vertices, s.triangles, side.uncovered == nullptr ? std::vector<std::uint8_t>() : s.unmatched, false);
  if (side.uncovered != nullptr)
    near += area.of(side.uncovered->positions, side.uncovered->triangles, side.uncovered->uncovered, true);
  return text + ", " + short_number(near) + " A^2 of the surface within " + angstrom(kNear_A);
}

/// The groups with most charge first, then the largest; at most some by name.
std::string listed(std::vector<UnpairedGroup>& groups, const ComposedSide& side) {
  std::stable_sort(groups.begin(), groups.end(), [](const UnpairedGroup& a, const UnpairedGroup& b) {
    const double of_a = std::isfinite(a.charge) ? std::fabs(a.charge) : 1,
                 of_b = std::isfinite(b.charge) ? std::fabs(b.charge) : 1;
    return std::pair(of_a, a.n_atoms) > std::pair(of_b, b.n_atoms);
  });
  std::string text;
  for (std::size_t k = 0; k < std::min(groups.size(), kGroupsNamed); ++k)
    text += (k == 0 ? "" : "; ") + groups[k].label + " (" + described(groups[k], side) + ")";
  return groups.size() > kGroupsNamed ? text + "; and " + std::to_string(groups.size() - kGroupsNamed) + " more" : text;
}

/// Residues of chains that pair with none, as one group for each stretch.
std::vector<UnpairedGroup> unpaired_stretches(const ComposedSide& side) {
  std::vector<UnpairedGroup> stretches;
  std::size_t first = 0, last = 0;
  const std::vector<Residue>& residues = side.view.molecule->residues;
  for (std::size_t r = 0; r < residues.size(); ++r) {
    if (!is_in_chain(side.view.kinds[r]) || side.residue_is_paired[r]) continue;
    UnpairedGroup own = side.group(r, side.view.atoms[r]);
    if (!stretches.empty() && last + 1 == r && residues[r].chain == residues[last].chain) {
      UnpairedGroup& stretch = stretches.back();
      stretch.label = residue_label(residues[first]) + " to " + residue_label(residues[r]);
      stretch.positions.insert(stretch.positions.end(), own.positions.begin(), own.positions.end());
      stretch.n_atoms += own.n_atoms;
      stretch.charge += own.charge;
    } else {
      first = r;
      stretches.push_back(std::move(own));
    }
    last = r;
  }
  return stretches;
}

Vec3d centre_of(const std::vector<Vec3d>& positions) {
  Vec3d sum{};
  for (const Vec3d& p : positions) sum += p;
  return (1 / static_cast<double>(positions.size())) * sum;
}

/// The groups beside the chains that pair with none.
std::vector<UnpairedGroup> unpaired_others(const ComposedSide& side, const std::vector<bool>& is_moved) {
  std::vector<UnpairedGroup> groups;
  for (std::size_t r = 0; r < side.view.kinds.size(); ++r) {
    if (side.view.kinds[r] != ResidueKind::kOther || side.residue_is_paired[r] || is_moved[r]) continue;
    if (!side.view.atoms[r].empty()) groups.push_back(side.group(r, side.view.atoms[r]));
  }
  return groups;
}

/// Groups that lie on the place of another one, as zinc and sodium; they are taken out of the lists.
void take_replaced(std::vector<UnpairedGroup>& of_source, std::vector<UnpairedGroup>& of_target,
                   const RigidTransform& to_target, const ComposedSide& side, std::vector<Warning>& warnings) {
  for (auto own = of_source.begin(); own != of_source.end();) {
    const Vec3d there = to_target.apply(centre_of(own->positions));
    const auto other = std::find_if(of_target.begin(), of_target.end(), [&](const UnpairedGroup& group) {
      return norm(centre_of(group.positions) - there) <= kReplaced_A;
    });
    if (other == of_target.end()) {
      ++own;
      continue;
    }
    warnings.push_back({own->label + " of the source (" + described(*own, side) + ") is replaced by " + other->label +
                            " in the target (" + std::to_string(other->n_atoms) +
                            (other->n_atoms == 1 ? " atom, " : " atoms, ") + signed_charge(other->charge) + ")",
                        false});
    of_target.erase(other);
    own = of_source.erase(own);
  }
}

/// Paired residues of one name that lack heavy atoms on the other side, such as a haem without its iron.
void check_missing_atoms(const ComposedSide& side, const ResidueView& other, const std::vector<std::int32_t>& partner,
                         std::vector<Warning>& warnings) {
  std::vector<UnpairedGroup> groups;
  const Molecule& molecule = *side.view.molecule;
  for (std::size_t r = 0; r < partner.size(); ++r) {
    if (partner[r] < 0 || side.view.kinds[r] == ResidueKind::kWater) continue;
    const std::string& name = molecule.residues[r].name;
    if (!same_residue_name(name, other.molecule->residues[static_cast<std::size_t>(partner[r])].name)) continue;
    const std::vector<std::size_t> atoms = side.unpaired_atoms(r);
    if (atoms.empty()) continue;
    UnpairedGroup group = side.group(r, atoms);
    std::string names;
    for (std::size_t k = 0; k < std::min<std::size_t>(atoms.size(), 3); ++k)
      names += (k == 0 ? "" : ", ") + molecule.atoms[atoms[k]].name;
    group.label = names + (atoms.size() > 3 ? ", ..." : "") + " of " + group.label;
    groups.push_back(std::move(group));
  }
  if (groups.empty()) return;
  const std::string count = std::to_string(groups.size()) + (groups.size() == 1 ? " residue" : " residues");
  warnings.push_back({count + " of the " + side.role + (groups.size() == 1 ? " has" : " have") +
                          " atoms that the partner lacks: " + listed(groups, side),
                      false});
}

void check_recharged(const ComposedSide& source, const ComposedSide& target, const std::vector<std::int32_t>& partner,
                     std::vector<Warning>& warnings) {
  if (source.view.molecule->charges.empty() || target.view.molecule->charges.empty()) return;
  for (std::size_t r = 0; r < partner.size(); ++r) {
    if (partner[r] < 0 || source.view.kinds[r] != ResidueKind::kOther) continue;
    const auto t = static_cast<std::size_t>(partner[r]);
    const UnpairedGroup own = source.group(r, source.view.atoms[r]);
    const double there = target.charge(t, target.view.atoms[t]);
    if (std::fabs(own.charge - there) < kRechargedCharge) continue;
    warnings.push_back({own.label + " is charged otherwise in the target: " + described(own, source) + "; there " +
                            signed_charge(there),
                        false});
  }
}

void check_unpaired(const ComposedSide& side, std::vector<UnpairedGroup> others, std::vector<Warning>& warnings) {
  const std::string other_role = side.uncovered == nullptr ? "target" : "source";
  if (!others.empty()) {
    const std::string count = std::to_string(others.size()) + (others.size() == 1 ? " group" : " groups");
    warnings.push_back({std::string("the ") + side.role + " has " + count + " that the " + other_role +
                            " has not: " + listed(others, side),
                        false});
  }
  std::vector<UnpairedGroup> stretches = unpaired_stretches(side);
  if (stretches.empty()) return;
  warnings.push_back({std::string("parts of the ") + side.role + "'s chains have no counterpart in the " + other_role +
                          ": " + listed(stretches, side),
                      false});
}

double nearest_distance(const std::vector<Vec3d>& positions, const Molecule& molecule,
                        const std::function<bool(std::size_t)>& counts) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (!counts(i)) continue;
    for (const Vec3d& p : positions) {
      const Vec3d d = p - molecule.positions[i];
      least = std::min(least, dot(d, d));
    }
  }
  return std::sqrt(least);
}

/// What an option left out of a molecule, nearest first.
/// @param to_source takes its positions to the source's frame, where the region is
void check_left_out_residues(const char* role, const Molecule& molecule, const RigidTransform& to_source,
                             const Molecule& source, const std::vector<std::uint8_t>& region,
                             std::vector<Warning>& warnings) {
  if (molecule.left_out.empty()) return;
  struct Near {
    double distance_A;
    const LeftOutResidue* residue;
  };
  std::vector<Near> nearest;
  for (const LeftOutResidue& left : molecule.left_out)
    nearest.push_back({nearest_distance(left.positions, molecule, [](std::size_t) { return true; }), &left});
  std::stable_sort(nearest.begin(), nearest.end(),
                   [](const Near& a, const Near& b) { return a.distance_A < b.distance_A; });
  std::string text;
  for (std::size_t k = 0; k < std::min(nearest.size(), kGroupsNamed); ++k) {
    const LeftOutResidue& left = *nearest[k].residue;
    text += (k == 0 ? "" : "; ") + residue_label(left.residue) + " (" + std::to_string(left.positions.size()) +
            (left.positions.size() == 1 ? " atom, " : " atoms, ") + signed_charge(left.charge) + ", " +
            angstrom(nearest[k].distance_A) + " from the molecule";
    if (!region.empty()) {
      std::vector<Vec3d> there;
      for (const Vec3d& p : left.positions) there.push_back(to_source.apply(p));
      const double distance_A = nearest_distance(
          there, source, [&](std::size_t i) { return region[static_cast<std::size_t>(source.atoms[i].residue)] != 0; });
      text += ", " + angstrom(distance_A) + " from the region";
    }
    text += ")";
  }
  if (nearest.size() > kGroupsNamed) text += "; and " + std::to_string(nearest.size() - kGroupsNamed) + " farther";
  warnings.push_back({std::to_string(nearest.size()) + (nearest.size() == 1 ? " residue" : " residues") + " of the " +
                          role + "'s file " + (nearest.size() == 1 ? "was" : "were") +
                          " left out, and the potential lacks " + (nearest.size() == 1 ? "it" : "them") + ": " + text,
                      false});
}

}  // namespace

std::vector<Warning> composition_warnings(const Molecule& source, const Molecule& target,
                                          const std::vector<std::uint8_t>& region, const Alignment& alignment,
                                          const MappedSurface& s, const UncoveredSurface& uncovered) {
  std::vector<Warning> warnings;
  const ResidueView source_view(source), target_view(target);
  ComposedSide a{"source", source_view, {}, {}, s, s.source_positions, nullptr};
  ComposedSide b{"target", target_view, {}, {}, s, s.positions, &uncovered};
  for (ComposedSide* const side : {&a, &b}) {
    side->atom_is_paired.assign(side->view.molecule->size(), false);
    side->residue_is_paired.assign(side->view.kinds.size(), false);
  }
  std::vector<bool> source_moved(source_view.kinds.size(), false), target_moved(target_view.kinds.size(), false);
  for (const auto& [i, j] : alignment.pairing.pairs) {
    a.atom_is_paired[i] = b.atom_is_paired[j] = true;
    a.residue_is_paired[static_cast<std::size_t>(source.atoms[i].residue)] = true;
    b.residue_is_paired[static_cast<std::size_t>(target.atoms[j].residue)] = true;
  }
  for (const MovedResidue& moved : alignment.pairing.moved)
    source_moved[moved.source] = target_moved[moved.target] = true;
  if (!alignment.pairing.pairs.empty()) {
    std::vector<UnpairedGroup> of_source = unpaired_others(a, source_moved),
                               of_target = unpaired_others(b, target_moved);
    take_replaced(of_source, of_target, alignment.source_to_target, a, warnings);
    check_unpaired(a, std::move(of_source), warnings);
    check_unpaired(b, std::move(of_target), warnings);
    const std::vector<std::int32_t> target_of = paired_residues(source, target, alignment.pairing);
    check_missing_atoms(a, target_view, target_of, warnings);
    check_missing_atoms(b, source_view, source_residues(target_of, target.residues.size()), warnings);
    check_recharged(a, b, target_of, warnings);
  }
  check_left_out_residues("source", source, RigidTransform(), source, region, warnings);
  check_left_out_residues("target", target, inverse(alignment.source_to_target), source, region, warnings);
  return warnings;
}

}  // namespace espdiff
