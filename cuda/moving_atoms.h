// moving_atoms.h: atoms on their way from source to target, at one time, and what a surface that follows them needs to
// know at a point: density, gradient, the atoms' velocity, and the density's change in time.
#pragma once

#include <vector>

#include "atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// What kernels see of moving atoms: the cell list of where they are now, and how each changes.
struct MovingAtomsView {
  AtomCellsView cells;
  const float* weight;         ///< [sorted atom] 0 to 1: atoms without a counterpart fade
  const float* weight_rate;    ///< [sorted atom] 1 / time
  const float* exponent_rate;  ///< [sorted atom] of -1 / (2 s^2), 1 / (Angstrom^2 time)
  const float* vx;             ///< [sorted atom] velocity, Angstrom / time
  const float* vy;
  const float* vz;
};

/// Atoms at one time between 0 (source) and 1 (target).
struct MovingAtoms {
  std::shared_ptr<AtomCells> cells;
  Buffer<float> weight, weight_rate, exponent_rate, vx, vy, vz;

  MovingAtomsView view() const {
    return {cells->view(), raw(weight), raw(weight_rate), raw(exponent_rate), raw(vx), raw(vy), raw(vz)};
  }
};

/// @throws InputError as make_atom_cells()
MovingAtoms atoms_at(const std::vector<MovingAtom>& atoms, double time);

/// At a point: rho = sum_i w_i exp(-|x - x_i|^2 / (2 s_i^2)).
struct FlowSample {
  float density;
  Vec3f gradient;  ///< of rho, 1 / Angstrom
  Vec3f velocity;  ///< of the atoms, weighted by their densities, Angstrom / time; zero where no atom reaches
  float rate;      ///< of rho at this point, 1 / time
};

#if defined(__CUDACC__)
ESPDIFF_INLINE FlowSample flow_at_inline(const MovingAtomsView& atoms, Vec3f p);
ESPDIFF_INLINE FlowSample flow_at(const MovingAtomsView& atoms, Vec3f p) { return flow_at_inline(atoms, p); }
#else
FlowSample flow_at(const MovingAtomsView& atoms, Vec3f p);
#endif

/// Sums of flow_at() in lanes, so that loops over atoms vectorize and the order of additions is fixed.
struct FlowLanes {
  float density[kLanes] = {}, gx[kLanes] = {}, gy[kLanes] = {}, gz[kLanes] = {};
  float vx[kLanes] = {}, vy[kLanes] = {}, vz[kLanes] = {}, rate[kLanes] = {};
};

ESPDIFF_INLINE void add_moving_atoms(const MovingAtomsView& atoms, Vec3f p, std::uint32_t begin, std::uint32_t end,
                                     FlowLanes& sum) {
  for (std::uint32_t i = begin; i < end; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t a = i + static_cast<std::uint32_t>(lane);
      const float dx = p.x - atoms.cells.x[a], dy = p.y - atoms.cells.y[a], dz = p.z - atoms.cells.z[a];
      const float k = atoms.cells.exponent[a];
      const float square = dx * dx + dy * dy + dz * dz;
      const bool counts = (a < end) & (k * square > kCutoffExponent);
      const float gaussian = exp_of_negative(counts ? k * square : 0.0F);
      const float full = counts ? gaussian : 0.0F;
      const float weighted = atoms.weight[a] * full;
      const float slope = weighted * k;
      sum.density[lane] += weighted;
      sum.gx[lane] += slope * dx;
      sum.gy[lane] += slope * dy;
      sum.gz[lane] += slope * dz;
      sum.vx[lane] += weighted * atoms.vx[a];
      sum.vy[lane] += weighted * atoms.vy[a];
      sum.vz[lane] += weighted * atoms.vz[a];
      const float approach = dx * atoms.vx[a] + dy * atoms.vy[a] + dz * atoms.vz[a];
      sum.rate[lane] +=
          atoms.weight_rate[a] * full + weighted * (atoms.exponent_rate[a] * square) - 2.0F * (slope * approach);
    }
  }
}

ESPDIFF_INLINE FlowSample flow_at_inline(const MovingAtomsView& atoms, Vec3f p) {
  FlowLanes sum;
  visit_atom_runs(
      atoms.cells, p, atoms.cells.max_reach,
      [&](std::uint32_t begin, std::uint32_t end)
          ESPDIFF_INLINE_LAMBDA { add_moving_atoms(atoms, p, begin, end, sum); });
  FlowSample sample{};
  for (int lane = 0; lane < kLanes; ++lane) {
    sample.density += sum.density[lane];
    sample.gradient += Vec3f{2.0F * sum.gx[lane], 2.0F * sum.gy[lane], 2.0F * sum.gz[lane]};
    sample.velocity += Vec3f{sum.vx[lane], sum.vy[lane], sum.vz[lane]};
    sample.rate += sum.rate[lane];
  }
  if (sample.density > 1e-12F) {
    sample.velocity = (1.0F / sample.density) * sample.velocity;
  } else {
    sample.velocity = Vec3f{};
  }
  return sample;
}

}  // namespace espdiff::ESPDIFF_BACKEND
