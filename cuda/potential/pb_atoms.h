// pb_atoms.h: an atom of the Poisson-Boltzmann equation.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

struct PbAtom {
  Vec3d position;  ///< Angstrom, the grid's frame
  float radius;    ///< Angstrom
  float charge;    ///< elementary charges
};

}  // namespace espdiff::ESPDIFF_BACKEND
