// compute_thread.cpp: floating-point environment, and threads that sleep.
#include "engine/compute_thread.h"

#include <omp.h>

#include <cfenv>
#include <cstdlib>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace espdiff {
namespace {

/// Who loads this library may unset it afterwards.
const bool kHadSpinCount = std::getenv("GOMP_SPINCOUNT") != nullptr;

}  // namespace

void set_default_rounding() {
  std::fesetenv(FE_DFL_ENV);
#if defined(__SSE__)
  constexpr unsigned kDefaultControl = 0x1f80;  // exceptions masked, round to nearest, denormals kept
  _mm_setcsr(kDefaultControl);
#endif
}

SleepingTeam::SleepingTeam() {
  if (!kHadSpinCount) thread_ = std::thread([this] { sleep(); });
}

SleepingTeam::~SleepingTeam() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    awake_ = true;
  }
  wake_up_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SleepingTeam::sleep() {
  int n = 0;
#pragma omp parallel reduction(+ : n) num_threads(omp_get_num_procs())
  ++n;
  std::unique_lock<std::mutex> lock(mutex_);
  wake_up_.wait(lock, [this] { return awake_; });
}

}  // namespace espdiff
