// atom_cells.cu: sorts atoms into cells by a counting sort on the host, which is fast enough for their number.
#include "cuda/surface/atom_cells.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace espdiff::ESPDIFF_BACKEND {

namespace {

/// Cells per reach: small cells let a query skip most atoms out of reach.
constexpr float kCellsPerReach = 3.0F;
constexpr double kMaxCells = 6.4e7;

struct HostAtoms {
  std::vector<std::size_t> kept;                                    // input indices of atoms with a positive width
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};  // of the centres
  float max_reach = 0;
};

HostAtoms check_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& widths, AtomCells& cells) {
  HostAtoms atoms;
  cells.lower = atoms.lower;
  cells.upper = atoms.upper;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!(widths[i] > 0)) continue;
    const float reach = kCutoffInWidths * widths[i];
    atoms.kept.push_back(i);
    atoms.max_reach = std::max(atoms.max_reach, reach);
    for (int axis = 0; axis < 3; ++axis) {
      const double c = positions[i][axis];
      if (!std::isfinite(c)) throw InputError("atom " + std::to_string(i + 1) + " has a coordinate that is not finite");
      atoms.lower[axis] = std::min(atoms.lower[axis], c);
      atoms.upper[axis] = std::max(atoms.upper[axis], c);
      cells.lower[axis] = std::min(cells.lower[axis], c - reach);
      cells.upper[axis] = std::max(cells.upper[axis], c + reach);
    }
  }
  if (atoms.kept.empty())
    throw InputError("no atom has a positive radius, so there is no surface; check the radii or the selection");
  return atoms;
}

void choose_cells(const HostAtoms& atoms, AtomCells& cells) {
  cells.max_reach = atoms.max_reach;
  cells.cell = atoms.max_reach / kCellsPerReach;
  const Vec3d extent = atoms.upper - atoms.lower;
  const auto n_cells = [&](double edge) {
    return (std::floor(extent.x / edge) + 1) * (std::floor(extent.y / edge) + 1) * (std::floor(extent.z / edge) + 1);
  };
  while (n_cells(cells.cell) > kMaxCells) cells.cell *= 2;  // distant atoms: use fewer, larger cells
  cells.origin = static_cast<Vec3f>(atoms.lower);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.size[axis] = static_cast<int>(extent[static_cast<int>(axis)] / cells.cell) + 1;
  }
}

}  // namespace

AtomCellsView AtomCells::view() const {
  return {raw(x), raw(y), raw(z),   raw(exponent), raw(reach), raw(residue), raw(first), {size[0], size[1], size[2]},
          origin, cell,   max_reach};
}

std::shared_ptr<AtomCells> make_atom_cells(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                                           const std::vector<std::int32_t>& residues,
                                           std::vector<std::uint32_t>* order) {
  auto cells = std::make_shared<AtomCells>();
  const HostAtoms atoms = check_atoms(positions, widths, *cells);
  choose_cells(atoms, *cells);

  const auto& size = cells->size;
  const std::size_t n_cells =
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  std::vector<std::uint32_t> first(n_cells + 1, 0);
  std::vector<std::size_t> cell_of(atoms.kept.size());
  AtomCellsView locate{};
  std::copy(size.begin(), size.end(), locate.size);
  locate.origin = cells->origin;
  locate.cell = cells->cell;
  for (std::size_t n = 0; n < atoms.kept.size(); ++n) {
    const Vec3f p = static_cast<Vec3f>(positions[atoms.kept[n]]);
    cell_of[n] = static_cast<std::size_t>(locate.clamped_cell(p.x, 0)) +
                 static_cast<std::size_t>(size[0]) *
                     (static_cast<std::size_t>(locate.clamped_cell(p.y, 1)) +
                      static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(locate.clamped_cell(p.z, 2)));
    ++first[cell_of[n] + 1];
  }
  for (std::size_t c = 0; c < n_cells; ++c) first[c + 1] += first[c];

  const std::size_t n_kept = atoms.kept.size();
  std::vector<float> x(n_kept), y(n_kept), z(n_kept), exponent(n_kept), reach(n_kept);
  std::vector<std::int32_t> residue(n_kept);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  if (order != nullptr) order->resize(n_kept);
  for (std::size_t n = 0; n < atoms.kept.size(); ++n) {
    const std::size_t i = atoms.kept[n];
    const std::size_t slot = next[cell_of[n]]++;
    x[slot] = static_cast<float>(positions[i].x);
    y[slot] = static_cast<float>(positions[i].y);
    z[slot] = static_cast<float>(positions[i].z);
    exponent[slot] = -0.5F / (widths[i] * widths[i]);
    reach[slot] = kCutoffInWidths * widths[i];
    residue[slot] = residues[i];
    if (order != nullptr) (*order)[slot] = static_cast<std::uint32_t>(i);
  }
  cells->x = to_device(x);
  cells->y = to_device(y);
  cells->z = to_device(z);
  cells->exponent = to_device(exponent);
  cells->reach = to_device(reach);
  cells->residue = to_device(residue);
  cells->first = to_device(first);
  return cells;
}

}  // namespace espdiff::ESPDIFF_BACKEND
