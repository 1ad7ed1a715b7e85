// unit_cell.h: a periodic cell as structure files give it.
#pragma once

#include <array>

#include "base/vector.h"

namespace espdiff {

/// A cell by lengths and angles.
struct UnitCell {
  Vec3d lengths{};  ///< Angstrom
  Vec3d angles{};   ///< degrees: between b and c, a and c, a and b
};

/// Whether its angles go together.
bool can_be(const UnitCell& cell);

/// Edge vectors: a along x, b in the x-y plane. @throws InputError (impossible angles)
std::array<Vec3d, 3> edges_of(const UnitCell& cell);

}  // namespace espdiff
