// thread_block.h: what the threads of a block do with each other. Each is a fiber that runs until it must wait.
#pragma once

#include <cstdint>

#include "kernel.h"

namespace cuda_emulator {

/// Waits for all threads of the block that have not ended. id: one of 16 barriers.
void barrier(Thread* thread, std::uint32_t id);
/// The same at barrier 0; of the threads' values, whether any or all are true, and how many.
bool barrier_or(Thread* thread, bool value);
bool barrier_and(Thread* thread, bool value);
std::uint32_t barrier_popc(Thread* thread, bool value);

// Within a warp; mask has a bit for each lane that takes part, and each of these must come.

void warp_barrier(Thread* thread, std::uint32_t mask);
std::uint32_t vote_ballot(Thread* thread, bool value, std::uint32_t mask);
bool vote_any(Thread* thread, bool value, std::uint32_t mask);
bool vote_all(Thread* thread, bool value, std::uint32_t mask);
/// The lanes whose value is the same.
std::uint32_t match_any(Thread* thread, std::uint64_t value, std::uint32_t mask);

enum class Shuffle { kIndex, kUp, kDown, kButterfly };
struct Shuffled {
  std::uint32_t value;
  bool in_range;
};
/// Another lane's value; step and clamp as the instruction has them.
Shuffled shuffle(Thread* thread, Shuffle mode, std::uint32_t value, std::uint32_t step, std::uint32_t clamp,
                 std::uint32_t mask);

/// For a thread that waits for another one's store.
void let_others_run(Thread* thread);

}  // namespace cuda_emulator
