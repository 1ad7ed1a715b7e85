// read_structure.h: molecules from PQR, PDB and mmCIF files, told apart by content.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/structure_options.h"
#include "base/types.h"
#include "base/unit_cell.h"

namespace espdiff {

/// Reads one conformation. The format is found from the content: a PQR, PDB or mmCIF under any name, also packed by
/// gzip, is read as what it is. Atoms keep file order. Alternate locations: the one of highest mean occupancy in the
/// residue (the first on ties). Models: MODEL records; without them (PDB, PQR) atoms that go on after END are the next
/// model. Radii: the file's (PQR), else Bondi's by element. Charges: the file's, else none. Unit: elementary charge.
/// @throws IoError (missing, directory, unreadable)
/// @throws FormatError (with line: bad number, NaN, short record, negative radius)
/// @throws InputError (no atoms, model out of range, format not read or not supported by this build, with remedy)
Molecule read_structure(const std::string& path, const StructureOptions& options = {});

/// Number of models in the file.
/// @throws as read_structure()
int count_models(const std::string& path);

/// A structure file whose models are read one after the other, such as the frames of a trajectory: the file itself is
/// read once, and its text kept.
class StructureFile {
 public:
  /// @throws as read_structure()
  explicit StructureFile(const std::string& path);
  ~StructureFile();
  StructureFile(const StructureFile&) = delete;
  StructureFile& operator=(const StructureFile&) = delete;

  /// Of the file as it was read.
  const std::string& sha256() const;
  int n_models() const;
  /// The cell of each model, see read_unit_cells(); none of an mmCIF file.
  /// @throws FormatError (a CRYST1 record that cannot be read)
  std::vector<std::optional<UnitCell>> unit_cells() const;
  /// @throws as read_structure()
  Molecule read(const StructureOptions& options) const;

 private:
  struct Parsed;
  std::unique_ptr<const Parsed> parsed_;
};

/// Van der Waals radius by element, Angstrom. Bondi, J. Phys. Chem. 68, 441 (1964); elements he does not give: Alvarez,
/// Dalton Trans. 42, 8617 (2013). `element` in any case; 1.7 for unknown (empty) ones.
float element_radius(const std::string& element);

/// Guesses the element from a PDB-style atom name and its residue ("CA" in ALA is carbon, "CA" in CA calcium).
std::string element_from_atom_name(const std::string& atom_name, const std::string& residue_name);

}  // namespace espdiff
