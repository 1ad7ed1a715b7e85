// compute_thread.h: what a thread needs that computes inside another program, such as VMD or Python.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace espdiff {

/// Sets the calling thread's floating-point environment to the default. VMD and some libraries flush denormal numbers
/// to zero, and threads inherit that: results would differ from the command line's in their last bits.
void set_default_rounding();

/// Keeps OpenMP's threads from spinning while they wait, as long as it lives. Beside another busy program spinning
/// makes a computation up to ten times as long. OMP_WAIT_POLICY, which forbids it, is read before this library is
/// loaded. With more threads than processors libgomp hardly spins, so a second team of threads is kept asleep.
class SleepingTeam {
 public:
  SleepingTeam();
  ~SleepingTeam();
  SleepingTeam(const SleepingTeam&) = delete;
  SleepingTeam& operator=(const SleepingTeam&) = delete;

 private:
  void sleep();

  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool awake_ = false;
  std::thread thread_;
};

}  // namespace espdiff
