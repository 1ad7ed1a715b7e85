// device_memory.cpp: a file in memory, mapped twice; allocations with red zones around them.
#include "device_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <map>

#include "memory_checks.h"
#include "settings.h"

namespace cuda_emulator {

char* device_begin = nullptr;
std::size_t device_size = 0;
std::ptrdiff_t to_view = 0;

namespace {

constexpr std::size_t kGranularity = 512;
constexpr unsigned char kCanary = 0xCB;

/// Says what happened where a device pointer was followed; any other fault goes its way.
void on_fault(int signal, siginfo_t* fault, void*) {
  if (on_device(fault->si_addr)) fail("the host follows a device pointer");
  std::signal(signal, SIG_DFL);
}

struct Allocation {
  std::size_t asked, taken;  ///< bytes; taken includes both red zones
};

struct Device {
  std::map<char*, Allocation> allocations;
  std::multimap<std::size_t, char*> free_domains;  ///< size: where its first red zone begins
  char* untouched = nullptr;                       ///< from here on nothing was ever allocated
  std::size_t n_bytes = 0;

  Device() {
    const int file = memfd_create("emulated device memory", 0);
    device_size = settings().memory;
    if (file < 0 || ftruncate(file, static_cast<off_t>(device_size)) != 0) fail("no memory of %zu bytes", device_size);
    void* const pointers = mmap(nullptr, device_size, PROT_NONE, MAP_SHARED | MAP_NORESERVE, file, 0);
    void* const seen = mmap(nullptr, device_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, file, 0);
    if (pointers == MAP_FAILED || seen == MAP_FAILED) fail("no addresses for %zu bytes", device_size);
    close(file);
    device_begin = static_cast<char*>(pointers);
    to_view = static_cast<char*>(seen) - device_begin;
    untouched = device_begin;
    struct sigaction action = {};
    action.sa_sigaction = on_fault;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &action, nullptr);
  }
};

Device& device() {
  static Device made;
  return made;
}

}  // namespace

char* allocate(std::size_t n_bytes) {
  Device& d = device();
  std::size_t taken = (n_bytes + kGranularity - 1) / kGranularity * kGranularity + 2 * kRedZone;
  char* start = nullptr;
  const auto piece = d.free_domains.lower_bound(taken);
  if (piece != d.free_domains.end() && piece->first <= 2 * taken) {
    taken = piece->first;
    start = piece->second;
    d.free_domains.erase(piece);
  } else {
    const std::size_t given = static_cast<std::size_t>(d.untouched - device_begin);
    if (given + taken + settings().others > device_size) return nullptr;
    start = d.untouched;
    d.untouched += taken;
  }
  std::memset(view(start), kCanary, taken);
  std::memset(view(start) + kRedZone, kNewMemory, n_bytes);
  mark_allocated(start + kRedZone, n_bytes);
  d.allocations[start + kRedZone] = {n_bytes, taken};
  d.n_bytes += n_bytes;
  return start + kRedZone;
}

void release(char* start) {
  Device& d = device();
  const auto found = d.allocations.find(start);
  if (found == d.allocations.end()) fail("memory is released that is not allocated");
  const Allocation it = found->second;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(view(start));
  for (std::size_t i = 1; i <= kRedZone; ++i)
    if (bytes[-static_cast<std::ptrdiff_t>(i)] != kCanary)
      fail("something wrote %zu bytes before an allocation of %zu bytes", i, it.asked);
  for (std::size_t i = it.asked; i < it.taken - kRedZone; ++i)
    if (bytes[i] != kCanary)
      fail("something wrote %zu bytes behind the end of an allocation of %zu bytes", i - it.asked, it.asked);
  std::memset(view(start), kCanary, it.asked);
  mark_released(start, it.asked);
  d.allocations.erase(found);
  d.free_domains.emplace(it.taken, start - kRedZone);
  d.n_bytes -= it.asked;
}

bool allocated(const void* start, std::size_t n_bytes) {
  if (!on_device(start)) return !on_device(static_cast<const char*>(start) + n_bytes);
  const auto& all = device().allocations;
  auto after = all.upper_bound(const_cast<char*>(static_cast<const char*>(start)));
  if (after == all.begin()) return false;
  --after;
  return static_cast<const char*>(start) + n_bytes <= after->first + after->second.asked;
}

std::size_t allocated_bytes() { return device().n_bytes; }

}  // namespace cuda_emulator
