// probe_positions.h: positions of a probe that touches two or more atoms: they shape the concave parts of the
// solvent-excluded surface.
//
// A probe's centre may be anywhere outside the atoms' spheres that are larger by the probe's radius (the accessible
// region). All points that the probe covers from there are solvent (Richards, Annu. Rev. Biophys. Bioeng. 6, 151
// (1977)). The nearest point of the accessible region lies on one of its faces (parts of a sphere), edges (arcs where
// two spheres meet) or corners. Faces are treated exactly, see dielectric_map.h. Arcs with their corners are sampled so
// densely that the surface is off by less than 0.004 A.
#pragma once

#include <cstdint>
#include <vector>

#include "cuda/potential/pb_atoms.h"
#include "cuda/surface/density/atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A point is inside a sphere if its squared distance is below this fraction of the squared radius. So two atoms at one
/// position do not cover each other by rounding.
constexpr float kNotQuite = 1.0F - 1e-5F;

/// Atoms enlarged by the probe; for each, the atoms whose spheres intersect its own.
struct ProbeAtoms {
  std::shared_ptr<AtomCells> cells;  ///< reach is radius + probe
  Buffer<float> radius;              ///< [sorted atom] of the enlarged sphere, Angstrom
  Buffer<std::uint32_t> first;       ///< [sorted atom + 1] into `neighbour`
  Buffer<std::uint32_t> neighbour;   ///< sorted atoms; for each atom the nearest first
  Buffer<std::uint8_t> exposed;      ///< [sorted atom] 1 if a part of its sphere bounds the accessible region
};

/// The same for kernels.
struct ProbeAtomsView {
  AtomCellsView cells;
  const float* radius;
  const std::uint32_t* first;
  const std::uint32_t* neighbour;
  const std::uint8_t* exposed;

  ESPDIFF_INLINE Vec3f centre(std::uint32_t a) const { return {cells.x[a], cells.y[a], cells.z[a]}; }
  ESPDIFF_INLINE bool covers(std::uint32_t b, Vec3f p) const {
    const float dx = p.x - cells.x[b], dy = p.y - cells.y[b], dz = p.z - cells.z[b];
    return dx * dx + dy * dy + dz * dz < radius[b] * radius[b] * kNotQuite;
  }
  /// Whether p, on the sphere of atom a, lies inside another sphere.
  /// @param likely the entry of `neighbour` that is looked at first; becomes the one that covers p, which often covers
  /// the next point too
  ESPDIFF_INLINE bool is_buried(std::uint32_t a, Vec3f p, std::uint32_t& likely) const {
    if (first[a] == first[a + 1]) return false;
    if (covers(neighbour[likely], p)) return true;
    for (std::uint32_t n = first[a]; n < first[a + 1]; ++n) {
      if (!covers(neighbour[n], p)) continue;
      likely = n;
      return true;
    }
    return false;
  }
};
ProbeAtomsView view_of(const ProbeAtoms& atoms);

/// Sets cells and radii only. @param atoms with a positive radius each
ProbeAtoms make_probe_atoms(const std::vector<PbAtom>& atoms, float probe_radius);
/// Sets neighbours and exposure. Returns points of the arcs, corners included.
Buffer<Vec4f> find_probe_positions(ProbeAtoms& atoms);

}  // namespace espdiff::ESPDIFF_BACKEND
