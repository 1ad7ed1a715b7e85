// workers.h: independent items computed by several threads, each with an engine of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"

namespace espdiff {

class Engine;

/// Threads that compute items beside each other, and how many threads each of their engines has on the CPU.
struct Workers {
  int n = 1;
  int n_threads_each = 1;
};

/// As many as the engine has threads, or a few on a GPU, whose host is then not waited for; fewer where there are fewer
/// items, or where memory does not hold so many.
/// @param bytes_each of the host, that one item takes at a time
Workers workers_for(const Engine& engine, std::size_t n_items, double bytes_each);

/// The same for frames that are compared with one state, each on a thread that prepares that state for itself first, at
/// about the cost of a frame.
/// @param n_atoms of a frame  @param bytes_of_map of the largest given map; 0 where maps are computed
Workers workers_for_frames(const Engine& engine, std::size_t n_frames, std::size_t n_atoms, std::size_t bytes_of_map);

/// Items in groups: what one thread computes one after the other, because they share something.
struct ItemGroups {
  std::size_t n_items = 0;
  std::vector<std::size_t> ends;  ///< [group] ascending: where the next group begins; the last one is n_items
};

/// Computes one item; one thread's, so it may keep what its items share.
using ComputeItem = std::function<void(std::size_t item, const Progress& progress)>;

/// Bytes of the host that a mapping between two states takes for each atom: measured to 31,000 with potentials in
/// solvent at 106,000 atoms.
constexpr double kBytesOfAtom = 4e4;

/// Computes all items. With one worker they are computed on this thread, by `engine`. A thread that runs out of memory
/// beside others leaves its items to them: an item has too little only if it has when it is alone.
/// @param begin gives each thread its function; called on that thread
/// @param failed is told the error of an item, on the item's thread: where it returns, the item is done, with what the
///        caller makes of it; what it throws ends the run. Not for Cancelled.
/// @param done  called on this thread for each item, in ascending order. After a request to cancel it is called for
///        all items that were computed before it.
/// @param progress receives the stage of the first item that is not done, and the fraction of items done; on this
/// thread
/// @param supply called on this thread for each item, in ascending order, before the item is computed and while others
///        are; a few items ahead, so that few inputs are in memory. What it throws ends the run. Groups are then of one
///        item each.
/// @throws what `failed` throws for the first of the items that fail, after done() of all items before it; what done()
///         throws; Cancelled
void compute_items(Engine& engine, const Workers& workers, const ItemGroups& groups,
                   const std::function<ComputeItem(Engine&)>& begin,
                   const std::function<void(std::size_t, const Error&)>& failed,
                   const std::function<void(std::size_t)>& done, const Progress& progress,
                   const std::function<void(std::size_t)>& supply = {});

}  // namespace espdiff
