// series_csv.h: the CSV file of a trajectory: one row a frame, written as it is done, and read back to go on. The Tcl
// command writes and reads the same (tcl/series_csv.tcl).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff {

struct CompareOptions;
struct CompareResult;

/// Names of the columns, in order.
const std::vector<std::string>& series_columns();

/// One frame, by column; what has no value is empty. Numbers have all their digits.
class SeriesRow {
 public:
  /// What a comparison gave; values are those of OUT.json (compare_json()).
  SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
            const CompareResult& result, const CompareOptions& options);
  /// Why a frame has no numbers.
  SeriesRow(int frame, const std::string& reference, const std::string& error);
  /// @param cells one a column
  explicit SeriesRow(std::vector<std::string> cells) : cells_(std::move(cells)) {}

  const std::string& operator[](const std::string& column) const;
  const std::vector<std::string>& cells() const { return cells_; }

  /// Whether the mapping of the frame after may begin at this one's.
  bool has_mapping() const { return (*this)["error"].empty() && (*this)["converged"] == "1"; }

 private:
  std::string& at(const std::string& column);

  std::vector<std::string> cells_;
};

/// What the rows depend on, by name; each stands in the file as `# NAME: TEXT`.
using SeriesHead = std::vector<std::pair<std::string, std::string>>;

/// How to treat a file that is there already.
enum class ExistingFile { kRefuse, kResume, kReplace };

/// The file. It is there from its first row on; every row is on disk when add() returns.
class SeriesCsv {
 public:
  /// @param head what this run's rows depend on. To be resumed, a file must say the same wherever it names the same.
  /// @throws IoError (the file exists, or cannot be written), FormatError (another file, a damaged line),
  ///         InputError (made with something else; says what)
  SeriesCsv(std::string path, SeriesHead head, ExistingFile existing);

  const std::string& path() const { return path_; }
  /// Rows in the file: those of an earlier run, and those added.
  const std::vector<SeriesRow>& rows() const { return rows_; }
  /// Of what the rows depend on.
  std::string fingerprint() const;

  /// @throws IoError
  void add(const SeriesRow& row);

 private:
  void read_rows();
  void check_head(const std::string& name, const std::string& text) const;
  void append(const std::string& text) const;

  std::string path_;
  SeriesHead head_;
  std::vector<SeriesRow> rows_;
  bool replace_ = false;
};

}  // namespace espdiff
