// series_row.h: one frame's row of a trajectory: its columns, and where their values come from.
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

/// One frame, by column; what has no value is empty. Numbers have all their digits. Nothing in it depends on time,
/// threads or the process, so that equal runs write equal bytes.
class SeriesRow {
 public:
  /// What a comparison gave; values are those of OUT.json (compare_json()).
  SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
            const CompareResult& result, const CompareOptions& options);
  /// Why a frame has no numbers.
  SeriesRow(int frame, const std::string& reference, const std::string& error);
  /// @param cells one a column
  explicit SeriesRow(std::vector<std::string> cells) : cells_(std::move(cells)) {}

  /// @throws Error when there is no such column
  const std::string& operator[](const std::string& column) const;
  const std::vector<std::string>& cells() const { return cells_; }

  /// Whether the mapping of the frame after may begin at this one's.
  bool has_mapping() const { return (*this)["error"].empty() && (*this)["converged"] == "1"; }

 private:
  std::string& at(const std::string& column);

  std::vector<std::string> cells_;
};

/// The text with line breaks as blanks: a row is a line, so that an incomplete one is told by its missing end.
std::string one_line(std::string text);

}  // namespace espdiff
