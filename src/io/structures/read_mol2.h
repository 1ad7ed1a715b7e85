// read_mol2.h: the atoms of a ligand in a Tripos MOL2 file.
#pragma once

#include <string>
#include <vector>

#include "base/vector.h"

namespace espdiff {

struct Mol2Atom {
  std::string name;
  std::string element;  ///< from the atom type: "C" of "C.ar"
  Vec3d position;       ///< Angstrom
  double charge = 0;    ///< elementary charges; 0 where the file has none
};

struct Mol2File {
  std::string path, content;
  std::vector<Mol2Atom> atoms;
};

/// Reads the ATOM section of a file's first molecule.
/// @throws IoError, InputError (not a MOL2 file, no atoms), FormatError (a line that cannot be read)
Mol2File read_mol2(const std::string& path);

}  // namespace espdiff
