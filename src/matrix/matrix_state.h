// matrix_state.h: saves each finished cell of a matrix to disk, so that an interrupted run can continue.
#pragma once

#include <string>
#include <vector>

#include "matrix/matrix_plan.h"
#include "system/open_file.h"

namespace espdiff {

/// Content of a state file.
struct MatrixStateContent {
  MatrixPlan plan;
  std::vector<MatrixCell> cells;  ///< in the order of computation
  bool cut_off = false;           ///< the last row is incomplete, as after a kill, and is ignored
  std::size_t n_good_bytes = 0;   ///< up to that row
};

/// A text file: a line with the format's name and version, a line with the plan, and a line for each cell. Plan and
/// cells are JSON after a checksum of all lines so far, which detects any line that was changed, removed or moved.
/// @throws IoError (missing, unreadable), FormatError (another kind of file; a damaged line), each with the remedy
MatrixStateContent read_matrix_state(const std::string& path);

/// A state file that grows. One process at a time writes it.
class MatrixState {
 public:
  /// Starts a new file and replaces an older one.
  /// @throws IoError
  static MatrixState begin(const std::string& path, const MatrixPlan& plan);
  /// Continues a file; removes a truncated row.
  /// @throws as read_matrix_state(); InputError if the file belongs to another plan, with the difference
  static MatrixState go_on(const std::string& path, const MatrixPlan& plan, MatrixStateContent& content);

  /// Adds a cell; it is in the file when this returns, even if the process then dies.
  /// @throws IoError
  void add(const MatrixCell& cell);

 private:
  /// @throws IoError (another process writes it)
  MatrixState(std::string path, std::string sum);

  std::string path_;
  std::string sum_;          ///< of all lines
  PartsAndFields compared_;  ///< MatrixPlan::compared()
  OpenFile file_;
};

}  // namespace espdiff
