// vertex_quantity.h: the per-vertex quantities that can be drawn and mapped, by name.
#pragma once

#include <string>
#include <vector>

#include "handles.h"

namespace espdiff::vmdplugin {

struct VertexQuantity {
  std::vector<float> values;  ///< [vertex]; NaN where there is none
  std::string unit;           ///< "" for a sign
};

/// @param name of a comparison: difference (target - source), source, target, slip, displacement, path_length, or sign,
/// which is +1 where a negative potential became positive, -1 where a positive one became negative, otherwise 0; of a
/// surface: potential
/// @throws InputError (another name; no potentials; no slip, since no atoms pair), and the failure of the object's job
VertexQuantity vertex_quantity(const std::string& handle, const Object& object, const std::string& name);

/// What a comparison calls the uncertainty of a vertex, Angstrom: its slip, or its displacement if no atoms pair; NaN
/// if unmatched, and where the atoms have no partner. All drawings ask here.
const std::vector<float>& vertex_uncertainty(const MappedSurface& surface);

/// Two-sided range for a colour scale.
struct QuantityRange {
  double min = 0, max = 0, p02 = 0, p98 = 0;  ///< NaN when there are no values; percentiles over the vertices
  std::size_t n = 0, n_nan = 0;
};
QuantityRange range_of(const std::vector<float>& values);

}  // namespace espdiff::vmdplugin
