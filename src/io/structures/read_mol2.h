// read_mol2.h: the atoms and bonds of Tripos MOL2 files.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/vector.h"

namespace espdiff {

struct Mol2Atom {
  std::string name;
  std::string element;                 ///< from the atom type: "C" of "C.ar"
  Vec3d position;                      ///< Angstrom
  double charge = 0;                   ///< elementary charges; 0 where the file has none
  std::string type = {};               ///< Tripos' atom type: "C.ar"
  bool has_charge = false;             ///< whether the line has one
  int substructure = 1;                ///< its number and name: 1, "ALA1"
  std::string substructure_name = {};  ///< empty where the file has none
  long line = 0;                       ///< of the file, from 1
};

/// Two atoms of a file, by their places in Mol2File::atoms.
struct Mol2Bond {
  std::size_t a, b;
};

struct Mol2File {
  std::string path, content;
  std::vector<Mol2Atom> atoms;
};

/// One of a file's molecules.
struct Mol2Molecule {
  std::vector<Mol2Atom> atoms;
  bool has_charges = true;            ///< unless the file says NO_CHARGES
  std::map<int, std::string> chains;  ///< of substructures, where they are named
};

/// The molecules of a text after unify_line_ends(), up to `most`. @throws FormatError, InputError as read_mol2()
std::vector<Mol2Molecule> mol2_molecules(const std::string& path, const std::string& text, std::size_t most);

/// Reads the ATOM section of a file's first molecule.
/// @throws IoError, InputError (not a MOL2 file, no atoms), FormatError (a line that cannot be read)
Mol2File read_mol2(const std::string& path);

/// The bonds of a file whose atoms are numbered from 1 in their order, as Open Babel writes them.
/// @throws FormatError (a line that cannot be read, or that names an atom that is not there)
std::vector<Mol2Bond> read_mol2_bonds(const Mol2File& file);

}  // namespace espdiff
