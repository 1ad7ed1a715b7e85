// region_result.h: the numbers and the certificate of a part of the source's surface.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"

namespace espdiff {

struct AtomPairing;
struct CompareResult;
struct MappedSurface;
struct Mapping;
struct Molecule;
struct Surface;

/// Which part of a mapping the region is.
struct Region {
  std::vector<std::uint8_t> source;  ///< [source residue] nonzero in the region
  std::vector<std::uint8_t> target;  ///< [target residue] nonzero where a residue of the region pairs with it
  /// [triangle of the full mesh] nonzero outside of the region: fewer than two of its vertices belong to residues of it
  std::vector<float> outside;
};

/// Checks that are made of whole mappings only, by their names in Certificate::not_checked.
const std::vector<std::string>& unchecked_in_regions();

/// @param vertex_residue [vertex of the surface] source residue, -1 for none
/// @param target_of      [source residue] its partner, -1 for none
Region make_region(std::vector<std::uint8_t> source, const MappedSurface& surface,
                   const std::vector<std::int32_t>& vertex_residue, const std::vector<std::int32_t>& target_of,
                   std::size_t n_target_residues);

/// The region's shape, fit and certificate, as those of the whole: areas, unmatched parts, distances both ways; not yet
/// judged, and without metrics of potentials. On the target's side the region is the surface of the residues that pair.
std::shared_ptr<CompareResult> region_result(Engine& engine, const Region& region, const Mapping& mapping,
                                             const Surface& target, float isovalue,
                                             const std::vector<std::int32_t>& source_residue,
                                             const std::vector<std::int32_t>& mapped_residue,
                                             const std::vector<std::int32_t>& target_of, const CompareResult& whole,
                                             const Molecule& source_molecule, const Molecule& target_molecule);

}  // namespace espdiff
