// memory_checks.cpp: what is known of each byte, and what was found.
#include "memory_checks.h"

#include <sys/mman.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "device_memory.h"
#include "kernel.h"
#include "settings.h"

namespace cuda_emulator {

bool checking = false;

namespace {

enum State : unsigned char { kNotAllocated, kAllocated, kWritten };

/// Who touched a byte in the launch that is named.
struct Touched {
  std::uint32_t launch, writer, reader;  ///< threads' numbers from 1; 0: none
};
constexpr std::uint32_t kSeveral = UINT32_MAX;

State* states = nullptr;
Touched* touched = nullptr;
std::uint32_t launch = 0, thread = 0;
bool look_for_races = false;

/// Memory that costs nothing until it is touched, zeros at first.
void* reserve(std::size_t n_bytes) {
  void* const start =
      mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) fail("no addresses for the checks' %zu bytes", n_bytes);
  return start;
}

struct Findings {
  std::map<std::string, std::size_t> counts;
  ~Findings() {
    if (counts.empty()) return;
    std::fflush(nullptr);
    for (const auto& [text, n] : counts) std::fprintf(stderr, "cuda_emulator: %zu x %s\n", n, text.c_str());
    std::_Exit(3);
  }
};

void find(const char* what) {
  static Findings findings;
  const Kernel* const kernel = running_kernel();
  const std::string text = std::string(what) + (kernel != nullptr ? " in kernel " + kernel->name : " by the host");
  if (findings.counts[text]++ == 0) std::fprintf(stderr, "cuda_emulator: %s, thread %u\n", text.c_str(), thread - 1);
}

bool aligned(const char* place, std::size_t n_bytes) { return reinterpret_cast<std::uintptr_t>(place) % n_bytes == 0; }

Touched& touched_now(std::size_t i) {
  if (touched[i].launch != launch) touched[i] = {launch, 0, 0};
  return touched[i];
}

}  // namespace

void note_load(const char* place, std::size_t n_bytes, bool strong) {
  if (!aligned(place, n_bytes)) find("load that is not aligned");
  if (!on_device(place)) return;
  for (std::size_t i = static_cast<std::size_t>(place - device_begin), end = i + n_bytes; i < end; ++i) {
    if (states[i] == kNotAllocated) return find("load out of bounds");
    if (states[i] == kAllocated) {
      states[i] = kWritten;  // said once
      return find("load of what was never written");
    }
    if (!look_for_races || strong) continue;
    Touched& byte = touched_now(i);
    if (byte.writer != 0 && byte.writer != thread) return find("race: load of what another thread stores");
    byte.reader = byte.reader == 0 || byte.reader == thread ? thread : kSeveral;
  }
}

void note_store(const char* place, std::size_t n_bytes, const void* value, bool strong) {
  if (!aligned(place, n_bytes)) find("store that is not aligned");
  if (!on_device(place)) return;
  const std::size_t begin = static_cast<std::size_t>(place - device_begin);
  for (std::size_t i = begin; i < begin + n_bytes; ++i) {
    if (states[i] == kNotAllocated) return find("store out of bounds");
    states[i] = kWritten;
    if (!look_for_races || strong) continue;
    Touched& byte = touched_now(i);
    if (byte.writer != 0 && byte.writer != thread &&
        *view(device_begin + i) != static_cast<const char*>(value)[i - begin])
      return find("race: store of another value than another thread's");
    if (byte.reader != 0 && byte.reader != thread) return find("race: store of what another thread loads");
    byte.writer = thread;
  }
}

void begin_launch(bool races) {
  ++launch;
  look_for_races = races;
}

void begin_thread(std::uint64_t number) { thread = static_cast<std::uint32_t>(number) + 1; }

void mark_allocated(const char* start, std::size_t n_bytes) {
  if (!settings().check) return;
  if (states == nullptr) {
    states = static_cast<State*>(reserve(device_size));
    touched = static_cast<Touched*>(reserve(device_size * sizeof(Touched)));
    checking = true;
  }
  std::memset(states + (start - device_begin), kAllocated, n_bytes);
}

void mark_released(const char* start, std::size_t n_bytes) {
  if (checking) std::memset(states + (start - device_begin), kNotAllocated, n_bytes);
}

void mark_written(const void* start, std::size_t n_bytes) {
  if (checking && on_device(start))
    std::memset(states + (static_cast<const char*>(start) - device_begin), kWritten, n_bytes);
}

void mark_copied(const void* to, const void* from, std::size_t n_bytes) {
  if (!checking) return;
  const State* const source = on_device(from) ? states + (static_cast<const char*>(from) - device_begin) : nullptr;
  if (source == nullptr) return mark_written(to, n_bytes);
  if (on_device(to)) {
    std::memmove(states + (static_cast<const char*>(to) - device_begin), source, n_bytes);
  } else if (std::memchr(source, kAllocated, n_bytes) != nullptr) {
    find("copy to the host of what was never written");
  }
}

}  // namespace cuda_emulator
