// isosurface.cu: marching tetrahedra by lattice rows: classify, count, scan, write.
#include "cuda/surface/isosurface.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/tetrahedra.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Vertices and triangles in a row of cells; after the scan, their offsets.
struct RowCounts {
  std::uint32_t vertices, triangles;
};

/// Shared state of one extraction's kernels.
struct Extraction {
  CubicLattice lattice;
  const float* density;
  float isovalue;
  const CellCase* cell_cases;
  std::uint8_t* inside;         // [point]
  std::uint8_t* cases;          // [point] case of the cell whose corner 0 is the point
  std::uint32_t* first_vertex;  // [point] index of the point's first vertex, if it has any
  Vec4f* positions;
  Corners* triangles;

  ESPDIFF_INLINE bool is_active(std::size_t point) const { return cases[point] != 0 && cases[point] != 255; }
  ESPDIFF_INLINE std::size_t corner_point(std::size_t point, int corner) const {
    const std::size_t nx = static_cast<std::size_t>(lattice.size[0]),
                      nxy = nx * static_cast<std::size_t>(lattice.size[1]);
    return point + static_cast<std::size_t>(corner & 1) + nx * static_cast<std::size_t>(corner >> 1 & 1) +
           nxy * static_cast<std::size_t>(corner >> 2 & 1);
  }
};

ESPDIFF_INLINE unsigned bit_count(unsigned bits) {
#if defined(__CUDA_ARCH__)
  return static_cast<unsigned>(__popc(bits));
#else
  return static_cast<unsigned>(__builtin_popcount(bits));
#endif
}

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION void classify_row_impl(const std::uint8_t* __restrict inside, std::size_t nx, std::size_t nxy,
                                            int n_cells, std::uint8_t* __restrict cases) {
  for (int i = 0; i < n_cells; ++i) {
    const unsigned low = inside[i] | inside[i + 1] << 1 | inside[i + nx] << 2 | inside[i + nx + 1] << 3;
    const unsigned high =
        inside[i + nxy] | inside[i + nxy + 1] << 1 | inside[i + nxy + nx] << 2 | inside[i + nxy + nx + 1] << 3;
    cases[i] = static_cast<std::uint8_t>(low | high << 4);
  }
}

#endif

/// Cases of a row of cells.
ESPDIFF_HD inline void classify_row(const Extraction& e, std::size_t row_start) {
#if defined(__CUDACC__)
  for (int i = 0; i < e.lattice.size[0] - 1; ++i) {
    const std::size_t point = row_start + static_cast<std::size_t>(i);
    unsigned cell_case = 0;
    for (int corner = 0; corner < 8; ++corner)
      cell_case |= static_cast<unsigned>(e.inside[e.corner_point(point, corner)]) << corner;
    e.cases[point] = static_cast<std::uint8_t>(cell_case);
  }
#else
  const std::size_t nx = static_cast<std::size_t>(e.lattice.size[0]),
                    nxy = nx * static_cast<std::size_t>(e.lattice.size[1]);
  classify_row_impl(e.inside + row_start, nx, nxy, e.lattice.size[0] - 1, e.cases + row_start);
#endif
}

ESPDIFF_INLINE void write_vertices(const Extraction& e, std::size_t point, int i, int j, int k, std::uint32_t& next) {
  e.first_vertex[point] = next;
  const unsigned mask = crossing_mask(e.cases[point]);
  for (int direction = 1; direction < 8; ++direction) {
    if ((mask >> (direction - 1) & 1U) == 0) continue;
    const float a = e.density[point], b = e.density[e.corner_point(point, direction)];
    const float t = smaller(larger((e.isovalue - a) / (b - a), 1e-3F), 1.0F - 1e-3F);
    const auto along = [&](int axis, int at) {
      const float base = e.lattice.coordinate(axis, at);
      return (direction >> axis & 1) != 0 ? base + t * e.lattice.spacing : base;
    };
    e.positions[next++] = {along(0, i), along(1, j), along(2, k), 0.0F};
  }
}

ESPDIFF_INLINE std::uint32_t vertex_index(const Extraction& e, std::size_t point, CellEdge edge) {
  const std::size_t low = e.corner_point(point, edge.low);
  const unsigned before = crossing_mask(e.cases[low]) & ((1U << (edge.direction - 1)) - 1U);
  return e.first_vertex[low] + bit_count(before);
}

/// No surface: reports whether the isovalue or the radii are the cause.
[[noreturn]] void throw_no_surface(const DensityGrid& density, float isovalue) {
  const std::vector<float> values = to_host(density.values);
  const float highest = *std::max_element(values.begin(), values.end());
  throw GeometryError(formatted(
      "no surface: the density reaches %.3g on a lattice of %.3g A and never exceeds the isovalue %.3g; "
      "lower the isovalue or the grid spacing, or raise the radius scale",
      static_cast<double>(highest), static_cast<double>(density.lattice.spacing), static_cast<double>(isovalue)));
}

/// Index of row (j, k) of cells; border rows j = size - 1 and k = size - 1 have no cells.
ESPDIFF_INLINE LatticeRow cell_row(const CubicLattice& lattice, std::size_t row) {
  const std::size_t n_j = static_cast<std::size_t>(lattice.size[1] - 1);
  return {static_cast<int>(row % n_j), static_cast<int>(row / n_j)};
}

}  // namespace

std::shared_ptr<SurfaceMesh> isosurface(const DensityGrid& density, float isovalue) {
  if (!(isovalue > 0)) throw InputError("isovalue " + formatted(isovalue) + " is not positive; 0.5 is usual");
  const CubicLattice lattice = density.lattice;
  const std::size_t n_points = lattice.n_points();
  const std::size_t n_rows =
      static_cast<std::size_t>(lattice.size[1] - 1) * static_cast<std::size_t>(lattice.size[2] - 1);
  Buffer<std::uint8_t> inside(n_points), cases(n_points);
  Buffer<std::uint32_t> first_vertex(n_points);
  Buffer<RowCounts> rows(n_rows);
  const Buffer<CellCase> cell_cases(kCellCases.data(), kCellCases.data() + kCellCases.size());
  Extraction e{lattice,    raw(density.values), isovalue, raw(cell_cases), raw(inside),
               raw(cases), raw(first_vertex),   nullptr,  nullptr};
  RowCounts* const row_counts = raw(rows);

  for_each_index((n_points + 63) / 64, [=] ESPDIFF_HD(std::size_t block) {
    const std::size_t end = 64 * block + 64 < n_points ? 64 * block + 64 : n_points;
    for (std::size_t p = 64 * block; p < end; ++p) e.inside[p] = e.density[p] > e.isovalue ? 1 : 0;
  });
  for_each_index(n_rows, [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = cell_row(e.lattice, row);
    const std::size_t start = e.lattice.index(0, at.j, at.k);
    classify_row(e, start);
    RowCounts counts{0, 0};
    for (int i = 0; i < e.lattice.size[0] - 1; ++i) {
      const std::size_t point = start + static_cast<std::size_t>(i);
      if (!e.is_active(point)) continue;
      counts.vertices += bit_count(crossing_mask(e.cases[point]));
      counts.triangles += e.cell_cases[e.cases[point]].n_triangles;
    }
    row_counts[row] = counts;
  });

  // There are few rows: the host computes their prefix sum in 64 bits, which detects an overflow.
  std::vector<RowCounts> host_rows = to_host(rows);
  std::uint64_t n_vertices = 0, n_triangles = 0;
  for (RowCounts& row : host_rows) {
    const RowCounts counts = row;
    row = {static_cast<std::uint32_t>(n_vertices), static_cast<std::uint32_t>(n_triangles)};
    n_vertices += counts.vertices;
    n_triangles += counts.triangles;
  }
  if (n_triangles == 0) throw_no_surface(density, isovalue);
  if (3 * n_triangles > 0xFFFFFFFFULL)
    throw MemoryError("the surface has more than 2^32 corners; use a larger grid spacing or fewer atoms");
  rows = to_device(host_rows);

  auto mesh = std::make_shared<SurfaceMesh>();
  mesh->positions.resize(n_vertices);
  Buffer<Corners> triangles(n_triangles);
  e.positions = raw(mesh->positions);
  e.triangles = raw(triangles);
  const RowCounts* const row_starts = raw(rows);
  for_each_index(n_rows, [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = cell_row(e.lattice, row);
    const std::size_t start = e.lattice.index(0, at.j, at.k);
    std::uint32_t next = row_starts[row].vertices;
    for (int i = 0; i < e.lattice.size[0] - 1; ++i) {
      const std::size_t point = start + static_cast<std::size_t>(i);
      if (e.is_active(point)) write_vertices(e, point, i, at.j, at.k, next);
    }
  });
  for_each_index(n_rows, [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = cell_row(e.lattice, row);
    const std::size_t start = e.lattice.index(0, at.j, at.k);
    std::uint32_t next = row_starts[row].triangles;
    for (int i = 0; i < e.lattice.size[0] - 1; ++i) {
      const std::size_t point = start + static_cast<std::size_t>(i);
      if (!e.is_active(point)) continue;
      const CellCase& cell = e.cell_cases[e.cases[point]];
      for (int t = 0; t < cell.n_triangles; ++t) {
        Corners& corners = e.triangles[next++];
        for (int c = 0; c < 3; ++c) corners.v[c] = vertex_index(e, point, cell.edges[t][c]);
      }
    }
  });
  mesh->topology = make_topology(n_vertices, std::move(triangles));
  return mesh;
}

}  // namespace espdiff::ESPDIFF_BACKEND
