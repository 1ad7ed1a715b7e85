// frame_exchange.cpp: a question and its answer between two threads.
#include "frame_exchange.h"

#include <chrono>
#include <utility>

namespace espdiff::vmdplugin {

LoadedState FrameExchange::ask(const Wanted& wanted, const Progress& progress) {
  std::unique_lock<std::mutex> lock(mutex_);
  wanted_ = wanted;
  given_.reset();
  refused_.reset();
  // Cancelling does not notify.
  while (!given_ && !refused_) {
    answered_.wait_for(lock, std::chrono::milliseconds(20));
    if (given_ || refused_) break;
    try {
      progress.check_cancelled();
    } catch (...) {
      wanted_.reset();
      throw;
    }
  }
  if (refused_) throw Error(*refused_);
  return std::move(*given_);
}

std::optional<FrameExchange::Wanted> FrameExchange::wanted() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return wanted_;
}

void FrameExchange::give(LoadedState state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  given_ = std::move(state);
  wanted_.reset();
  answered_.notify_all();
}

void FrameExchange::refuse(const Error& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  refused_ = why;
  wanted_.reset();
  answered_.notify_all();
}

}  // namespace espdiff::vmdplugin
