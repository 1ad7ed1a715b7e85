// complementarity.cpp: both partners' potentials on the surface that they bury, and their correlation.
#include "complementarity/complementarity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/not_a_number.h"
#include "base/triangle_areas.h"
#include "certificate/result.h"
#include "certificate/trusted_area.h"
#include "compare/compare.h"
#include "complementarity/weighted_correlation.h"
#include "engine/engine.h"
#include "field/field_result.h"
#include "io/molecules/select_atoms.h"
#include "mapping/build_surface.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"

namespace espdiff {
namespace {

bool is_within(const std::vector<Vec3d>& points, const Vec3d& p, double distance_A) {
  return std::any_of(points.begin(), points.end(), [&](const Vec3d& q) {
    const Vec3d d = p - q;
    return dot(d, d) < distance_A * distance_A;
  });
}

/// Where a vertex' nearest atom has its van der Waals sphere, and the direction from the atom to the vertex.
struct Touch {
  Vec3d place, outward;
};

/// [vertex] on the spheres of the surface's own molecule. The level set lies 1 to 2 A outside of them, where in an
/// interface it would run through the partner's atoms.
std::vector<Touch> touches(const std::vector<Vec3d>& positions, const Molecule& molecule) {
  std::vector<Touch> result;
  for (const Vec3d& p : positions) {
    double least = std::numeric_limits<double>::infinity();
    Touch touch;
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      const double radius = static_cast<double>(molecule.radii[i]), distance = norm(p - molecule.positions[i]);
      if (!(radius > 0) || !(distance > 0) || distance - radius >= least) continue;
      least = distance - radius;
      touch.outward = (1 / distance) * (p - molecule.positions[i]);
      touch.place = molecule.positions[i] + radius * touch.outward;
    }
    result.push_back(touch);
  }
  return result;
}

/// [vertex] whether a probe that touches the molecule there overlaps the partner.
std::vector<std::uint8_t> buried_vertices(const std::vector<Touch>& touched, const Molecule& partner) {
  std::vector<std::uint8_t> buried;
  for (const Touch& touch : touched) {
    const Vec3d probe = touch.place + kProbe_A * touch.outward;
    bool overlaps = false;
    for (std::size_t i = 0; i < partner.size() && !overlaps; ++i) {
      const Vec3d d = probe - partner.positions[i];
      const double reach = kProbe_A + static_cast<double>(partner.radii[i]);
      overlaps = partner.radii[i] > 0 && dot(d, d) < reach * reach;
    }
    buried.push_back(overlaps ? 1 : 0);
  }
  return buried;
}

/// The buried vertices that are farther from the others than the trimmed border.
std::vector<std::uint8_t> trimmed(const InterfaceSurface& s, const std::vector<std::uint8_t>& buried) {
  std::vector<Vec3d> open;
  for (std::size_t v = 0; v < buried.size(); ++v) {
    if (buried[v] == 0) open.push_back(s.positions[v]);
  }
  std::vector<std::uint8_t> inside = buried;
  for (std::size_t v = 0; v < buried.size(); ++v) {
    if (buried[v] != 0 && is_within(open, s.positions[v], kTrimmedBorder_A)) inside[v] = 0;
  }
  return inside;
}

/// [vertex] area of the triangles around it that there are.
std::vector<double> areas_of(const InterfaceSurface& s) {
  return corner_areas(s.positions, s.triangles,
                      [&](std::size_t t) { return s.left_out.empty() || s.left_out[t] == 0; });
}

/// The potentials within the interface with their weights.
struct InterfaceValues {
  std::vector<std::size_t> vertex;
  std::vector<double> own, other, weight;

  explicit InterfaceValues(const InterfaceSurface& s) {
    const std::vector<double> area = areas_of(s);
    for (std::size_t v = 0; v < s.inside.size(); ++v) {
      if (s.inside[v] == 0 || !(area[v] > 0) || !std::isfinite(s.own[v]) || !std::isfinite(s.other[v])) continue;
      vertex.push_back(v);
      own.push_back(static_cast<double>(s.own[v]));
      other.push_back(static_cast<double>(s.other[v]));
      weight.push_back(area[v]);
    }
  }
};

void set_local(InterfaceSurface& s) {
  s.local.assign(s.positions.size(), std::numeric_limits<float>::quiet_NaN());
  const InterfaceValues values(s);
  const std::vector<double> x = standardized(values.own, values.weight), y = standardized(values.other, values.weight);
  for (std::size_t i = 0; i < values.vertex.size(); ++i) s.local[values.vertex[i]] = static_cast<float>(-x[i] * y[i]);
}

std::vector<InterfaceResidue> residues_of(const InterfaceSurface& s, std::size_t n_residues) {
  const InterfaceValues values(s);
  double total = 0;
  for (const double weight : values.weight) total += weight;
  std::vector<InterfaceResidue> residues(n_residues);
  for (std::size_t i = 0; i < values.vertex.size(); ++i) {
    const std::int32_t r = s.residue[values.vertex[i]];
    if (r < 0) continue;
    InterfaceResidue& residue = residues[static_cast<std::size_t>(r)];
    residue.area_A2 += values.weight[i];
    residue.contribution += values.weight[i] * static_cast<double>(s.local[values.vertex[i]]) / total;
    residue.mean_own += values.weight[i] * values.own[i];
    residue.mean_other += values.weight[i] * values.other[i];
  }
  for (InterfaceResidue& residue : residues) {
    residue.mean_own = residue.area_A2 > 0 ? residue.mean_own / residue.area_A2 : kNaN;
    residue.mean_other = residue.area_A2 > 0 ? residue.mean_other / residue.area_A2 : kNaN;
  }
  return residues;
}

void measure(InterfaceSide& side) {
  const InterfaceValues values(side.surface);
  for (const double weight : values.weight) side.area_A2 += weight;
  side.pearson = -weighted_pearson(values.own, values.other, values.weight);
  side.spearman = -weighted_spearman(values.own, values.other, values.weight);
  side.residues = residues_of(side.surface, side.molecule.residues.size());
}

double nearest_distance(const Molecule& a, const Molecule& b) {
  double square = std::numeric_limits<double>::infinity();
  for (const Vec3d& p : a.positions) {
    for (const Vec3d& q : b.positions) square = std::min(square, dot(p - q, p - q));
  }
  return std::sqrt(square);
}

}  // namespace

InterfaceOfComplex::InterfaceOfComplex(Engine& engine, const LoadedState& complex, const InterfaceRequest& request,
                                       const MapOfComplex& map_of, const CompareOptions& options,
                                       const Progress& progress)
    : engine_(engine) {
  const PartnerAtoms of_file = atoms_of(request, complex.molecule);
  std::vector<bool> either = of_file.first;
  for (std::size_t i = 0; i < either.size(); ++i) {
    either[i] = either[i] || of_file.second[i];
    result_.n_left_out += either[i] ? 0 : 1;
  }
  LoadedState both = complex;
  both.molecule = keep_atoms(complex.molecule, either);
  both.everything = {};
  const PartnerAtoms atoms = atoms_of(request, both.molecule);
  to_common_ = principal_frame(both.molecule.positions);
  for (std::size_t side = 0; side < 2; ++side) {
    const std::vector<bool>& own = side == 0 ? atoms.first : atoms.second;
    LoadedState charged = both;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (!own[i]) charged.molecule.charges[i] = 0;
    }
    const ComputedMap map = map_of(charged);
    if (map.recipe().method == PotentialMethod::kPme)
      throw InputError(
          "complementarity is of potentials that one partner's charges make in the dielectric of both; "
          "a potential of all charges in a cell (pme) has none; use " +
          option("potential", "pb"));
    const MadeMap made = map.maker()(engine, inverse(to_common_), {}, progress);
    maps_[side] = made.map;
    result_.potential = potential_label(made.recipe);
    result_.sides[side].molecule = keep_atoms(both.molecule, own);
    result_.sides[side].molecule.name = complex.molecule.name;
  }
  set_surface_radii({&result_.sides[0].molecule, &result_.sides[1].molecule}, options.input.radii);
  for (std::size_t side = 0; side < 2; ++side) fill_side(side, options, progress);
  for (std::size_t side = 0; side < 2; ++side) {
    if (result_.sides[side].area_A2 > 0) continue;
    throw InputError(option("interface", request.first + ":" + request.second) + ": in " + complex.molecule.name +
                     " the partners bury no surface in each other (nearest atoms " +
                     formatted("%.1f", nearest_distance(result_.sides[0].molecule, result_.sides[1].molecule)) +
                     " A apart); name partners that touch");
  }
  result_.pearson = (result_.sides[0].pearson + result_.sides[1].pearson) / 2;
  result_.spearman = (result_.sides[0].spearman + result_.sides[1].spearman) / 2;
}

void InterfaceOfComplex::fill_side(std::size_t side, const CompareOptions& options, const Progress& progress) {
  InterfaceSide& of = result_.sides[side];
  std::vector<std::pair<std::string, double>> times;
  StageClock clock(times);
  const Surface made = build_surface(engine_, of.molecule, to_common_, options.surface, progress, clock);
  const RigidTransform from_common = inverse(to_common_);
  const Mesh mesh = engine_.download_shape(made.mesh);
  InterfaceSurface& s = of.surface;
  s.triangles = mesh.triangles;
  for (const Vec3f& p : mesh.positions) s.positions.push_back(from_common.apply(static_cast<Vec3d>(p)));
  for (const Vec3f& n : engine_.level_set_normals(made.mesh, made.atoms, static_cast<float>(options.surface.isovalue)))
    s.normals.push_back(static_cast<Vec3f>(from_common.rotate(static_cast<Vec3d>(n))));
  s.residue = engine_.vertex_residues(made.mesh, made.atoms);
  read(side, s);
  const std::vector<double> area = areas_of(s);
  const std::vector<std::uint8_t> buried =
      buried_vertices(touches(s.positions, of.molecule), result_.sides[1 - side].molecule);
  for (std::size_t v = 0; v < area.size(); ++v) of.buried_area_A2 += buried[v] != 0 ? area[v] : 0;
  measure(of);
}

void InterfaceOfComplex::read(std::size_t side, InterfaceSurface& s) const {
  Mesh mesh;
  mesh.triangles = s.triangles;
  const std::vector<Touch> touched = touches(s.positions, result_.sides[side].molecule);
  for (const Touch& touch : touched) mesh.positions.push_back(static_cast<Vec3f>(to_common_.apply(touch.place)));
  const MeshPtr uploaded = engine_.upload_mesh(mesh);
  s.own = engine_.download(engine_.sample(maps_[side], uploaded));
  s.other = engine_.download(engine_.sample(maps_[1 - side], uploaded));
  s.inside = trimmed(s, buried_vertices(touched, result_.sides[1 - side].molecule));
  set_local(s);
}

StateField InterfaceOfComplex::field(std::size_t side) const {
  StateField field;
  field.on_surface = [this, side](const FieldPlace& place) {
    const Mesh mesh = engine_.download_shape(place.mesh);
    const RigidTransform from_common = inverse(place.to_common);
    InterfaceSurface surface;
    surface.triangles = mesh.triangles;
    surface.left_out = place.left_out;
    for (const Vec3f& p : mesh.positions) surface.positions.push_back(from_common.apply(static_cast<Vec3d>(p)));
    read(side, surface);
    return surface.local;
  };
  return field;
}

StateComplementarity Complementarity::numbers() const {
  return {sides[0].molecule.name, {sides[0], sides[1]}, pearson, spearman, n_left_out, potential};
}

InterfaceChange change_of_side(Engine& engine, const InterfaceOfComplex& source, const InterfaceOfComplex& target,
                               std::size_t side, const CompareOptions& options, const Progress& progress) {
  const InterfaceSide &from = source.result().sides[side], &to = target.result().sides[side];
  const CompareResult mapped =
      compare(engine, {&from.molecule, nullptr, nullptr, {}}, {&to.molecule, nullptr, nullptr, {}}, options, progress);
  InterfaceChange change;
  const MappedSurface& s = mapped.surface;
  change.source.positions = s.source_positions;
  change.source.normals = s.source_normals;
  change.source.residue = s.residue;
  change.target.positions = s.positions;
  change.target.normals = s.normals;
  change.target.residue = s.target_residue;
  change.target.left_out = s.unmatched;
  for (InterfaceSurface* surface : {&change.source, &change.target}) surface->triangles = s.triangles;
  source.read(side, change.source);
  target.read(side, change.target);
  change.why = s.why;
  change.partner_of = paired_residues(from.molecule, to.molecule, mapped.alignment.pairing);
  change.verdict = verdict_of(mapped.certificate);
  return change;
}

}  // namespace espdiff
