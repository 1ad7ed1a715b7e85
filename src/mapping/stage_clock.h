// stage_clock.h: the wall time of each stage.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace espdiff {

/// Adds up wall times by stage.
class StageClock {
 public:
  explicit StageClock(std::vector<std::pair<std::string, double>>& times) : times_(times) {}
  /// Ends the current stage and records it under this name.
  void lap(const std::string& stage) {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    const auto known =
        std::find_if(times_.begin(), times_.end(), [&](const auto& entry) { return entry.first == stage; });
    if (known == times_.end()) {
      times_.emplace_back(stage, ms);
    } else {
      known->second += ms;
    }
  }
  void finish() {
    times_.emplace_back("total",
                        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
  }

 private:
  std::vector<std::pair<std::string, double>>& times_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

}  // namespace espdiff
