// probe_positions.h: where a probe touches two or more atoms at once: what the solvent-excluded surface's concave parts
// roll on.
//
// A probe's centre may be anywhere outside the atoms' spheres that are larger by the probe's radius (the accessible
// region). What the probe reaches from there is solvent (Richards, Annu. Rev. Biophys. Bioeng. 6, 151 (1977)). A point
// within the probe's radius of the accessible region is so of one of the region's faces (parts of a sphere), edges
// (arcs where two spheres meet) or corners. Faces are tested exactly, see dielectric_map.h; arcs, ended by their
// corners, are taken as points so close together that the surface is off by less than 0.004 A.
#pragma once

#include <cstdint>
#include <vector>

#include "cuda/potential/pb_atoms.h"
#include "cuda/surface/atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A point counts as inside a sphere when its squared distance is below this part of the squared radius: two atoms in
/// one place must not cover each other by rounding.
constexpr float kNotQuite = 1.0F - 1e-5F;

/// Atoms enlarged by the probe, and for each those whose spheres cut its own.
struct ProbeAtoms {
  std::shared_ptr<AtomCells> cells;  ///< reach is radius + probe
  Buffer<float> radius;              ///< [sorted atom] of the enlarged sphere, Angstrom
  Buffer<std::uint32_t> first;       ///< [sorted atom + 1] into `neighbour`
  Buffer<std::uint32_t> neighbour;   ///< sorted atoms; for each atom the nearest first
  Buffer<std::uint8_t> exposed;      ///< [sorted atom] a part of its sphere bounds the accessible region
};

/// What kernels see of them.
struct ProbeAtomsView {
  AtomCellsView cells;
  const float* radius;
  const std::uint32_t* first;
  const std::uint32_t* neighbour;
  const std::uint8_t* exposed;

  ESPDIFF_INLINE Vec3f centre(std::uint32_t a) const { return {cells.x[a], cells.y[a], cells.z[a]}; }
  /// Whether p, on the sphere of atom a, lies inside another sphere.
  ESPDIFF_INLINE bool is_buried(std::uint32_t a, Vec3f p) const {
    for (std::uint32_t n = first[a]; n < first[a + 1]; ++n) {
      const std::uint32_t b = neighbour[n];
      const float dx = p.x - cells.x[b], dy = p.y - cells.y[b], dz = p.z - cells.z[b];
      if (dx * dx + dy * dy + dz * dz < radius[b] * radius[b] * kNotQuite) return true;
    }
    return false;
  }
};
ProbeAtomsView view_of(const ProbeAtoms& atoms);

/// Cells and radii alone. @param atoms with a positive radius each
ProbeAtoms make_probe_atoms(const std::vector<PbAtom>& atoms, float probe_radius);
/// Sets neighbours and exposure. Returns points of the arcs, corners included.
Buffer<Vec4f> find_probe_positions(ProbeAtoms& atoms);

}  // namespace espdiff::ESPDIFF_BACKEND
