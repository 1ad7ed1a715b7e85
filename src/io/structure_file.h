// structure_file.h: a structure file of one or more models, read once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/structure_options.h"
#include "base/types.h"
#include "base/unit_cell.h"

namespace espdiff {

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
  /// For a file that is read again, such as frames too large to be kept: results tell of one content only.
  /// @param sha256 of the earlier reading; empty passes
  /// @throws IoError (the content is another one)
  void require_unchanged(const std::string& sha256) const;
  int n_models() const;
  /// The cell of each model, see read_unit_cells(); none of an mmCIF file.
  /// @throws FormatError (a CRYST1 record that cannot be read)
  std::vector<std::optional<UnitCell>> unit_cells() const;
  /// The first line of a residue in a PDB file, from 1; 0 where it is not found, and of other formats.
  long line_of(int model, const Residue& residue) const;
  /// @throws as read_structure()
  Molecule read(const StructureOptions& options) const;

 private:
  struct Parsed;
  std::unique_ptr<const Parsed> parsed_;
};

}  // namespace espdiff
