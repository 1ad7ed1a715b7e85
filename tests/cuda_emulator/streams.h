// streams.h: what a program puts into CUDA streams, done when it waits for it.
//
// Late is what a GPU may do as well: a program that gives a kernel memory and takes it back too early shows it here.
#pragma once

#include <deque>
#include <functional>
#include <vector>

namespace cuda_emulator {

using Work = std::function<void()>;

struct Stream {
  std::deque<Work> waiting;
  bool capturing = false;
  std::vector<Work> captured;

  Stream();
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  void put(Work work);
  /// Does all that waits.
  void finish();
};

void finish_all_streams();

struct Graph {
  std::vector<Work> steps;
};

/// The stream of the runtime's handle; null is the default stream.
Stream& stream_of(void* handle);

}  // namespace cuda_emulator

// For a library that puts work of its own into a stream.
#pragma GCC visibility push(default)
extern "C" void cuda_emulator_put(void* stream, void (*work)(void*), void* data);
extern "C" void* cuda_emulator_view(void* place);
extern "C" void cuda_emulator_mark_written(void* place, unsigned long n_bytes);
#pragma GCC visibility pop
