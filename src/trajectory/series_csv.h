// series_csv.h: the CSV file of a trajectory: one row for each frame, written when it is computed; can be resumed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/appended_file.h"
#include "trajectory/series_row.h"

namespace espdiff {

/// Everything that the rows depend on, by name; in the file as lines `# NAME: TEXT`.
using SeriesHead = std::vector<std::pair<std::string, std::string>>;

/// The file, locked: one run at a time writes it. It is empty until its first row; every row is in the file when add()
/// returns, whatever happens to the process then.
class SeriesCsv {
 public:
  /// @param head what this run's rows depend on. To be resumed, a file must say the same wherever it names the same.
  /// @throws IoError (the file exists, cannot be written, or another run is writing it), FormatError (another file, a
  ///         damaged line), InputError (made with something else; says what)
  /// @param parts region and patches, whose columns the rows have
  SeriesCsv(std::string path, SeriesHead head, ExistingFile existing, std::vector<std::string> parts = {});

  const std::string& path() const { return file_.path(); }
  /// Rows in the file: of earlier runs and of this one.
  const std::vector<SeriesRow>& rows() const { return rows_; }
  /// Fingerprint of the head.
  std::string fingerprint() const;

  /// Adds a line to the head after the file was opened. A resumed file must have the same line.
  /// @throws InputError (the file has another text)
  void note(const std::string& name, const std::string& text);
  /// @throws IoError
  void add(const SeriesRow& row);

 private:
  void read_rows();
  void check_same(const std::string& name, const std::string& in_file, const std::string& now) const;

  AppendedFile file_;
  SeriesHead head_;
  std::vector<std::string> parts_;
  std::vector<SeriesRow> rows_;
  bool has_head_ = false;  ///< the file begins with this run's head
};

}  // namespace espdiff
