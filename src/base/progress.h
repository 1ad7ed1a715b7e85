// progress.h: progress reports and cancellation of long computations.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "base/error.h"

namespace espdiff {

/// The request to cancel that holds for this thread: for computations that are handed no Progress, the loops of an
/// engine above all. In a loop that several threads share, each iteration skips its work once the request is made, and
/// check() throws behind the loop.
class CancelRequest {
 public:
  CancelRequest() : flag_(of_thread()) {}

  bool made() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }
  /// @throws Cancelled
  void check() const {
    if (made()) throw Cancelled();
  }

  /// While it lives, its thread has no request: a loop within another loop's iteration may not throw, since no
  /// exception may leave an iteration that threads share.
  class Withheld {
   public:
    Withheld() : flag_(of_thread()) { of_thread() = nullptr; }
    ~Withheld() { of_thread() = flag_; }
    Withheld(const Withheld&) = delete;
    Withheld& operator=(const Withheld&) = delete;

   private:
    const std::atomic<bool>* flag_;
  };

 private:
  friend class CancelScope;
  static const std::atomic<bool>*& of_thread() {
    thread_local const std::atomic<bool>* flag = nullptr;
    return flag;
  }

  const std::atomic<bool>* flag_;
};

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

  /// @throws Cancelled after request_cancel(), of this or of the thread's CancelScope
  void check_cancelled() const {
    if (cancel_requested_.load(std::memory_order_relaxed)) throw Cancelled();
    CancelRequest().check();
  }

  void request_cancel() { cancel_requested_.store(true, std::memory_order_relaxed); }

 private:
  friend class CancelScope;

  Listener listener_;
  std::atomic<bool> cancel_requested_{false};
};

/// While it lives, a Progress' request to cancel is that of its thread (CancelRequest). For whom the user asks: the
/// command line, a job, a call from Python; not for a Progress that passes reports on to another one.
class CancelScope {
 public:
  explicit CancelScope(const Progress& progress) : before_(CancelRequest::of_thread()) {
    CancelRequest::of_thread() = &progress.cancel_requested_;
  }
  ~CancelScope() { CancelRequest::of_thread() = before_; }
  /// Takes on another copy's: a library that is loaded has its own variable of each thread.
  explicit CancelScope(const CancelRequest& request) : before_(CancelRequest::of_thread()) {
    CancelRequest::of_thread() = request.flag_;
  }
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

}  // namespace espdiff
