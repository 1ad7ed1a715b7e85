// progress.h: progress reports and cancellation of long computations.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "base/error.h"

namespace espdiff {

/// Reports progress and carries the cancellation request. Cancelling is safe from a signal handler or another thread.
class Progress {
 public:
  /// Receives the stage's name ("density", "regularize", ...) and the fraction done, 0 to 1.
  using Listener = std::function<void(const std::string& stage, double fraction)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(std::move(listener)) {}

  /// Tells the listener, then throws if cancelled.
  /// @throws Cancelled after request_cancel().
  void report(const std::string& stage, double fraction) const {
    check_cancelled();
    if (listener_) listener_(stage, fraction);
  }

  /// @throws Cancelled after request_cancel().
  void check_cancelled() const {
    if (cancel_requested_.load(std::memory_order_relaxed)) throw Cancelled();
  }

  void request_cancel() { cancel_requested_.store(true, std::memory_order_relaxed); }

 private:
  Listener listener_;
  std::atomic<bool> cancel_requested_{false};
};

}  // namespace espdiff
