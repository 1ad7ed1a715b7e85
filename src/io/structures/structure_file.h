// structure_file.h: molecules from structure files (PQR, PDB, mmCIF, GRO, MOL2, Amber's coordinates), distinguished by
// content; their models, or the frames of a trajectory with the atoms of another file, one after the other.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "base/molecule/structure_options.h"
#include "base/molecule/unit_cell.h"
#include "base/types.h"

namespace espdiff {

class CoordinateFile;
class StructureModels;

/// Reads one conformation. The format is found from the content: a PQR, PDB, mmCIF or GRO under any name, also packed
/// by gzip, is read as what it is. Atoms keep file order. Alternate locations: the one of highest mean occupancy in the
/// residue (the first on ties). Models: MODEL records; without them (PDB, PQR) atoms that continue after END are the
/// next model. Radii: the file's (PQR), otherwise Bondi's by element. Charges: the file's, otherwise none. Unit:
/// elementary charge.
/// @throws IoError (missing, directory, unreadable)
/// @throws FormatError (with line: bad number, NaN, short record, negative radius)
/// @throws InputError (no atoms, model out of range, format not read or not supported by this build, with remedy)
Molecule read_structure(const std::string& path, const StructureOptions& options = {});

/// "PQR, PDB, mmCIF, GRO, MOL2 or Amber restart"
std::string structure_format_names();

/// Number of models in the file.
/// @throws as read_structure()
int count_models(const std::string& path);

/// A structure file whose models are read one after the other, such as the frames of a trajectory: the file itself is
/// read once, and its text kept.
class StructureFile {
 public:
  /// @throws as read_structure()
  explicit StructureFile(const std::string& path);
  /// The frames of a trajectory as models; one of them is in memory.
  /// @param atoms all atoms, in the trajectory's order
  StructureFile(std::unique_ptr<CoordinateFile> frames, std::shared_ptr<const Molecule> atoms);
  ~StructureFile();
  StructureFile(const StructureFile&) = delete;
  StructureFile& operator=(const StructureFile&) = delete;

  const std::string& path() const { return path_; }
  /// Of the file as it was read. A trajectory's is computed when it is asked for.
  const std::string& sha256() const;
  /// For a file that is read again, such as frames too large to be kept: results tell of one content only.
  /// @param sha256 of the earlier reading; empty passes
  /// @throws IoError (the content is another one)
  void require_unchanged(const std::string& sha256) const;
  int n_models() const;
  /// The cell of a model, see read_unit_cells(); none of an mmCIF file.
  /// @param model from 1. @throws FormatError (a CRYST1 record or a frame that cannot be read)
  std::optional<UnitCell> unit_cell(int model) const;
  /// The first line of a residue in a PDB file, from 1; 0 where it is not found, and of other formats.
  long line_of(int model, const Residue& residue) const;
  /// Whether it has coordinates alone, such as Amber's restart files, so that a topology gives their atoms:
  /// read() refuses it.
  bool needs_atoms() const;
  /// All atoms of a model, water too. @throws as read()
  std::size_t n_atoms(int model) const;
  /// @throws as read_structure()
  Molecule read(const StructureOptions& options) const;
  /// Of a file that needs_atoms(). @param atoms all of them, in its order
  /// @throws as read(); InputError (another number of atoms)
  Molecule read_with(const Molecule& atoms, const StructureOptions& options) const;

 private:
  std::string path_;
  mutable std::string sha256_;
  std::unique_ptr<StructureModels> models_;
};

}  // namespace espdiff
