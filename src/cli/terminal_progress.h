// terminal_progress.h: a progress bar on standard error, and cancellation by Ctrl-C.
#pragma once

#include <chrono>
#include <string>

#include "base/progress.h"
#include "system/interruption.h"

namespace espdiff::cli {

/// Draws one line, rewritten in place, if standard error is a terminal; otherwise nothing. While it lives, SIGINT,
/// SIGTERM and SIGHUP cancel, unless they were ignored before; SIGPIPE and SIGXFSZ are ignored from then on.
class TerminalProgress {
 public:
  TerminalProgress();
  ~TerminalProgress();
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  Progress& progress() { return progress_; }
  /// Removes the line before other output.
  void clear();

 private:
  void draw(const std::string& stage, double fraction);

  bool is_terminal_;
  bool drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_draw_{};
  Progress progress_;
  CancelScope scope_{progress_};
  Interruption interruption_;
};

}  // namespace espdiff::cli
