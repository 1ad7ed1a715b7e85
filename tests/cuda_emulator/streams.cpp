// streams.cpp: queues of work, and the functions that a library calls to put some in.
#include "streams.h"

#include <set>

#include "device_memory.h"

namespace cuda_emulator {
namespace {

std::set<Stream*>& all_streams() {
  static std::set<Stream*> all;
  return all;
}

}  // namespace

Stream::Stream() { all_streams().insert(this); }
Stream::~Stream() { all_streams().erase(this); }

void Stream::put(Work work) {
  if (capturing) {
    captured.push_back(std::move(work));
    return;
  }
  waiting.push_back(std::move(work));
}

void Stream::finish() {
  while (!waiting.empty()) {
    const Work work = std::move(waiting.front());
    waiting.pop_front();
    work();
  }
}

void finish_all_streams() {
  for (Stream* stream : all_streams()) stream->finish();
}

Stream& stream_of(void* handle) {
  static Stream default_stream;
  return handle == nullptr ? default_stream : *static_cast<Stream*>(handle);
}

}  // namespace cuda_emulator

void cuda_emulator_put(void* stream, void (*work)(void*), void* data) {
  cuda_emulator::stream_of(stream).put([work, data] { work(data); });
}
void* cuda_emulator_view(void* place) { return cuda_emulator::view(static_cast<char*>(place)); }
void cuda_emulator_mark_written(void* place, unsigned long n_bytes) { cuda_emulator::mark_written(place, n_bytes); }
