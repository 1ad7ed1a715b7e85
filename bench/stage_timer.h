// stage_timer.h: times calls again and again, and keeps the results of all benchmarks as JSON.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/handles.h"

namespace espdiff_bench {

/// One benchmark's times, with what was found beside them.
class StageTimer {
 public:
  /// Takes the median of so many repetitions, each of as many calls as take `least_ms` together, one at least.
  StageTimer(int n_repetitions, double least_ms) : n_repetitions_(n_repetitions), least_ms_(least_ms) {}

  /// Times a call by the engine's clock, on a GPU its events. A first one, which is not counted, warms up, unless there
  /// is one repetition only.
  /// @param n_in_call what the time is divided by
  void time(espdiff::Engine& engine, const std::function<void()>& call, int n_in_call = 1);

  double median_ms() const { return median_ms_; }
  int n_repetitions() const { return n_repetitions_; }

  std::map<std::string, double> counters;  ///< sizes and qualities

 private:
  int n_repetitions_;
  double least_ms_, median_ms_ = 0;
};

/// What is known of the machine: date, cores, load, processor.
nlohmann::ordered_json machine_context();

}  // namespace espdiff_bench
