// unit_cell.h: a periodic cell as structure files give it.
#pragma once

#include "base/vector.h"

namespace espdiff {

/// A cell by lengths and angles.
struct UnitCell {
  Vec3d lengths{};  ///< Angstrom
  Vec3d angles{};   ///< degrees: between b and c, a and c, a and b
};

}  // namespace espdiff
