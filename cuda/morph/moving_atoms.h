// moving_atoms.h: the atoms at one time between source and target, and what moves a surface at a point: density,
// gradient, the atoms' velocity, and the density's rate of change.
#pragma once

#include <vector>

#include "cuda/surface/density/atom_cells.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Rates of change of an atom. Times run from 0 (source) to 1 (target).
struct AtomChange {
  Vec3f velocity;       ///< Angstrom / time
  Vec3f spin;           ///< angular velocity of its surroundings, radians / time
  float weight;         ///< 0 to 1: unpaired atoms fade
  float weight_rate;    ///< 1 / time
  float exponent_rate;  ///< of -1 / (2 s^2), 1 / (Angstrom^2 time)
  bool is_steady;       ///< its weight is 1, and neither that nor its width changes
};

/// Atoms at one time.
struct MovingAtoms {
  std::shared_ptr<AtomCells> cells;
  Buffer<AtomChange> change;     ///< [sorted atom]
  std::vector<Vec3d> positions;  ///< [atom of the input] Angstrom; on the host
  std::vector<float> widths;     ///< [atom of the input] Angstrom, 0 where it is absent; on the host
};

/// @throws InputError as make_atom_cells()
MovingAtoms atoms_at(const std::vector<MovingAtom>& atoms, double time);

/// At a point: rho = sum_i w_i exp(-|x - x_i|^2 / (2 s_i^2)).
struct FlowSample {
  float density;
  Vec3f gradient;  ///< of rho, 1 / Angstrom
  /// Velocity of the atoms' surroundings at this point, velocity + spin x (x - x_i), Angstrom / time; zero where no
  /// atom reaches. The spin keeps the surface, which lies beside the atoms, from lagging behind rotations. The weights
  /// are the square roots of the atoms' densities (Gaussians wider by sqrt(2)): with the densities themselves the flow
  /// shears so strongly between separating atoms that it tears the surface irreversibly.
  Vec3f velocity;
  float rate;  ///< of rho at this point, 1 / time
};

/// Samples the listed points: samples[list[i]] for i < n. Adds atoms in the order of the cell list in both forms. The
/// list should be in spatial order: the CPU processes points in blocks that share their atoms.
void flow_at_points(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                    std::size_t n, Buffer<FlowSample>& samples);

/// The general form, point by point; gives the same bits.
void flow_point_by_point(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                         std::size_t n, Buffer<FlowSample>& samples);

}  // namespace espdiff::ESPDIFF_BACKEND
