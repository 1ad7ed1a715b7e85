// field_patches.h: connected areas of a state beyond a threshold of a field, and what became of each in the other
// state.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/molecule/quantity.h"
#include "base/types.h"

namespace espdiff {

/// Smaller ones are left out and counted.
constexpr double kLeastFieldPatch_A2 = 10;

/// What a patch became, or came from. Areas are compared over the trusted surface.
/// - unchanged, grew, shrank: one patch of the other state covers it, and no other; its area is within a quarter, more
///   than 1.25 times, or less than 1 / 1.25 of its own
/// - split: several patches of the target lie on one of the source
/// - merged: several patches of the source lie on one of the target
/// - vanished (of the source), appeared (of the target): no patch lies there
/// - unknown: none does, and less than half of the patch is trusted
///
/// A patch lies on another if they share a tenth of the smaller one's area, or kLeastFieldPatch_A2.
enum class PatchFate { kUnchanged, kGrew, kShrank, kSplit, kMerged, kVanished, kAppeared, kUnknown };
const char* to_string(PatchFate fate);  ///< "grew"
constexpr std::array<PatchFate, 8> kPatchFates = {PatchFate::kUnchanged, PatchFate::kGrew,   PatchFate::kShrank,
                                                  PatchFate::kSplit,     PatchFate::kMerged, PatchFate::kVanished,
                                                  PatchFate::kAppeared,  PatchFate::kUnknown};

/// A connected area. Borders within triangles lie where the linear interpolation of the corners' values meets the
/// threshold.
struct FieldPatch {
  bool is_above = true;  ///< beyond `above`; otherwise beyond `below`
  double area_A2 = 0, trusted_area_A2 = 0;
  double mean = 0;                                        ///< over its area
  double extreme = 0;                                     ///< the vertex' value farthest from the threshold
  std::vector<std::pair<std::int32_t, double>> residues;  ///< of its state, with areas, largest first
  PatchFate fate = PatchFate::kUnknown;
  std::vector<std::size_t> others;  ///< numbers of the patches of the other state that lie on it, ascending
};

/// The patches of both states by one field.
struct FieldPatches {
  Quantity quantity;
  PatchesRequest request;
  std::vector<FieldPatch> source, target;                ///< numbered from 1, largest first
  std::vector<std::int32_t> source_patch, target_patch;  ///< [vertex] number, 0 for none
  std::size_t n_small_source = 0, n_small_target = 0;    ///< left out
};

/// One state of a mapping's surface.
struct PatchedState {
  const std::vector<Vec3d>& positions;        ///< [vertex]
  const std::vector<float>& values;           ///< [vertex] NaN without a value
  const std::vector<std::int32_t>& residue;   ///< [vertex] of this state, -1 for none
  const std::vector<std::uint8_t>& left_out;  ///< [triangle] nonzero where the state has no surface; empty for none
};

/// @param why [triangle] 0 where it is trusted. Serial; the result depends on the input alone.
FieldPatches find_field_patches(const Quantity& quantity, const PatchesRequest& request,
                                const std::vector<Triangle>& triangles, const PatchedState& source,
                                const PatchedState& target, const std::vector<std::uint8_t>& why);

}  // namespace espdiff
