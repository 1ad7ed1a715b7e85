// select_engine.h: chooses the back end, once per job.
#pragma once

#include <memory>
#include <string>

#include "engine/engine.h"

namespace espdiff {

enum class DeviceChoice { kAuto, kCpu, kCuda };

/// @throws InputError for anything but auto, cpu, cuda
DeviceChoice parse_device_choice(const std::string& text);

/// What selecting would do, for `doctor`.
struct BackEndStatus {
  std::string name;  ///< "cpu" or "cuda"
  bool available = false;
  std::string description;  ///< the device, or why there is none and the remedy
};
BackEndStatus cpu_status();
BackEndStatus cuda_status();
/// Of the Fourier transforms that PME potentials need there.
BackEndStatus cpu_fourier_status();
BackEndStatus cuda_fourier_status();

/// Makes an engine.
/// @param n_threads CPU threads; 0 takes as many as the machine offers. A device ignores it.
/// @throws DeviceError when an explicit cuda is not available; InputError when n_threads is negative
std::unique_ptr<Engine> select_engine(DeviceChoice choice, int n_threads);

}  // namespace espdiff
