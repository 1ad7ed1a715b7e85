// select_engine.h: chooses the back end, once per job.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace espdiff {

enum class DeviceChoice { kAuto, kCpu, kCuda };

/// A back end, and which of several GPUs.
struct DeviceRequest {
  // Not explicit: mostly the back end alone is asked for.
  DeviceRequest(DeviceChoice which, int gpu = 0) : choice(which), index(gpu) {}

  DeviceChoice choice;
  int index;  ///< of the GPU; for DeviceChoice::kCuda only
};
inline bool operator==(const DeviceRequest& a, const DeviceRequest& b) {
  return a.choice == b.choice && a.index == b.index;
}

/// @throws InputError for anything but auto, cpu, cuda, cuda:N
DeviceRequest parse_device(const std::string& text);

/// What selecting would do, for `doctor`.
struct BackEndStatus {
  std::string name;  ///< "cpu", "cuda", or "cuda:1"
  bool available = false;
  std::string description;  ///< the device, or why there is none and the remedy
};
/// More threads than any machine has cores only cost time, and the runtime's own limit ends the process.
constexpr int kMostThreads = 1024;
/// @throws InputError unless the number is 0 (all) to kMostThreads
void check_threads(long long n_threads);

/// CPU threads where none are asked for: what OMP_NUM_THREADS says, as batch systems set it, else all cores that the
/// process may run on.
int available_threads();
BackEndStatus cpu_status();
/// What select_engine() would take.
/// @throws DeviceError as select_engine()
BackEndStatus device_status(const DeviceRequest& device);
/// Of the GPU that `cuda` takes: the first.
BackEndStatus cuda_status();
/// Of all GPUs that answer, "cuda:0" and so on.
std::vector<BackEndStatus> cuda_devices();
/// Of the Fourier transforms that PME potentials need there.
BackEndStatus cpu_fourier_status();
BackEndStatus cuda_fourier_status();

/// Makes an engine.
/// @param n_threads CPU threads; 0 takes available_threads(). A device ignores it.
/// @throws DeviceError when the GPU that was asked for is not there or does not work; InputError as
/// check_threads()
std::unique_ptr<Engine> select_engine(const DeviceRequest& device, int n_threads);

}  // namespace espdiff
