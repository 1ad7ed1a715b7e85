// workers.cpp: items by several threads: their order, their errors, and threads that run out of memory beside others.
#include "engine/workers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "base/error.h"
#include "matrix/made_variants.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::ComputeItem;
using espdiff::Engine;
using espdiff::Error;
using espdiff::MemoryError;
using espdiff::Progress;
using espdiff::Workers;

namespace {

constexpr std::size_t kItems = 24;

/// Items 0 to 23 in groups of three, by four threads; an item takes a moment.
struct Run {
  std::vector<std::size_t> done;
  std::atomic<int> n_at_once{0}, most_at_once{0};

  /// @param compute (item, how many are computed at this moment)
  template <typename Compute>
  std::string message(Compute compute) {
    const auto engine = cpu_engine(1);
    espdiff::ItemGroups groups{kItems, {}};
    for (std::size_t end = 3; end <= kItems; end += 3) groups.ends.push_back(end);
    const auto begin = [&](Engine&) -> ComputeItem {
      return [&](std::size_t item, const Progress&) {
        const int n = ++n_at_once;
        most_at_once = std::max(n, most_at_once.load());
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        try {
          compute(item, n);
        } catch (...) {
          --n_at_once;
          throw;
        }
        --n_at_once;
      };
    };
    const auto failed = [](std::size_t item, const Error& error) {
      throw Error(error.error_class(), std::to_string(item) + ": " + error.message());
    };
    try {
      compute_items(*engine, Workers{4, 1}, groups, begin, failed, [&](std::size_t item) { done.push_back(item); }, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  bool is_in_order() const {
    for (std::size_t i = 0; i < done.size(); ++i) {
      if (done[i] != i) return false;
    }
    return true;
  }
};

}  // namespace

TEST_SUITE_BEGIN("workers");

TEST_CASE("items are computed beside each other and handed over in order") {
  Run run;
  CHECK(run.message([](std::size_t, int) {}).empty());
  CHECK(run.done.size() == kItems);
  CHECK(run.is_in_order());
  CHECK(run.most_at_once > 1);
}

TEST_CASE("the first of the items that fail is the run's error, after all before it") {
  Run run;
  const std::string message = run.message([](std::size_t item, int) {
    if (item == 7 || item == 10 || item == 20) throw espdiff::GeometryError("no surface");
  });
  CHECK(message == "7: no surface");
  CHECK(run.done.size() == 7);
  CHECK(run.is_in_order());
}

TEST_CASE("a thread that runs out of memory beside others leaves its items to them") {
  for (const int at_once : {1, 2}) {
    CAPTURE(at_once);
    Run run;
    const std::string message = run.message([&](std::size_t, int n) {
      if (n > at_once) throw MemoryError("too little memory");
    });
    CHECK(message.empty());
    CHECK(run.done.size() == kItems);
    CHECK(run.is_in_order());
    CHECK(run.most_at_once > at_once);
  }
}

TEST_CASE("an item for which there is too little memory although it is alone is the run's error") {
  Run run;
  const std::string message = run.message([](std::size_t item, int) {
    if (item == 5) throw MemoryError("too little memory");
  });
  CHECK(message == "5: too little memory");
  CHECK(run.done.size() == 5);
  CHECK(run.is_in_order());
}

TEST_CASE("an item that is given back for lack of memory is computed although all inputs ahead are used up") {
  const auto engine = cpu_engine(1);
  espdiff::ItemGroups each{kItems, {}};
  for (std::size_t end = 1; end <= kItems; ++end) each.ends.push_back(end);
  std::atomic<int> n_failed{0};
  std::vector<std::size_t> done;
  const auto begin = [&](Engine&) -> ComputeItem {
    return [&](std::size_t item, const Progress&) {
      if (item != 0 || n_failed++ != 0) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the others wait for inputs by then
      throw MemoryError("too little memory");
    };
  };
  const auto failed = [](std::size_t, const Error& error) { throw error; };
  compute_items(
      *engine, Workers{3, 1}, each, begin, failed, [&](std::size_t item) { done.push_back(item); }, {},
      [](std::size_t) {});
  CHECK(n_failed == 2);
  CHECK(done.size() == kItems);
  CHECK(std::is_sorted(done.begin(), done.end()));
}

TEST_CASE("inputs are supplied in order on one thread, a few ahead, and none behind an error of theirs") {
  for (const int n_threads : {1, 3}) {
    CAPTURE(n_threads);
    const auto engine = cpu_engine(1);
    espdiff::ItemGroups each{kItems, {}};
    for (std::size_t end = 1; end <= kItems; ++end) each.ends.push_back(end);
    std::vector<std::size_t> supplied, done;
    std::vector<int> inputs(kItems, 0);
    std::size_t most_ahead = 0;
    std::atomic<int> n_without{0};
    const auto here = std::this_thread::get_id();
    const auto begin = [&](Engine&) -> ComputeItem {
      return [&](std::size_t item, const Progress&) {
        if (inputs[item] != 1) ++n_without;
        std::this_thread::sleep_for(std::chrono::milliseconds(item % 5 == 0 ? 10 : 1));
      };
    };
    std::size_t refused = kItems;
    const auto supply = [&](std::size_t item) {
      if (item == refused) throw espdiff::InputError("no input");
      CHECK(std::this_thread::get_id() == here);
      supplied.push_back(item);
      inputs[item] = 1;
      most_ahead = std::max(most_ahead, supplied.size() - done.size());
    };
    const auto compute = [&] {
      supplied.clear();
      done.clear();
      inputs.assign(kItems, 0);
      compute_items(
          *engine, Workers{n_threads, 1}, each, begin, [](std::size_t, const Error&) {},
          [&](std::size_t item) { done.push_back(item); }, {}, supply);
    };
    compute();
    CHECK(n_without == 0);
    CHECK(supplied.size() == kItems);
    CHECK(std::is_sorted(supplied.begin(), supplied.end()));
    CHECK(done.size() == kItems);
    CHECK(std::is_sorted(done.begin(), done.end()));
    CHECK(most_ahead <= static_cast<std::size_t>(2 * n_threads));
    refused = 9;
    CHECK_THROWS_WITH_AS(compute(), "no input", espdiff::InputError);
    CHECK(supplied.size() == refused);
    CHECK(done.size() <= refused);
  }
}
