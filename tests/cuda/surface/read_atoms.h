// read_atoms.h: the atoms of a structure file for the engine's tests.
#pragma once

#include <string>

#include "cuda/surface/shapes.h"
#include "io/structures/structure_file.h"

namespace espdiff_test {

inline AtomSet read_atoms(const std::string& path) { return atoms_of(espdiff::read_structure(path)); }

}  // namespace espdiff_test
