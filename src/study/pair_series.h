// pair_series.h: many states against one source, each with a whole result: run_pair() with a surface that is made once.
#pragma once

#include <memory>
#include <optional>

#include "compare/series.h"
#include "study/pair_study.h"
#include "study/series_states.h"

namespace espdiff {

/// The source is read, and its surface and potential are made, at the first step.
class PairSeries {
 public:
  /// @param study its source, options, potential and command; the target is each step's
  PairSeries(PairStudy study, StartFrom start);
  PairSeries(const PairSeries&) = delete;
  PairSeries& operator=(const PairSeries&) = delete;

  /// Compares the next target.
  /// @param engine the same for all steps; must stay
  /// @throws as StateReader, SeriesStates, Series::step()
  PairAnswer step(const StatePtr& target, Engine& engine, const Progress& progress);

 private:
  StatesRequest request() const;
  void begin(Engine& engine, const Progress& progress);

  PairStudy study_;
  StartFrom start_;
  SeriesStates states_{study_.options};
  std::optional<CompareInput> source_;
  std::unique_ptr<Series> series_;  // destroyed before what it refers to
};

}  // namespace espdiff
