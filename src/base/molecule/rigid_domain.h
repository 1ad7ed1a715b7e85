// rigid_domain.h: a part of a molecule that moves as a rigid body.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vector.h"

namespace espdiff {

/// Residues of the source that one rigid motion takes to the target.
struct RigidDomain {
  std::vector<std::size_t> residues;  ///< source residues, ascending
  RigidTransform motion;              ///< source -> target, each in its own frame
  std::size_t n_atoms = 0;            ///< number of pairs used in the fit
  double rmsd_A = 0;                  ///< RMSD of these pairs after the motion
};

}  // namespace espdiff
