// kernel.h: a translated kernel, the table of all, and what a thread of one knows of itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cuda_emulator {

struct Index3 {
  std::uint32_t x = 1, y = 1, z = 1;
};

/// A CUDA thread while its kernel runs.
struct Thread {
  Index3 thread, block_size, block, grid_size;  ///< %tid, %ntid, %ctaid, %nctaid
  std::uint32_t index = 0;                      ///< in its block
  std::uint32_t dynamic_shared_bytes = 0;
  char* shared = nullptr;  ///< the block's shared memory

  std::uint32_t lane() const { return index % 32; }
};

struct Kernel {
  std::string name;  ///< as the compiler has it
  void (*run)(Thread* thread, void* result, void** parameters);
  bool meets_others;  ///< has barriers, or exchanges values in a warp
  std::uint32_t shared_bytes;
  std::uint32_t max_threads;
  std::vector<std::uint32_t> parameter_bytes;
};

/// Puts a kernel into the table; made before main, by what translate_ptx.py writes.
struct Registered {
  explicit Registered(Kernel kernel);
};

/// Null where none has that name.
const Kernel* find_kernel(const std::string& name);

/// Runs all blocks of a grid, each with all its threads. parameters[i] points to the i-th parameter.
void run_grid(const Kernel& kernel, Index3 grid, Index3 block, std::uint32_t dynamic_shared_bytes, void** parameters);

/// The kernel that runs now, or null.
const Kernel* running_kernel();

}  // namespace cuda_emulator
