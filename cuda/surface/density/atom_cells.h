// atom_cells.h: atoms in a cell list, and the visit of the atoms near a point.
#pragma once

#include <array>

#include "base/handles.h"
#include "cuda/device/device.h"
#include "cuda/surface/density/gaussian.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Kernel view of the atoms. Cells are numbered x fastest, z slowest. The atoms of cell c are first[c] .. first[c+1]-1,
/// in input order, so a run of cells along x is one range of atoms.
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

/// Room after the last atom, for the CPU's loads of whole vectors.
constexpr std::size_t kAtomsBeyond = 16;

/// Atoms in a cell list.
struct AtomCells : DeviceAtoms {
  Buffer<float> x, y, z, exponent, reach;  ///< with room after the last atom
  Buffer<std::int32_t> residue;
  Buffer<std::uint32_t> first;
  std::array<int, 3> size{};
  Vec3f origin{};
  float cell = 0;
  float max_reach = 0;
  Vec3d lower{}, upper{};  ///< box that holds every atom's reach

  std::size_t n_atoms() const { return residue.size(); }
  AtomCellsView view() const;
};

/// Sorts on the device; waits for nothing.
/// @param order if not null, receives [sorted atom] the atom's index in the input
/// @throws InputError if no atom has a positive width, or a coordinate is not finite
std::shared_ptr<AtomCells> make_atom_cells(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                                           const std::vector<std::int32_t>& residues,
                                           Buffer<std::uint32_t>* order = nullptr);

/// Copies a value to its place in the order. It is no lambda, because nvcc's wrapper of a device lambda in a template
/// is initialized in one of the files that use it only.
template <typename T>
struct TakeInOrder {
  const T* from;
  const std::uint32_t* index;
  T* to;
  ESPDIFF_HD void operator()(std::size_t place) const { to[place] = from[index[place]]; }
};

/// [sorted atom] the values of the atoms in the order of their cells.
/// @param values [atom in the input]
template <typename T>
Buffer<T> in_cell_order(const std::vector<T>& values, const Buffer<std::uint32_t>& order) {
  const Buffer<T> sent = to_device(values);
  Buffer<T> sorted(order.size());
  for_each_index(sorted.size(), TakeInOrder<T>{raw(sent), raw(order), raw(sorted)});
  return sorted;
}

/// Calls visit(begin, end) for each range of atoms that may reach p, in ascending order.
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

}  // namespace espdiff::ESPDIFF_BACKEND
