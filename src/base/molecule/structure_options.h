// structure_options.h: which of the atoms in a structure file make the molecule.
#pragma once

#include <cstddef>
#include <string>

namespace espdiff {

struct StructureOptions {
  int model = 1;               ///< which model of a multi-model file, from 1
  bool include_hetero = true;  ///< HETATM records: ligands, ions
  bool include_water = false;  ///< HOH, WAT, TIP3 and the like
  std::string assembly{};      ///< biological assembly to build, by its name in the file; empty: the atoms as they are
};

/// A file's name as messages and results have it: "1d3z.pdb, model 2", and without the first model's number.
inline std::string with_model(const std::string& name, std::size_t model) {
  return model > 1 ? name + ", model " + std::to_string(model) : name;
}

}  // namespace espdiff
