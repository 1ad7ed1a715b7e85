// residue_csv.h: one value of each residue along a trajectory: a row for each frame, a column for each residue.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/quantity.h"
#include "base/types.h"
#include "io/files/appended_file.h"

namespace espdiff {

struct CompareResult;

/// A row, and the head that the file gets with its first one.
struct ResidueLine {
  std::string quantity, unit;
  std::vector<std::string> columns, cells;
  std::vector<std::string> partners;  ///< [column] of the target; empty where all have the names of the columns
};

/// The file beside a trajectory's CSV file (SeriesCsv), with the frames that have numbers there.
class ResidueCsv {
 public:
  /// Its first line is this, the quantity, and its unit in brackets.
  static constexpr const char* kHeadWord = "residues: ";
  /// The third line, where the target's residues have other names: theirs, a cell under each column, empty for none.
  static constexpr const char* kPartners = "partners: ";

  /// @param quantity of residue_quantities(); empty: usual_residue_quantity()
  /// @param fields that are compared, whose quantities there are besides
  /// @throws as AppendedFile; InputError (there is no such quantity)
  ResidueCsv(std::string path, std::string quantity, ExistingFile existing,
             const std::vector<FieldRequest>& fields = {});

  const std::string& path() const { return file_.path(); }
  /// As it was asked for; empty for the usual one.
  const std::string& quantity() const { return quantity_; }
  /// Continues an existing file, unless it is to be replaced: keeps the rows of `frames`, which it must have, and drops
  /// one more, which a killed run wrote.
  /// @param frames that have numbers in the trajectory's file  @param fingerprint of its head
  /// @throws FormatError, InputError (the file is of another run or quantity; rows are missing)
  void resume(const std::vector<std::string>& frames, const std::string& fingerprint);
  /// The row of a frame. @throws as residue_values(); InputError (other residues than before)
  ResidueLine row(int frame, const Molecule& source, const Molecule& target, const CompareResult& result) const;
  /// @param row from row(); the partners in the head are those of the first  @param fingerprint of the trajectory's
  /// head
  /// @throws IoError
  void add(const ResidueLine& row, const std::string& fingerprint);

 private:
  AppendedFile file_;
  bool replaces_;  ///< what is there, by the first row
  std::string quantity_;
  std::vector<std::string> columns_;  ///< of the file; empty before its head is written
};

/// "A:LYS 12", with its insertion code; without a chain "LYS 12".
std::string residue_column(const Residue& residue);

}  // namespace espdiff
