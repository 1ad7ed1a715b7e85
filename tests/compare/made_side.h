// made_side.h: made molecules with charges and potentials, and a fingerprint of all results of a comparison.
#pragma once

#include <algorithm>
#include <cmath>

#include "certificate/result.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/shapes.h"
#include "mapping/input.h"
#include "options/options.h"
#include "support/random.h"

namespace espdiff_test {

using espdiff::CompareInput;
using espdiff::CompareOptions;
using espdiff::CompareResult;
using espdiff::Grid;
using espdiff::Molecule;
using espdiff::PotentialUnit;

/// A molecule and its potential.
struct Side {
  Molecule molecule;
  Grid map;

  CompareInput input() const { return {&molecule, &map}; }
  CompareInput shape() const { return {&molecule, nullptr}; }
};

/// Smoothed Coulomb potential of the charges, on a lattice around the molecule.
inline Grid potential_map(const Molecule& molecule, double spacing) {
  Grid map;
  double reach = 0;
  for (const Vec3d& p : molecule.positions) reach = std::max({reach, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  const int n = static_cast<int>(std::ceil(2 * (reach + 6) / spacing));
  const double low = -0.5 * spacing * (n - 1);
  map.lattice.size = {n, n, n};
  map.lattice.origin = {low, low, low};
  map.lattice.step = {{{spacing, 0, 0}, {0, spacing, 0}, {0, 0, spacing}}};
  map.unit = PotentialUnit::kKtPerE;
  map.name = "map.dx";
  for (std::size_t p = 0; p < map.lattice.n_points(); ++p) {
    const Vec3d at = lattice_point(map.lattice, p);
    double sum = 0;
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      const Vec3d d = at - molecule.positions[i];
      sum += static_cast<double>(molecule.charges[i]) / std::sqrt(dot(d, d) + 4);
    }
    map.values.push_back(static_cast<float>(sum));
  }
  return map;
}

/// A lopsided ball of residues with protein names and some charges.
inline Side make_side(std::uint64_t seed, double noise, std::size_t n = 120) {
  const AtomSet cloud = random_cloud(n, 200);
  Random random(seed);
  Side side;
  const char* const names[] = {"N", "CA", "C", "O", "CB", "CG", "CD", "CE", "CZ", "OH"};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    espdiff::Atom atom;
    atom.name = names[i % 10];
    atom.element = atom.name.substr(0, 1);
    atom.residue = cloud.residues[i];
    side.molecule.atoms.push_back(atom);
    const Vec3d p = cloud.positions[i];
    side.molecule.positions.push_back(Vec3d{p.x, 1.4 * p.y, 0.8 * p.z + 0.02 * p.y * p.y} + random.in_box(noise));
    side.molecule.radii.push_back(cloud.widths[i]);
    side.molecule.charges.push_back(i % 7 == 0 ? static_cast<float>(random.uniform(-1, 1)) : 0.0F);
  }
  for (std::size_t r = 0; r < (n + 9) / 10; ++r)
    side.molecule.residues.push_back({"TYR", "A", static_cast<std::int32_t>(r + 1), ' '});
  side.molecule.name = "molecule.pqr";
  side.map = potential_map(side.molecule, 1.0);
  return side;
}

inline CompareOptions quick_options() {
  CompareOptions options;
  options.regularize.max_iterations = 100;
  options.deform.max_iterations = 300;
  return options;
}

inline std::uint64_t hash_of(const CompareResult& r) {
  Hash hash;
  const auto& s = r.surface;
  hash.add(s.positions)
      .add(s.source_positions)
      .add(s.normals)
      .add(s.triangles)
      .add(s.potential_source)
      .add(s.potential_target);
  hash.add(s.displacement).add(s.path_length).add(s.residue).add(s.corrupt);
  for (const auto* m : {&r.potential.metrics, &r.potential.metrics_all}) {
    hash.add(m->area_A2).add(m->mean_abs_difference).add(m->rms_difference).add(m->mean_signed_difference);
    hash.add(m->sign_change_area_fraction)
        .add(m->hodgkin_index)
        .add(m->carbo_index)
        .add(m->mean_displacement_A)
        .add(m->mean_path_length_A);
  }
  for (const auto* d : {&r.certificate.mapped_to_target, &r.certificate.target_to_mapped})
    hash.add(d->mean).add(d->p95).add(d->max);
  for (const auto& row : r.residues) hash.add(row.area_A2).add(row.mean_abs_difference).add(row.mean_displacement_A);
  return hash.add(r.rmsd_A).add(r.mapping.deform.iterations).add(r.mapping.regularize.iterations).value();
}

}  // namespace espdiff_test
