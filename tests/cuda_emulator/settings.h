// settings.h: how the machine behaves, from the environment variable ESPDIFF_CUDA_EMULATOR, words with commas between
// them.
#pragma once

#include <cstddef>

namespace cuda_emulator {

struct Settings {
  bool check = false;                          ///< "check": each access to memory is examined (memory_checks.h)
  bool pools = true;                           ///< "no-pools": the device has none
  int n_devices = 1;                           ///< "devices=N"
  std::size_t memory = std::size_t{16} << 30;  ///< "memory=MIB": all of a device's
  std::size_t others = 0;                      ///< "others=MIB": of that, what other processes hold
  bool driver = true;                          ///< "no-driver": none is installed
  bool shared = true;                          ///< "exclusive": another process has the device for itself
  bool count = false;                          ///< "count": says at the end what the program asked for
  std::size_t lost = 0;  ///< "lost=N": the device fails at the N-th operation, and at each after that; 0 for never
};

/// Ends the program with a message where a word is not known.
const Settings& settings();

/// Prints what is wrong, and the kernel that runs, and ends the program.
[[noreturn]] void fail(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace cuda_emulator
