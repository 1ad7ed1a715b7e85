// carry_rigidly.cu: moves each vertex by the density-weighted mean of the atoms' rigid motions.
#include "cuda/surface/carry_rigidly.h"

#include <string>

#include "base/error.h"
#include "cuda/surface/carry.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A rigid motion as a displacement linear in the position: x -> x + (matrix x + shift).
struct Displacement {
  Vec3f row[3];
  Vec3f shift;

  ESPDIFF_INLINE Vec3f at(Vec3f p) const { return Vec3f{dot(row[0], p), dot(row[1], p), dot(row[2], p)} + shift; }
};

Buffer<Displacement> displacements(const std::vector<RigidTransform>& motions) {
  std::vector<Displacement> all;
  for (const RigidTransform& motion : motions) {
    Displacement d{};
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = motion.rotation + std::ptrdiff_t{3} * axis;
      d.row[axis] = static_cast<Vec3f>(Vec3d{row[0], row[1], row[2]});
      d.row[axis][axis] = static_cast<float>(row[axis] - 1);
    }
    d.shift = static_cast<Vec3f>(motion.translation);
    all.push_back(d);
  }
  return to_device(all);
}

}  // namespace

std::shared_ptr<SurfaceMesh> carry_rigidly(const SurfaceMesh& mesh, const AtomCells& atoms,
                                           const std::vector<std::int32_t>& domains,
                                           const std::vector<RigidTransform>& motions) {
  for (const std::int32_t domain : domains) {
    if (domain >= static_cast<std::int32_t>(motions.size()))
      throw GeometryError("a residue belongs to rigid domain " + std::to_string(domain) + " of " +
                          std::to_string(motions.size()));
  }
  const Buffer<Displacement> moves = displacements(motions);
  const Buffer<std::int32_t> domain_of_residue = to_device(domains);
  const Displacement* const move = raw(moves);
  const std::int32_t* const domain_of = raw(domain_of_residue);
  const std::int32_t n_residues = static_cast<std::int32_t>(domains.size());
  const AtomCellsView cells = atoms.view();
  const Vec4f* const from = raw(mesh.positions);
  auto result = std::make_shared<SurfaceMesh>();
  result->topology = mesh.topology;
  result->positions.resize(mesh.n_vertices());
  Vec4f* const to = raw(result->positions);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec3f p = from[v].xyz();
    Vec3f sum{};
    float density = 0.0F;
    sum_at_point(cells, p,
                 [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
                   density += gaussian;
                   const std::int32_t residue = cells.residue[a];
                   const std::int32_t domain = residue >= 0 && residue < n_residues ? domain_of[residue] : -1;
                   if (domain >= 0) sum += gaussian * move[domain].at(p);
                 });
    to[v] = make_vec4(density > 0 ? p + (1.0F / density) * sum : p, 0.0F);
  });
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
