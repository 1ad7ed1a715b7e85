// region_result.h: the numbers and the certificate of a part of the source's surface: its region, or a patch.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"

namespace espdiff {

struct Alignment;
struct Certificate;
struct CompareResult;
struct MappedSurface;
struct Mapping;
struct Molecule;
struct PartResult;
struct Surface;

/// Which part of a mapping a region or patch is.
struct SurfacePart {
  std::vector<std::uint8_t> source;  ///< [source residue] nonzero in the part
  std::vector<std::uint8_t> target;  ///< [target residue] nonzero where a residue of the part pairs with it
  /// [triangle of the full mesh] nonzero outside of the part: fewer than two of its vertices belong to it
  std::vector<float> outside;
};

/// Checks that are made of whole mappings only, by their names in Certificate::not_checked.
const std::vector<std::string>& unchecked_in_parts();

/// @param inside    [vertex of the surface] nonzero in the part
/// @param source    [source residue] nonzero in the part
/// @param target_of [source residue] its partner, -1 for none
SurfacePart make_part(const std::vector<std::uint8_t>& inside, std::vector<std::uint8_t> source,
                      const MappedSurface& surface, const std::vector<std::int32_t>& target_of,
                      std::size_t n_target_residues);

/// [vertex] nonzero where its residue is marked.
std::vector<std::uint8_t> vertices_of(const std::vector<std::int32_t>& vertex_residue,
                                      const std::vector<std::uint8_t>& marked);

/// The mapping that a part is cut from.
struct WholeMapping {
  Engine& engine;
  const Mapping& mapping;
  const Surface& target_surface;
  float isovalue;
  const MappedSurface& surface;
  const Certificate& certificate;
  const Alignment& alignment;
  const Molecule &source, &target;
  const std::vector<std::int32_t>& target_of;  ///< [source residue] from paired_residues()
};

/// The part's shape, fit and certificate, as those of the whole: areas, unmatched parts, distances both ways; not yet
/// judged, and without metrics of potentials. On the target's side the part is the surface of the residues that pair.
/// Where nothing of it has a counterpart, what describes the mapping is NaN.
PartResult part_result(const WholeMapping& whole, const SurfacePart& part);

/// The verdict on a part without surface, or unmatched as a whole; no verdict on others.
/// @returns whether there is one
bool judge_missing_part(PartResult& part);
/// Refuses an earlier patch of which too little was found.
void judge_placement(PartResult& part);

/// The numbers of the region (kRegionPart) or of a patch; null where there is none of that name.
const PartResult* part_of(const std::vector<PartResult>& parts, const std::string& name);
/// The names of all parts: the region, then patches.
std::vector<std::string> part_names(const std::vector<PartResult>& parts);

}  // namespace espdiff
