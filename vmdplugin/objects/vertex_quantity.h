// vertex_quantity.h: the per-vertex quantities that can be drawn and mapped, by name.
#pragma once

#include <string>
#include <vector>

#include "handles.h"

namespace espdiff::vmdplugin {

struct VertexQuantity {
  std::vector<float> values;  ///< [vertex]; NaN where there is none
  std::string unit;           ///< "" for a sign
  std::string label = "";     ///< of a field besides the potential
  bool is_signed = true;      ///< whether 0 parts two kinds of values
};

/// "FIELD:QUANTITY", as drawings name a quantity of a field; FIELD is empty for the potential and for lengths.
struct DrawnName {
  std::string field, quantity;

  explicit DrawnName(const std::string& text);
};

/// @throws InputError (a field that is not among these)
std::size_t place_of_field(const std::string& handle, const std::string& field, const std::vector<std::string>& names);

/// @param name of a comparison: difference (target - source), source, target, slip, displacement, path_length, or sign,
/// which is +1 where a negative potential became positive, -1 where a positive one became negative, otherwise 0; of a
/// surface: potential. Difference, source, target and sign of a field are FIELD:difference and so on.
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
