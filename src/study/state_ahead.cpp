// state_ahead.cpp: the thread and its end.
#include "study/state_ahead.h"

#include <chrono>
#include <utility>

namespace espdiff {

StateAhead::StateAhead(std::function<Read(const Progress&)> read)
    : thread_([this, work = std::move(read)] {
        try {
          read_ = work(progress_);
        } catch (...) {  // NOLINT(bugprone-empty-catch): the caller reads the state again, and meets the same error
        }
        is_done_ = true;
      }) {}

StateAhead::~StateAhead() {
  progress_.request_cancel();
  if (thread_.joinable()) thread_.join();
}

std::optional<StateAhead::Read> StateAhead::take(const Progress& progress) {
  constexpr auto kPause = std::chrono::milliseconds(2);
  while (!is_done_) {
    progress.check_cancelled();
    std::this_thread::sleep_for(kPause);
  }
  return std::move(read_);
}

}  // namespace espdiff
