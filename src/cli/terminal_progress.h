// terminal_progress.h: a progress bar on standard error, and Ctrl-C as a request to stop.
#pragma once

#include <chrono>
#include <string>

#include "base/progress.h"

namespace espdiff::cli {

/// Draws one line that is rewritten, when standard error is a terminal; else nothing. While it lives, SIGINT,
/// SIGTERM and SIGHUP cancel, unless they were ignored before; SIGPIPE and SIGXFSZ are ignored from then on.
class TerminalProgress {
 public:
  TerminalProgress();
  ~TerminalProgress();
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  Progress& progress() { return progress_; }
  /// Removes the line, before something else is printed.
  void clear();

 private:
  void draw(const std::string& stage, double fraction);

  bool is_terminal_;
  bool drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_draw_{};
  Progress progress_;
};

}  // namespace espdiff::cli
