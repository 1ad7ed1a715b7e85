// series_csv.h: the CSV file of a trajectory: one row for each frame, written when it is computed; can be resumed.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/files/appended_file.h"
#include "trajectory/series_row.h"

namespace espdiff {

/// Everything that the rows depend on, by name; in the file as lines `# NAME: TEXT`.
using SeriesHead = std::vector<std::pair<std::string, std::string>>;

/// The file, locked: one run at a time writes it. It is empty until its first row; every row is in the file when add()
/// returns, whatever happens to the process then.
class SeriesCsv {
 public:
  /// The last column of the file: a checksum of the row and of all above it, so that rows of two runs are not mixed and
  /// changed ones are found.
  static constexpr const char* kChecksumColumn = "checksum";

  /// @param head what this run's rows depend on. To be resumed, a file must say the same, no more and no less; what it
  ///             says besides must be noted (note()).
  /// @throws IoError (the file exists, cannot be written, or another run is writing it), FormatError (another file, a
  ///         damaged line), InputError (made with something else; says what)
  /// @param compared whose columns the rows have
  SeriesCsv(std::string path, SeriesHead head, ExistingFile existing, PartsAndFields compared = {});

  const std::string& path() const { return file_.path(); }
  /// Rows in the file: of earlier runs and of this one.
  const std::vector<SeriesRow>& rows() const { return rows_; }
  /// Fingerprint of the head.
  std::string fingerprint() const;

  /// Adds a line to the head after the file was opened. A resumed file must have the same line.
  /// @throws InputError (the file has another text, or none)
  void note(const std::string& name, const std::string& text);
  /// Called when everything has been noted. @throws InputError (a resumed file says something that this run has not)
  void require_all_noted() const;
  /// @throws IoError
  void add(const SeriesRow& row);

 private:
  void read_rows();
  void begin_checksums();
  [[noreturn]] void refuse_new(const std::string& name, const std::string& now) const;
  void check_same(const std::string& name, const std::string& in_file, const std::string& now) const;

  AppendedFile file_;
  SeriesHead head_;
  PartsAndFields compared_;
  std::vector<SeriesRow> rows_;
  std::set<std::string> unconfirmed_;  ///< lines of a resumed file's head that this run has not noted
  std::string sum_;                    ///< checksum of the last row
  bool has_head_ = false;              ///< the file begins with this run's head
  bool is_resumed_ = false;            ///< which an earlier run wrote
};

}  // namespace espdiff
