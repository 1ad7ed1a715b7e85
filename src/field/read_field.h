// read_field.h: reads a state's field on a surface.
#pragma once

#include <vector>

#include "field/field.h"

namespace espdiff {

/// [vertex] the field's values on a surface, NaN where it has none.
/// @param place of the state that the field was made for
/// @throws as Engine::atom_field(), Engine::upload_map()
std::vector<float> read_field(const StateField& field, const FieldPlace& place);

}  // namespace espdiff
