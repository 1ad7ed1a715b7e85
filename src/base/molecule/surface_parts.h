// surface_parts.h: parts of a surface that results are given for as well.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace espdiff {

/// The name of the region among the parts of a result. No patch can be called so.
constexpr const char* kRegionPart = "region";

struct EarlierPatch;

/// A part of the surface that was chosen before the result is seen.
struct SurfacePatch {
  std::string name;                               ///< as in PatchRequest
  std::vector<std::uint8_t> residues;             ///< [residue] nonzero in the patch; empty for an earlier one
  std::shared_ptr<const EarlierPatch> earlier{};  ///< a patch of another surface, whose place has to be found
};

/// The parts of a source's surface.
struct SurfaceParts {
  std::vector<std::uint8_t> region;  ///< [residue] nonzero in the region; empty for none
  std::vector<SurfacePatch> patches;
};

}  // namespace espdiff
