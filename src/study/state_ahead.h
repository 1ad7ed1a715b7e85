// state_ahead.h: a state that another thread reads and charges, while the state before it is read and charged.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "base/progress.h"
#include "prepare/load_state.h"

namespace espdiff {

class StructureFile;

/// Reads a state that does not depend on the one before. PDB2PQR, which is most of the time, then runs once on each of
/// two cores. Whatever fails here is left to the caller, who reads the state again: errors, their order and their texts
/// are those of one state after the other. Its end cancels what still runs and waits for it, so that no program of it
/// is left.
class StateAhead {
 public:
  struct Read {
    std::shared_ptr<const StructureFile> file;
    LoadedState state;
  };

  /// Starts. @param read is given the Progress to load with, which reports nothing
  explicit StateAhead(std::function<Read(const Progress&)> read);
  ~StateAhead();
  StateAhead(const StateAhead&) = delete;
  StateAhead& operator=(const StateAhead&) = delete;

  /// Waits for the state. @returns nothing where it failed
  /// @throws Cancelled of the caller's progress
  std::optional<Read> take(const Progress& progress);

 private:
  Progress progress_;
  std::atomic<bool> is_done_{false};
  std::optional<Read> read_;
  std::thread thread_;
};

}  // namespace espdiff
