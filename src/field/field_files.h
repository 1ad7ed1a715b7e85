// field_files.h: files that a field's values come from, one for both states or one for each.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "field/field.h"

namespace espdiff {

/// "FILE" or "SOURCE_FILE,TARGET_FILE"; the names may have places that each variant or frame fills; see fill_pattern().
class SideFiles {
 public:
  /// @throws InputError (no file, more than two)
  SideFiles(const std::string& kind, const std::string& argument);
  /// The file of a state. @throws InputError (two files for one of many states; as fill_pattern())
  std::string of(const FieldSide& side) const;
  /// The same where each state needs a file of its own, as it does of a map.
  /// @throws InputError (a file that variants or frames would share)
  std::string own_of(const FieldSide& side) const;
  std::vector<std::string> all() const;
  /// Of the files that states share, with their SHA-256. @throws IoError
  std::vector<FieldFile> with_sums() const;
  /// The file of a state, if no other one shares it. @throws IoError
  std::vector<FieldFile> own_with_sum(const FieldSide& side) const;

 private:
  const std::string& pattern_of(const FieldSide& side) const;
  std::string what() const;

  std::string kind_, source_, target_;
};

/// Values of residues or of atoms from a table, by chain, number and insertion code, and for atoms by name.
class ValueTable {
 public:
  /// Reads a CSV file with the columns chain, residue_number, insertion_code (may be missing), for atoms atom_name, and
  /// value; instead of `value` the only other column that is no residue_name. An empty field, nan and NA are no value.
  /// @throws IoError, FormatError (columns, a number that is none, a place twice)
  ValueTable(const std::string& path, bool of_atoms);

  /// The values of a molecule's atoms, NaN where the table has none, with notes on what does not match.
  /// @throws InputError if nothing matches
  StateField values_of(const Molecule& molecule, const FieldSide& side) const;

 private:
  struct Entry {
    double value;
    std::string label;  ///< "A 12", as in the file
  };
  std::string path_;
  bool of_atoms_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> order_;  ///< keys, in the order of the file
};

/// The field of tables of residues' or atoms' values, one for both states or one for each.
/// @param argument of the kind: "FILE.csv" or "SOURCE.csv,TARGET.csv"
/// @throws as SideFiles, ValueTable
Field field_of_tables(const FieldKind& kind, const std::string& argument, bool of_atoms);

}  // namespace espdiff
