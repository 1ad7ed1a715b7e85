// workers.cpp: threads that take groups in order, and the thread that hands their items out in order.
#include "engine/workers.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "base/memory.h"
#include "engine/engine.h"
#include "engine/select_engine.h"

namespace espdiff {
namespace {

constexpr std::size_t kNoItem = static_cast<std::size_t>(-1);

using Failed = std::function<void(std::size_t, const Error&)>;

struct Range {
  std::size_t first = 0, end = 0;
};

/// What one thread computes with.
struct Means {
  std::unique_ptr<Engine> engine{};
  ComputeItem compute{};  // destroyed before the engine
};

/// What one thread is at.
struct Place {
  Progress progress;
  std::size_t item = kNoItem;
  std::string stage;

  explicit Place(const Progress::Listener& listener) : progress(listener) {}
};

/// What the threads share. Its threads end with it.
class Team {
 public:
  Team(const Engine& engine, const Workers& workers, const ItemGroups& groups,
       const std::function<ComputeItem(Engine&)>& begin, const Failed& failed, std::size_t n_supplied)
      : engine_(engine),
        workers_(workers),
        groups_(groups),
        begin_(begin),
        failed_(failed),
        n_supplied_(n_supplied),
        n_staying_(workers.n),
        n_alive_(workers.n),
        is_done_(groups.n_items, false) {
    for (int w = 0; w < workers.n; ++w) {
      const auto number = static_cast<std::size_t>(w);
      places_.push_back(std::make_unique<Place>([this, number](const std::string& stage, double) {
        const std::lock_guard<std::mutex> lock(mutex_);
        places_[number]->stage = stage;
      }));
    }
    for (const auto& place : places_) threads_.emplace_back([this, at = place.get()] { run(*at); });
  }
  ~Team() { stop(); }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// The inputs of the first n items are there.
  void supply(std::size_t n) {
    const std::lock_guard<std::mutex> lock(mutex_);
    n_supplied_ = n;
    to_take_.notify_all();
  }

  /// Waits at most so long for an item. @returns whether it is done
  /// @throws its error
  bool wait_for(std::size_t item, std::chrono::milliseconds moment) {
    std::unique_lock<std::mutex> lock(mutex_);
    news_.wait_for(lock, moment, [&] { return is_done_[item] || item == first_failed_; });
    if (item == first_failed_) std::rethrow_exception(error_);
    return is_done_[item];
  }

  /// The stage of an item that a thread is at; empty if none is.
  std::string stage_of(std::size_t item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& place : places_) {
      if (place->item == item) return place->stage;
    }
    return {};
  }

  /// Cancels what is being computed and waits for the threads. Nothing changes afterwards.
  void stop() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      next_group_ = groups_.ends.size();
      returned_.clear();
      to_take_.notify_all();
    }
    for (const auto& place : places_) place->progress.request_cancel();
    for (std::thread& thread : threads_) {
      if (thread.joinable()) thread.join();
    }
  }

  /// After stop(). @returns whether an item was computed
  bool is_done(std::size_t item) const { return is_done_[item]; }

 private:
  void run(Place& place) {
    const CancelScope scope(place.progress);
    omp_set_num_threads(workers_.n_threads_each);  // for the loops outside the engine
    {
      Means means;
      Range range;
      while (take(range) && compute(range, means, place)) {
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    --n_alive_;
    ended_.notify_all();
  }

  /// @returns whether the thread goes on
  bool compute(Range range, Means& means, Place& place) {
    for (; range.first < range.end && begin_item(place, range.first); ++range.first) {
      try {
        if (!fits(range.first, means, place, false)) {
          means = {};
          if (leaves(range, place)) return false;
          wait_until_alone();
          fits(range.first, means, place, true);
        }
        end_item(place, nullptr);
      } catch (const Cancelled&) {
        end_item(place, nullptr, false);
        return false;
      } catch (...) {
        end_item(place, std::current_exception());
      }
    }
    return true;
  }

  /// Computes an item. @returns whether there was memory for it; where it is computed alone, a lack is its error
  bool fits(std::size_t item, Means& means, Place& place, bool is_alone) {
    try {
      if (means.engine == nullptr) {
        means.engine = engine_.beside(workers_.n_threads_each);
        means.compute = begin_(*means.engine);
      }
      means.compute(item, place.progress);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (error.error_class() == ErrorClass::kMemory && !is_alone) return false;
      failed_(item, error);
    }
    return true;
  }

  /// Waits for a group whose inputs are there, or for items that another thread gives back: inputs behind those are not
  /// supplied before they are done. @returns whether there is one
  bool take(Range& range) {
    std::unique_lock<std::mutex> lock(mutex_);
    to_take_.wait(lock, [&] {
      return !returned_.empty() || next_group_ >= groups_.ends.size() || groups_.ends[next_group_] <= n_supplied_;
    });
    if (!returned_.empty()) {
      range = returned_.back();
      returned_.pop_back();
      return true;
    }
    if (next_group_ >= groups_.ends.size()) {
      --n_staying_;
      return false;
    }
    range = {next_group_ == 0 ? 0 : groups_.ends[next_group_ - 1], groups_.ends[next_group_]};
    ++next_group_;
    return true;
  }

  /// Gives items back for the others, unless there are none. @returns whether there are
  bool leaves(const Range& range, Place& place) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (n_staying_ == 1) return false;
    --n_staying_;
    returned_.push_back(range);
    to_take_.notify_one();
    place.item = kNoItem;
    return true;
  }

  /// Until the memory of all threads that leave is free.
  void wait_until_alone() {
    std::unique_lock<std::mutex> lock(mutex_);
    ended_.wait(lock, [&] { return n_alive_ == 1; });
  }

  /// @returns whether it is to be computed: not behind one that failed
  bool begin_item(Place& place, std::size_t item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    place.item = item;
    place.stage.clear();
    return item < first_failed_;
  }

  void end_item(Place& place, const std::exception_ptr& error, bool is_computed = true) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (error == nullptr) {
      is_done_[place.item] = is_computed;
    } else if (place.item < first_failed_) {
      first_failed_ = place.item;
      error_ = error;
    }
    place.item = kNoItem;
    news_.notify_one();
  }

  const Engine& engine_;
  const Workers& workers_;
  const ItemGroups& groups_;
  const std::function<ComputeItem(Engine&)>& begin_;
  const Failed& failed_;
  std::mutex mutex_;
  std::condition_variable news_, ended_, to_take_;
  std::size_t n_supplied_;  ///< items whose inputs are there
  std::size_t next_group_ = 0;
  std::vector<Range> returned_;  ///< by threads that left
  int n_staying_, n_alive_;      ///< threads that will take items again; threads that hold memory
  std::vector<bool> is_done_;
  std::size_t first_failed_ = kNoItem;
  std::exception_ptr error_;
  std::vector<std::unique_ptr<Place>> places_;
  std::vector<std::thread> threads_;
};

void compute_one_by_one(Engine& engine, std::size_t n_items, const std::function<ComputeItem(Engine&)>& begin,
                        const Failed& failed, const std::function<void(std::size_t)>& done, const Progress& progress,
                        const std::function<void(std::size_t)>& supply) {
  const ComputeItem compute = begin(engine);
  for (std::size_t item = 0; item < n_items; ++item) {
    // Each item's stages start at 0 again; the whole run's bar advances by items only.
    const Progress stages([&](const std::string& stage, double) {
      progress.report(stage, static_cast<double>(item) / static_cast<double>(n_items));
    });
    if (supply) supply(item);
    try {
      compute(item, stages);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      failed(item, error);
    }
    done(item);
  }
}

}  // namespace

Workers workers_for(const Engine& engine, std::size_t n_items, double bytes_each) {
  // A pair takes the host several times as long as a card.
  constexpr int kMostOnGpu = 16;
  const bool is_cpu = engine.n_threads() > 0;
  const int n_threads = is_cpu ? engine.n_threads() : available_threads();
  const double held = std::min(available_memory() / bytes_each, static_cast<double>(n_items));
  const int most = is_cpu ? n_threads : std::min(n_threads, kMostOnGpu);
  Workers workers;
  workers.n = std::max(1, static_cast<int>(std::min(static_cast<double>(most), held)));
  workers.n_threads_each = std::max(1, n_threads / workers.n);
  return workers;
}

Workers workers_for_frames(const Engine& engine, std::size_t n_frames, std::size_t n_atoms, std::size_t bytes_of_map) {
  constexpr std::size_t kLeastFramesEach = 2, kMapsEach = 3;  // of the frame that is computed, and of two that wait
  return workers_for(engine, std::max<std::size_t>(1, n_frames / kLeastFramesEach),
                     kBytesOfAtom * static_cast<double>(n_atoms) + static_cast<double>(kMapsEach * bytes_of_map));
}

void compute_items(Engine& engine, const Workers& workers, const ItemGroups& groups,
                   const std::function<ComputeItem(Engine&)>& begin,
                   const std::function<void(std::size_t, const Error&)>& failed,
                   const std::function<void(std::size_t)>& done, const Progress& progress,
                   const std::function<void(std::size_t)>& supply) {
  constexpr std::chrono::milliseconds kMoment(20), kNoTime(0);
  if (workers.n <= 1) {
    compute_one_by_one(engine, groups.n_items, begin, failed, done, progress, supply);
    return;
  }
  // While the slowest of the items at work is waited for, each other thread may compute one more.
  const auto n_ahead = static_cast<std::size_t>(2 * workers.n);
  std::size_t next = 0, n_supplied = supply ? 0 : groups.n_items;
  Team team(engine, workers, groups, begin, failed, n_supplied);
  try {
    while (next < groups.n_items) {
      const bool supplies = n_supplied < std::min(groups.n_items, next + n_ahead);
      if (supplies) {
        supply(n_supplied);
        team.supply(++n_supplied);
      }
      const bool is_done = team.wait_for(next, supplies ? kNoTime : kMoment);
      if (is_done) done(next++);
      if (next < groups.n_items)
        progress.report(team.stage_of(next), static_cast<double>(next) / static_cast<double>(groups.n_items));
    }
  } catch (const Cancelled&) {
    team.stop();
    for (; next < groups.n_items; ++next) {
      if (team.is_done(next)) done(next);
    }
    throw;
  }
}

}  // namespace espdiff
