// series_row.h: a row of a trajectory: its columns, and the source of their values.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "report/records/metrics.h"

namespace espdiff {

struct CompareOptions;
struct CompareResult;

/// Names of the columns, in order. Those of a region and of patches follow all others, then those of fields.
const std::vector<std::string>& series_columns(const PartsAndFields& compared = {});

/// One frame, by column; missing values are empty. Numbers have all digits. Nothing depends on time, threads or the
/// process, so that equal runs write equal bytes.
class SeriesRow {
 public:
  /// A row from a result, with the values of OUT.json (compare_json()), and of its parts.
  SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
            const CompareResult& result, const CompareOptions& options);
  /// A row without numbers, with the reason.
  SeriesRow(int frame, const std::string& reference, const std::string& error, const PartsAndFields& compared = {});
  /// @param cells one a column
  explicit SeriesRow(std::vector<std::string> cells, const PartsAndFields& compared = {})
      : columns_(&series_columns(compared)), cells_(std::move(cells)) {}

  /// @throws Error when there is no such column
  const std::string& operator[](const std::string& column) const;
  const std::vector<std::string>& cells() const { return cells_; }
  /// The columns that the row has.
  const std::vector<std::string>& columns() const { return *columns_; }

  /// Whether the next frame's mapping may start from this one's.
  bool has_mapping() const { return (*this)["error"].empty() && (*this)["converged"] == "1"; }

 private:
  std::size_t index_of(const std::string& column) const;
  std::string& at(const std::string& column);

  const std::vector<std::string>* columns_;
  std::vector<std::string> cells_;
};

/// The text with line breaks replaced by blanks. A row is one line, so that an incomplete row is recognized.
std::string one_line(std::string text);

}  // namespace espdiff
