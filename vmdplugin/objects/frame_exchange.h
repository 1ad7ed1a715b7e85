// frame_exchange.h: frames that the worker needs and only the thread of Tcl can read, such as those of VMD's molecules.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "prepare/load_state.h"

namespace espdiff::vmdplugin {

/// Hands single frames from the thread of Tcl to the worker, one at a time: memory does not grow with their number.
class FrameExchange {
 public:
  struct Wanted {
    std::size_t replicate = 0, frame = 0;
    bool with_everything = false;  ///< also all atoms, for potentials of all charges in the cell
  };

  /// Asks for a frame and waits for it; on the worker's thread.
  /// @throws the error that refuse() was given; Cancelled
  LoadedState ask(const Wanted& wanted, const Progress& progress);

  /// The frame that the worker waits for; on Tcl's thread, as what follows.
  std::optional<Wanted> wanted() const;
  void give(LoadedState state);
  void refuse(const Error& why);

 private:
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  std::optional<Wanted> wanted_;
  std::optional<LoadedState> given_;
  std::optional<Error> refused_;
};

}  // namespace espdiff::vmdplugin
