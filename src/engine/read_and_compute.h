// read_and_compute.h: items that the asking thread reads one after the other, and workers compute beside each other.
#pragma once

#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "engine/workers.h"

namespace espdiff {

/// What is done with each of n items, from its input to its result.
template <typename Input, typename Result>
struct ItemSteps {
  using Compute = std::function<Result(std::size_t item, const Input& input, const Progress& progress)>;

  std::function<Input(std::size_t)> read;  ///< called on the asking thread, in the items' order, a few items ahead
  std::function<Compute(Engine&)> begin;   ///< gives each worker its function; called on its thread, with its engine
  /// Called on the asking thread for each item in ascending order; what they throw ends the run. The latter is for an
  /// item that cannot be read or computed, but not for Cancelled.
  std::function<void(std::size_t, Result)> done;
  std::function<void(std::size_t, const Error&)> failed;
};

/// Reads, computes and hands over n items; as compute_items().
/// @throws what `done` and `failed` throw, after both were called for all items before; Cancelled
template <typename Input, typename Result>
void read_and_compute(Engine& engine, const Workers& workers, std::size_t n, const ItemSteps<Input, Result>& steps,
                      const Progress& progress) {
  struct Place {
    std::optional<Input> input;
    std::optional<Result> result;
    std::optional<Error> error;
  };
  std::vector<Place> places(n);
  ItemGroups each{n, std::vector<std::size_t>(n)};
  std::iota(each.ends.begin(), each.ends.end(), std::size_t{1});
  const auto keep_error = [&](std::size_t i, const Error& error) {
    places[i].error = error;
    places[i].input.reset();
  };
  const auto begin = [&](Engine& of_worker) -> ComputeItem {
    return [&, compute = steps.begin(of_worker)](std::size_t i, const Progress& stages) {
      Place& place = places[i];
      if (place.error) return;
      place.result = compute(i, *place.input, stages);
      place.input.reset();
    };
  };
  const auto supply = [&](std::size_t i) {
    try {
      places[i].input = steps.read(i);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      keep_error(i, error);
    }
  };
  const auto hand_over = [&](std::size_t i) {
    Place place = std::exchange(places[i], {});
    if (place.error) {
      steps.failed(i, *place.error);
    } else {
      steps.done(i, *std::move(place.result));
    }
  };
  compute_items(engine, workers, each, begin, keep_error, hand_over, progress, supply);
}

}  // namespace espdiff
