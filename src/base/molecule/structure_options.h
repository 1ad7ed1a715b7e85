// structure_options.h: which of the atoms in a structure file make the molecule.
#pragma once

#include <string>

namespace espdiff {

struct StructureOptions {
  int model = 1;               ///< which model of a multi-model file, from 1
  bool include_hetero = true;  ///< HETATM records: ligands, ions
  bool include_water = false;  ///< HOH, WAT, TIP3 and the like
  std::string assembly{};      ///< biological assembly to build, by its name in the file; empty: the atoms as they are
};

}  // namespace espdiff
