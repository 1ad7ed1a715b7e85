// run.cpp: a thread that works, and one that waits.
#include "run.h"

#include <nanobind/stl/string.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "engine/compute_thread.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

/// What the working thread tells the waiting one.
struct Shared {
  std::mutex mutex;
  std::condition_variable changed;
  std::string stage;
  double fraction = 0;
  bool is_new = false, is_done = false;
  std::exception_ptr failure;
};

/// Looks for Ctrl-C, and tells the listener what is new. Holds the interpreter's lock.
void tell_python(const nb::object& listener, Shared& shared) {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  if (listener.is_none()) return;
  std::string stage;
  double fraction = 0;
  {
    const std::lock_guard<std::mutex> lock(shared.mutex);
    if (!shared.is_new) return;
    shared.is_new = false;
    stage = shared.stage;
    fraction = shared.fraction;
  }
  listener(stage, fraction);
}

}  // namespace

void run(const nb::object& listener, const std::function<void(const Progress&)>& work) {
  Shared shared;
  Progress progress([&](const std::string& stage, double fraction) {
    const std::lock_guard<std::mutex> lock(shared.mutex);
    shared.stage = stage;
    shared.fraction = fraction;
    shared.is_new = true;
  });
  std::exception_ptr interruption;
  {
    const nb::gil_scoped_release unlocked;
    const SleepingTeam asleep;
    std::thread thread([&] {
      set_default_rounding();
      const CancelScope scope(progress);
      std::exception_ptr failure;
      try {
        work(progress);
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard<std::mutex> lock(shared.mutex);
      shared.failure = failure;
      shared.is_done = true;
      shared.changed.notify_one();
    });
    for (;;) {
      {
        std::unique_lock<std::mutex> lock(shared.mutex);
        if (shared.changed.wait_for(lock, std::chrono::milliseconds(20), [&] { return shared.is_done; })) break;
      }
      if (interruption) continue;
      const nb::gil_scoped_acquire locked;
      try {
        tell_python(listener, shared);
      } catch (...) {
        interruption = std::current_exception();
        progress.request_cancel();
      }
    }
    thread.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (shared.failure) std::rethrow_exception(shared.failure);
  tell_python(listener, shared);
}

}  // namespace espdiff::python
