// structure_format.h: one format of structure files, and the table of them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/molecule/unit_cell.h"
#include "base/types.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"

namespace espdiff {

/// The models of a file, which are read one at a time.
class StructureModels {
 public:
  virtual ~StructureModels() = default;
  virtual int n_models() const = 0;
  /// @throws as StructureFile::read()
  virtual Molecule read(const StructureOptions& options) const = 0;
  /// See StructureFile. @param model from 1
  virtual std::optional<UnitCell> unit_cell(int /*model*/) const { return std::nullopt; }
  virtual long line_of(int /*model*/, const Residue& /*residue*/) const { return 0; }
  /// See StructureFile: of formats that have coordinates alone.
  virtual bool needs_atoms() const { return false; }
  virtual std::size_t n_atoms() const { return 0; }
  virtual Molecule read_with(const Molecule& /*atoms*/, const StructureOptions& options) const { return read(options); }
};

/// A format. Its file, `io/structures/formats/NAME.cpp`, has a function `NAME_format()` that returns it.
struct StructureFormat {
  std::string name;  ///< for messages: "mmCIF"
  /// Whether a file that begins with `head` has this format. Where recognise() knows it, by its answer `kind`.
  bool (*is)(std::string_view head, FileKind kind);
  /// Takes the content, of a text after unify_line_ends(). @throws FormatError, InputError as read_structure()
  std::unique_ptr<StructureModels> (*open)(FileContent file);
};

/// All of them, in the order of the list `structure_formats` in src/CMakeLists.txt, from which the build makes this
/// table.
const std::vector<StructureFormat>& structure_formats();

}  // namespace espdiff
