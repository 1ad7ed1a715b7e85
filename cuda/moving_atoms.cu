// moving_atoms.cu: places atoms at a time and sorts them into cells; sums over them at a point.
#include "moving_atoms.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION FlowSample flow_at(const MovingAtomsView& atoms, Vec3f p) { return flow_at_inline(atoms, p); }
#endif

MovingAtoms atoms_at(const std::vector<MovingAtom>& atoms, double time) {
  std::vector<Vec3d> positions(atoms.size());
  std::vector<float> widths(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const MovingAtom& a = atoms[i];
    positions[i] = (1 - time) * a.start + time * a.end;
    widths[i] = a.weight_at(time) > 0 ? static_cast<float>((1 - time) * a.start_width + time * a.end_width) : 0.0F;
  }
  std::vector<std::uint32_t> order;
  MovingAtoms now;
  now.cells = make_atom_cells(positions, widths, std::vector<std::int32_t>(atoms.size(), 0), &order);
  const std::size_t n_padded = order.size() + kLanes;
  std::vector<float> weight(n_padded), weight_rate(n_padded), exponent_rate(n_padded);
  std::vector<float> vx(n_padded), vy(n_padded), vz(n_padded);
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const MovingAtom& a = atoms[order[slot]];
    const double width = static_cast<double>(widths[order[slot]]);
    weight[slot] = static_cast<float>(a.weight_at(time));
    weight_rate[slot] = static_cast<float>(a.weight_rate_at(time));
    exponent_rate[slot] = static_cast<float>((a.end_width - a.start_width) / (width * width * width));
    const Vec3d velocity = a.end - a.start;
    vx[slot] = static_cast<float>(velocity.x);
    vy[slot] = static_cast<float>(velocity.y);
    vz[slot] = static_cast<float>(velocity.z);
  }
  now.weight = to_device(weight);
  now.weight_rate = to_device(weight_rate);
  now.exponent_rate = to_device(exponent_rate);
  now.vx = to_device(vx);
  now.vy = to_device(vy);
  now.vz = to_device(vz);
  return now;
}

}  // namespace espdiff::ESPDIFF_BACKEND
