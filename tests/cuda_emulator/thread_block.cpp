// thread_block.cpp: runs grids: threads that meet are fibers, switched by hand; others run one after the other.
#include "thread_block.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

#include "device_memory.h"
#include "memory_checks.h"
#include "settings.h"

#if !defined(__x86_64__)
#error "the fibers' switch is written for x86-64"
#endif

// Keeps what a function must keep on the stack, and continues where another fiber did the same.
extern "C" void cuda_emulator_switch(void** stack_before, void* stack);
asm(R"(
.text
.type cuda_emulator_switch, @function
cuda_emulator_switch:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  ret
.size cuda_emulator_switch, .-cuda_emulator_switch
)");

namespace cuda_emulator {
namespace {

constexpr std::size_t kStackBytes = 64 << 10;
constexpr std::size_t kSharedBytes = 228 << 10;
constexpr unsigned kWarp = 32, kBarriers = 16;

enum class State { kReady, kYielded, kInWarp, kAtBarrier, kEnded };
enum class WarpOperation { kBarrier, kBallot, kMatch, kShuffle };

struct Fiber {
  Thread thread;
  void* stack_pointer = nullptr;
  State state = State::kEnded;
  std::uint32_t barrier = 0;
  WarpOperation operation = WarpOperation::kBarrier;
  Shuffle shuffle = Shuffle::kIndex;
  std::uint32_t mask = 0, step = 0, clamp = 0;
  std::uint64_t value = 0;
  std::uint32_t result = 0;
  bool in_range = false;
};

const Kernel* running = nullptr;
std::vector<Fiber> fibers;
std::vector<char*> stacks;
Fiber* current = nullptr;
void* scheduler_stack = nullptr;
void** kernel_parameters = nullptr;

void* reserve_stack() {
  void* const stack =
      mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (stack == MAP_FAILED) fail("no memory for a thread's stack");
  return stack;
}

void leave() { cuda_emulator_switch(&current->stack_pointer, scheduler_stack); }

void run_current() {
  running->run(&current->thread, nullptr, kernel_parameters);
  current->state = State::kEnded;
  leave();
}

/// Makes a fiber begin with run_current.
void start(Fiber& fiber, char* stack) {
  void** top = reinterpret_cast<void**>(stack + kStackBytes - 64);
  *--top = nullptr;  // where run_current would return to
  *--top = reinterpret_cast<void*>(run_current);
  for (int i = 0; i < 6; ++i) *--top = nullptr;  // the registers that cuda_emulator_switch takes
  fiber.stack_pointer = top;
  fiber.state = State::kReady;
}

Fiber& wait_in_warp(WarpOperation operation, std::uint32_t mask, std::uint64_t value) {
  Fiber& fiber = *current;
  if ((mask >> fiber.thread.lane() & 1U) == 0)
    fail("lane %u is not in the mask %x that it gives", fiber.thread.lane(), mask);
  fiber.operation = operation;
  fiber.mask = mask;
  fiber.value = value;
  fiber.state = State::kInWarp;
  leave();
  return fiber;
}

std::uint32_t wait_at_barrier(std::uint32_t id, bool value) {
  Fiber& fiber = *current;
  fiber.barrier = id;
  fiber.value = value ? 1 : 0;
  fiber.state = State::kAtBarrier;
  leave();
  return fiber.result;
}

void shuffle_lane(const Fiber* warp, std::uint32_t lanes, int lane, Fiber& fiber) {
  const int segment = static_cast<int>(fiber.clamp >> 8 & 31U), clamp = static_cast<int>(fiber.clamp & 31U);
  const int step = static_cast<int>(fiber.step & 31U);
  const int first = lane & segment, last = first | (clamp & ~segment);
  int from = lane;
  switch (fiber.shuffle) {
    case Shuffle::kUp:
      from = lane - step;
      fiber.in_range = from >= last;
      break;
    case Shuffle::kDown:
      from = lane + step;
      fiber.in_range = from <= last;
      break;
    case Shuffle::kButterfly:
      from = lane ^ step;
      fiber.in_range = from <= last;
      break;
    case Shuffle::kIndex:
      from = first | (step & ~segment);
      fiber.in_range = from <= last;
      break;
  }
  if (!fiber.in_range) from = lane;
  if ((lanes >> from & 1U) == 0) fail("lane %d takes the value of lane %d, which does not take part", lane, from);
  fiber.result = static_cast<std::uint32_t>(warp[from].value);
}

/// Ends the operations of a warp for which all lanes have come; returns whether there was one.
bool end_warp_operations(Fiber* warp, unsigned n) {
  bool ended = false;
  for (unsigned i = 0; i < n; ++i) {
    if (warp[i].state != State::kInWarp) continue;
    const std::uint32_t mask = warp[i].mask;
    std::uint32_t lanes = 0, ballot = 0;
    bool complete = true;
    for (unsigned j = 0; j < n && complete; ++j) {
      if ((mask >> j & 1U) == 0 || warp[j].state == State::kEnded) continue;
      complete = warp[j].state == State::kInWarp && warp[j].mask == mask;
      if (complete && warp[j].operation != warp[i].operation)
        fail("lanes %u and %u of a warp are at different operations", i, j);
      lanes |= 1U << j;
      if (warp[j].value != 0) ballot |= 1U << j;
    }
    if (!complete) continue;
    for (unsigned j = 0; j < n; ++j) {
      if ((lanes >> j & 1U) == 0) continue;
      Fiber& fiber = warp[j];
      fiber.result = ballot;
      if (fiber.operation == WarpOperation::kShuffle) shuffle_lane(warp, lanes, static_cast<int>(j), fiber);
      if (fiber.operation == WarpOperation::kMatch) {
        fiber.result = 0;
        for (unsigned k = 0; k < n; ++k)
          if ((lanes >> k & 1U) != 0 && warp[k].value == fiber.value) fiber.result |= 1U << k;
      }
    }
    for (unsigned j = 0; j < n; ++j)
      if ((lanes >> j & 1U) != 0) warp[j].state = State::kReady;
    ended = true;
  }
  return ended;
}

/// Lets go the barriers at which all threads are that have not ended.
bool end_barriers(unsigned n) {
  unsigned waiting[kBarriers] = {}, counts[kBarriers] = {}, n_alive = 0;
  for (unsigned i = 0; i < n; ++i) {
    n_alive += fibers[i].state != State::kEnded ? 1 : 0;
    if (fibers[i].state != State::kAtBarrier) continue;
    ++waiting[fibers[i].barrier % kBarriers];
    counts[fibers[i].barrier % kBarriers] += static_cast<unsigned>(fibers[i].value);
  }
  bool ended = false;
  for (unsigned id = 0; id < kBarriers; ++id) {
    if (waiting[id] == 0 || waiting[id] < n_alive) continue;
    for (unsigned i = 0; i < n; ++i) {
      if (fibers[i].state != State::kAtBarrier) continue;
      fibers[i].result = counts[id];
      fibers[i].state = State::kReady;
    }
    ended = true;
  }
  return ended;
}

/// Runs the lanes of a warp as far as they go without the other warps; returns whether any ran.
bool run_warp(Fiber* warp, unsigned n) {
  bool ran = false;
  do {
    for (unsigned k = 0; k < n; ++k) {
      Fiber& fiber = warp[k];
      if (fiber.state != State::kReady) continue;
      current = &fiber;
      cuda_emulator_switch(&scheduler_stack, fiber.stack_pointer);
      ran = true;
    }
  } while (end_warp_operations(warp, n));
  for (unsigned i = 0; i < n; ++i) {
    if (warp[i].state != State::kYielded) continue;
    warp[i].state = State::kReady;
    ran = true;
  }
  return ran;
}

void run_fibers(unsigned n) {
  for (unsigned i = 0; i < n; ++i) {
    if (stacks.size() <= i) stacks.push_back(static_cast<char*>(reserve_stack()));
    start(fibers[i], stacks[i]);
  }
  const unsigned n_warps = (n + kWarp - 1) / kWarp;
  for (;;) {
    bool ran = false;
    for (unsigned k = 0; k < n_warps; ++k) {
      const unsigned first = k * kWarp;
      ran |= run_warp(&fibers[first], std::min(kWarp, n - first));
    }
    const auto end = fibers.begin() + n;
    if (std::all_of(fibers.begin(), end, [](const Fiber& fiber) { return fiber.state == State::kEnded; })) return;
    if (!end_barriers(n) && !ran) fail("a block's threads wait for each other for ever: not all come to a barrier");
  }
}

std::map<std::string, Kernel>& table() {
  static std::map<std::string, Kernel> kernels;
  return kernels;
}

}  // namespace

Registered::Registered(Kernel kernel) { table().emplace(kernel.name, std::move(kernel)); }

const Kernel* find_kernel(const std::string& name) {
  const auto found = table().find(name);
  return found == table().end() ? nullptr : &found->second;
}

const Kernel* running_kernel() { return running; }

void run_grid(const Kernel& kernel, Index3 grid, Index3 block, std::uint32_t dynamic_shared_bytes, void** parameters) {
  static const std::unique_ptr<char[]> shared(new (std::align_val_t(1024)) char[kSharedBytes]);
  const unsigned n = block.x * block.y * block.z;
  const std::uint64_t n_blocks = std::uint64_t{grid.x} * grid.y * grid.z;
  running = &kernel;
  kernel_parameters = parameters;
  if (fibers.size() < n) fibers.resize(n);
  if (checking) begin_launch(!kernel.meets_others);
  for (std::uint64_t b = 0; b < n_blocks; ++b) {
    std::memset(shared.get(), kNewMemory,
                std::min<std::size_t>(kernel.shared_bytes + dynamic_shared_bytes + 128, kSharedBytes));
    Thread thread;
    thread.block_size = block;
    thread.grid_size = grid;
    thread.block = {static_cast<std::uint32_t>(b % grid.x), static_cast<std::uint32_t>(b / grid.x % grid.y),
                    static_cast<std::uint32_t>(b / grid.x / grid.y)};
    thread.dynamic_shared_bytes = dynamic_shared_bytes;
    thread.shared = shared.get();
    for (unsigned i = 0; i < n; ++i) {
      thread.index = i;
      thread.thread = {i % block.x, i / block.x % block.y, i / (block.x * block.y)};
      if (kernel.meets_others) {
        fibers[i].thread = thread;
        continue;
      }
      if (checking) begin_thread(b * n + i);
      kernel.run(&thread, nullptr, parameters);
    }
    if (kernel.meets_others) run_fibers(n);
  }
  running = nullptr;
}

void barrier(Thread*, std::uint32_t id) { wait_at_barrier(id, false); }
bool barrier_or(Thread*, bool value) { return wait_at_barrier(0, value) != 0; }
bool barrier_and(Thread*, bool value) { return wait_at_barrier(0, !value) == 0; }
std::uint32_t barrier_popc(Thread*, bool value) { return wait_at_barrier(0, value); }

void warp_barrier(Thread*, std::uint32_t mask) { wait_in_warp(WarpOperation::kBarrier, mask, 0); }
std::uint32_t vote_ballot(Thread*, bool value, std::uint32_t mask) {
  return wait_in_warp(WarpOperation::kBallot, mask, value ? 1 : 0).result;
}
bool vote_any(Thread* thread, bool value, std::uint32_t mask) { return vote_ballot(thread, value, mask) != 0; }
bool vote_all(Thread* thread, bool value, std::uint32_t mask) { return vote_ballot(thread, !value, mask) == 0; }
std::uint32_t match_any(Thread*, std::uint64_t value, std::uint32_t mask) {
  return wait_in_warp(WarpOperation::kMatch, mask, value).result;
}

Shuffled shuffle(Thread*, Shuffle mode, std::uint32_t value, std::uint32_t step, std::uint32_t clamp,
                 std::uint32_t mask) {
  current->shuffle = mode;
  current->step = step;
  current->clamp = clamp;
  const Fiber& fiber = wait_in_warp(WarpOperation::kShuffle, mask, value);
  return {fiber.result, fiber.in_range};
}

void let_others_run(Thread*) {
  current->state = State::kYielded;
  leave();
}

}  // namespace cuda_emulator
