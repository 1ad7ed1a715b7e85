// compute_thread.h: what a thread needs that computes inside another program, such as VMD or Python.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace espdiff {

/// Sets the calling thread's floating-point environment to the default. VMD and some libraries flush denormal numbers
/// to zero, and threads inherit that: results would differ from the command line's in their last bits.
void set_default_rounding();

/// For GOMP_SPINCOUNT: how often libgomp's threads look for work before they sleep. A pair has thousands of short
/// loops; a thread that sleeps at once after each makes two threads take 1.2 to 1.8 times as long. Four times as many
/// looks make it 1.6 to 3 times as long beside busy programs, and libgomp's own 300,000 up to ten times.
constexpr const char* kBriefSpins = "5000";

/// Keeps OpenMP's threads from spinning while they wait, as long as it lives, unless GOMP_SPINCOUNT was set when this
/// library was loaded. libgomp reads it before; without it, it hardly spins with more threads than processors, so a
/// second team of threads is kept asleep.
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
