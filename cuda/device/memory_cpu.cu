// memory_cpu.cu: the CPU back end's memory is the heap.
#include <cstring>
#include <new>

#include "base/memory.h"
#include "cuda/device/memory.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::align_val_t kAlignment{64};

}  // namespace

MemoryBlock::MemoryBlock(std::size_t n_bytes) : start_(n_bytes > 0 ? ::operator new(n_bytes, kAlignment) : nullptr) {
#if defined(ESPDIFF_POISON_MEMORY)
  // All ones is NaN in every precision and an index out of every range, so a stage that reads uninitialized memory
  // fails.
  if (n_bytes > 0) std::memset(start_, 0xFF, n_bytes);
#endif
}

MemoryBlock::~MemoryBlock() { ::operator delete(start_, kAlignment); }

void copy_to_device(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes > 0) std::memcpy(to, from, n_bytes);
}
void copy_to_host(void* to, const void* from, std::size_t n_bytes) { copy_to_device(to, from, n_bytes); }
HostReads::HostReads() = default;
void HostReads::add(void* to, const void* from, std::size_t n_bytes) { copy_to_device(to, from, n_bytes); }
void HostReads::wait() {}
void copy_on_device(void* to, const void* from, std::size_t n_bytes) { copy_to_device(to, from, n_bytes); }

double available_bytes() { return available_memory(); }

}  // namespace espdiff::ESPDIFF_BACKEND
