// random_charges.cpp: uses its own generator, so that every machine gets the same charges.
#include "random_charges.h"

#include <cstdint>

namespace espdiff_bench {

using espdiff::Vec3d;

espdiff::PmeCell cubic_cell(double edge_A) {
  return {Vec3d{}, {Vec3d{edge_A, 0, 0}, Vec3d{0, edge_A, 0}, Vec3d{0, 0, edge_A}}};
}

RandomCharges random_charges(std::size_t n_atoms, double edge_A) {
  RandomCharges result;
  result.cell = cubic_cell(edge_A);
  std::uint64_t state = 12345;
  const auto uniform = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 33) / 2147483648.0 - 0.5;
  };
  for (std::size_t i = 0; i < n_atoms; ++i) {
    const double x = edge_A * uniform(), y = edge_A * uniform();
    result.positions.push_back({x, y, edge_A * uniform()});
    result.charges.push_back(static_cast<float>(uniform()));
  }
  return result;
}

}  // namespace espdiff_bench
