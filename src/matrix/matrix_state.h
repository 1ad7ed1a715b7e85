// matrix_state.h: the cells of a matrix on disk, each as soon as it is done, so that an interrupted run goes on.
#pragma once

#include <string>
#include <vector>

#include "matrix/matrix_plan.h"

namespace espdiff {

/// What a state file holds.
struct MatrixStateContent {
  MatrixPlan plan;
  std::vector<MatrixCell> cells;  ///< in the order in which they were computed
  bool cut_off = false;           ///< the last row is incomplete, as a killed run leaves it, and is not counted
  std::size_t n_good_bytes = 0;   ///< up to that row
};

/// A text file: a line with the format's name and version, a line with the plan, and a line for each cell. Plan and
/// cells are JSON after a check sum, which is that of all lines so far: a line that was changed, left out or moved is
/// found.
/// @throws IoError (missing, unreadable), FormatError (another kind of file; a line that is damaged), each with what to
/// do
MatrixStateContent read_matrix_state(const std::string& path);

/// A state file that grows. One process at a time writes it.
class MatrixState {
 public:
  /// Begins a new file, in the place of an older one.
  /// @throws IoError
  static MatrixState begin(const std::string& path, const MatrixPlan& plan);
  /// Goes on with a file; a row that is cut off is taken away.
  /// @throws as read_matrix_state(); InputError when the file belongs to another plan, saying what differs
  static MatrixState go_on(const std::string& path, const MatrixPlan& plan, MatrixStateContent& content);

  MatrixState(MatrixState&& other) noexcept;
  MatrixState& operator=(MatrixState&&) = delete;
  ~MatrixState();

  /// Adds a cell; it is in the file when this returns, whatever happens to the process then.
  /// @throws IoError
  void add(const MatrixCell& cell);

 private:
  /// @throws IoError (another process writes it)
  MatrixState(std::string path, std::string sum);

  std::string path_;
  std::string sum_;  ///< of all lines
  int descriptor_ = -1;
};

}  // namespace espdiff
