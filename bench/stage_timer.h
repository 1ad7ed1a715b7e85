// stage_timer.h: times repeated calls, and stores the results of all benchmarks as JSON.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/handles.h"

namespace espdiff_bench {

/// One benchmark's times and counters.
class StageTimer {
 public:
  /// Median of this many repetitions, each of at least one call and at least `least_ms`.
  StageTimer(int n_repetitions, double least_ms) : n_repetitions_(n_repetitions), least_ms_(least_ms) {}

  /// Times a call by the engine's clock, on a GPU by events. With more than one repetition, an untimed first call warms
  /// up.
  /// @param n_in_call divisor of the time
  void time(espdiff::Engine& engine, const std::function<void()>& call, int n_in_call = 1);

  double median_ms() const { return median_ms_; }
  int n_repetitions() const { return n_repetitions_; }

  std::map<std::string, double> counters;  ///< sizes and qualities

 private:
  int n_repetitions_;
  double least_ms_, median_ms_ = 0;
};

/// Facts about the machine: date, cores, load, processor.
nlohmann::ordered_json machine_context();

}  // namespace espdiff_bench
