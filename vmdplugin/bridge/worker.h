// worker.h: the thread that computes one job after the other in the background.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "base/progress.h"
#include "boundary.h"

namespace espdiff::vmdplugin {

/// A computation by the worker. Its functions may be called from any thread.
class Job {
 public:
  enum class State { kQueued, kRunning, kDone, kFailed, kCancelled };
  using Body = std::function<void(const Progress&)>;

  explicit Job(Body body);

  struct Status {
    State state = State::kQueued;
    std::string stage;  ///< "density", "deform", ...
    double fraction = 0;
  };
  Status status() const;
  bool finished() const;
  /// Waits until it has finished, at most so long; returns whether it has.
  bool wait(int milliseconds) const;
  void wait() const;
  /// A queued job never starts; a running one stops at its next check.
  void cancel();
  /// The reason of a failure or cancellation.
  Failure failure() const;

 private:
  friend class Worker;
  void run();
  void end(State state, const Failure& failure);

  Body body_;
  Progress progress_;
  mutable std::mutex mutex_;
  mutable std::condition_variable ended_;
  Status status_;
  Failure failure_{"", ""};
};

/// The thread. One for the process, since each job uses all processors; started by the first job, and joined by stop().
class Worker {
 public:
  static Worker& instance();

  std::shared_ptr<Job> submit(Job::Body body);
  /// Cancels all jobs and joins the thread; a later job starts it again. Called however the program ends: an
  /// unjoined thread would end the hosting program with an abort.
  void stop();

 private:
  struct Queue;
  Worker();
  std::shared_ptr<Queue> queue_;
};

const char* name_of(Job::State state);

}  // namespace espdiff::vmdplugin
