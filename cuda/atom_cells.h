// atom_cells.h: atoms sorted into a cell list, and the analytic density anywhere in space from it.
#pragma once

#include <array>

#include "device.h"
#include "engine/engine.h"
#include "gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {

/// What kernels see of the atoms. Cells are numbered x fastest, z slowest; the atoms of cell c are first[c] ..
/// first[c+1]-1, in input order, so that a run of cells along x is one range of atoms.
struct AtomCellsView {
  const float* x;  ///< [sorted atom] Angstrom
  const float* y;
  const float* z;
  const float* exponent;  ///< [sorted atom] -1 / (2 s^2), 1/Angstrom^2
  const float* reach;     ///< [sorted atom] 4.5 s, Angstrom
  const std::int32_t* residue;
  const std::uint32_t* first;  ///< [cell + 1]
  int size[3];
  Vec3f origin;
  float cell;       ///< edge of a cell, Angstrom
  float max_reach;  ///< of all atoms

  ESPDIFF_INLINE int clamped_cell(float coordinate, int axis) const {
    const float c = (coordinate - origin[axis]) / cell;
    return c < 0.0F ? 0 : c >= static_cast<float>(size[axis]) ? size[axis] - 1 : static_cast<int>(c);
  }
};

/// Atoms in a cell list.
struct AtomCells : DeviceAtoms {
  Buffer<float> x, y, z, exponent, reach;
  Buffer<std::int32_t> residue;
  Buffer<std::uint32_t> first;
  std::array<int, 3> size{};
  Vec3f origin{};
  float cell = 0;
  float max_reach = 0;
  Vec3d lower{}, upper{};  ///< box that holds every atom's reach

  AtomCellsView view() const;
};

/// @param order where not null, becomes [sorted atom] the atom's index in the input
/// @throws InputError if no atom has a positive width, or a coordinate is not finite
std::shared_ptr<AtomCells> make_atom_cells(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                                           const std::vector<std::int32_t>& residues,
                                           std::vector<std::uint32_t>* order = nullptr);

/// Analytic density and its gradient.
struct DensitySample {
  float value;
  Vec3f gradient;  ///< 1/Angstrom
};

constexpr int kLanes = 8;

/// Adds the atoms begin..end-1 to the lanes; the order of additions is fixed by position in the list alone.
ESPDIFF_INLINE void add_atoms(const AtomCellsView& atoms, Vec3f p, std::uint32_t begin, std::uint32_t end,
                              float (&value)[kLanes], float (&gx)[kLanes], float (&gy)[kLanes], float (&gz)[kLanes]) {
  for (std::uint32_t i = begin; i < end; i += kLanes) {
    // The arrays end in kLanes atoms of no weight, so that reading past `end` is safe.
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t a = i + static_cast<std::uint32_t>(lane);
      const float dx = p.x - atoms.x[a], dy = p.y - atoms.y[a], dz = p.z - atoms.z[a];
      const float k = atoms.exponent[a];
      const float argument = k * (dx * dx + dy * dy + dz * dz);
      const bool counts = (a < end) & (argument > kCutoffExponent);
      const float gaussian = exp_of_negative(counts ? argument : 0.0F);
      const float weight = counts ? gaussian : 0.0F;
      const float slope = weight * k;
      value[lane] += weight;
      gx[lane] += slope * dx;
      gy[lane] += slope * dy;
      gz[lane] += slope * dz;
    }
  }
}

/// Calls visit(begin, end) for each run of atoms that may reach p, in ascending order.
template <typename Visit>
ESPDIFF_INLINE void visit_atom_runs(const AtomCellsView& atoms, Vec3f p, float reach, Visit visit) {
  const int x0 = atoms.clamped_cell(p.x - reach, 0), x1 = atoms.clamped_cell(p.x + reach, 0);
  const int y0 = atoms.clamped_cell(p.y - reach, 1), y1 = atoms.clamped_cell(p.y + reach, 1);
  const int z0 = atoms.clamped_cell(p.z - reach, 2), z1 = atoms.clamped_cell(p.z + reach, 2);
  for (int z = z0; z <= z1; ++z) {
    const float below = atoms.origin.z + atoms.cell * static_cast<float>(z) - p.z;
    const float above = -below - atoms.cell;
    const float dz = below > 0 ? below : above > 0 ? above : 0.0F;
    for (int y = y0; y <= y1; ++y) {
      const float left = atoms.origin.y + atoms.cell * static_cast<float>(y) - p.y;
      const float right = -left - atoms.cell;
      const float dy = left > 0 ? left : right > 0 ? right : 0.0F;
      if (dy * dy + dz * dz > reach * reach) continue;
      const int row = atoms.size[0] * (y + atoms.size[1] * z);
      const std::uint32_t begin = atoms.first[row + x0], end = atoms.first[row + x1 + 1];
      if (begin < end) visit(begin, end);
    }
  }
}

ESPDIFF_INLINE DensitySample density_at_inline(const AtomCellsView& atoms, Vec3f p) {
  float value[kLanes] = {}, gx[kLanes] = {}, gy[kLanes] = {}, gz[kLanes] = {};
  visit_atom_runs(atoms, p, atoms.max_reach, [&](std::uint32_t begin, std::uint32_t end) ESPDIFF_INLINE_LAMBDA {
    add_atoms(atoms, p, begin, end, value, gx, gy, gz);
  });
  DensitySample sample{0.0F, {}};
  for (int lane = 0; lane < kLanes; ++lane) {
    sample.value += value[lane];
    sample.gradient += Vec3f{2.0F * gx[lane], 2.0F * gy[lane], 2.0F * gz[lane]};
  }
  return sample;
}

/// Density (thesis eq. 3.1, truncated at 4.5 s) and gradient at p.
#if defined(__CUDACC__)
ESPDIFF_INLINE DensitySample density_at(const AtomCellsView& atoms, Vec3f p) { return density_at_inline(atoms, p); }
#else
DensitySample density_at(const AtomCellsView& atoms, Vec3f p);
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
