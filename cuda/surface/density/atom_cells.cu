// atom_cells.cu: sorts atoms into cells: checked and bounded on the host, sorted on the device.
#include "cuda/surface/density/atom_cells.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "cuda/device/sort.h"

namespace espdiff::ESPDIFF_BACKEND {

namespace {

/// Cells per reach: small cells let a query skip most atoms out of reach.
constexpr float kCellsPerReach = 3.0F;
constexpr double kMaxCells = 6.4e7;

/// An atom as it is sent to the device.
struct SentAtom {
  Vec3f position;
  float width;
  std::int32_t residue;
  std::uint32_t index;  ///< in the input
};

struct HostAtoms {
  std::vector<SentAtom> kept;                                       // those with a positive width, in input order
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};  // of the centres
  float max_reach = 0;
};

HostAtoms check_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                      const std::vector<std::int32_t>& residues, AtomCells& cells) {
  HostAtoms atoms;
  atoms.kept.reserve(positions.size());
  cells.lower = atoms.lower;
  cells.upper = atoms.upper;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!(widths[i] > 0)) continue;
    const float reach = kCutoffInWidths * widths[i];
    atoms.kept.push_back({static_cast<Vec3f>(positions[i]), widths[i], residues[i], static_cast<std::uint32_t>(i)});
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
                                           const std::vector<std::int32_t>& residues, Buffer<std::uint32_t>* order) {
  auto cells = std::make_shared<AtomCells>();
  const HostAtoms atoms = check_atoms(positions, widths, residues, *cells);
  choose_cells(atoms, *cells);

  const Buffer<SentAtom> sent = to_device(atoms.kept);
  const std::size_t n = sent.size();
  const SentAtom* const atom = raw(sent);
  Buffer<std::uint32_t> cell_of(n);
  std::uint32_t* const own = raw(cell_of);
  const AtomCellsView locate = cells->view();
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const Vec3f p = atom[i].position;
    own[i] = static_cast<std::uint32_t>(
        locate.clamped_cell(p.x, 0) +
        locate.size[0] * (locate.clamped_cell(p.y, 1) + locate.size[1] * locate.clamped_cell(p.z, 2)));
  });
  const auto& size = cells->size;
  Rows rows = sort_into_rows(std::move(cell_of), static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                                                     static_cast<std::size_t>(size[2]));
  cells->first = std::move(rows.first);
  for (Buffer<float>* values : {&cells->x, &cells->y, &cells->z, &cells->exponent, &cells->reach})
    values->resize(n + kAtomsBeyond);
  cells->residue.resize(n);
  float *const x = raw(cells->x), *const y = raw(cells->y), *const z = raw(cells->z),
               *const exponent = raw(cells->exponent), *const reach = raw(cells->reach);
  std::int32_t* const residue = raw(cells->residue);
  std::uint32_t* const item = raw(rows.item);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t place) {
    const SentAtom a = atom[item[place]];
    x[place] = a.position.x;
    y[place] = a.position.y;
    z[place] = a.position.z;
    exponent[place] = -0.5F / (a.width * a.width);
    reach[place] = kCutoffInWidths * a.width;
    residue[place] = a.residue;
    item[place] = a.index;
  });
  if (order != nullptr) *order = std::move(rows.item);
  return cells;
}

}  // namespace espdiff::ESPDIFF_BACKEND
