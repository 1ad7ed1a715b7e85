// select_engine.h: chooses the back end, once per job.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/message.h"
#include "base/text/option_row.h"

namespace espdiff {

enum class DeviceChoice { kAuto, kCpu, kCuda };

/// A back end, and the index of a GPU.
struct DeviceRequest {
  // Not explicit, because most callers name the back end only.
  DeviceRequest(DeviceChoice which, int gpu = 0) : choice(which), index(gpu) {}

  DeviceChoice choice;
  int index;  ///< of the GPU; for DeviceChoice::kCuda only
};
inline bool operator==(const DeviceRequest& a, const DeviceRequest& b) {
  return a.choice == b.choice && a.index == b.index;
}

/// @throws InputError unless the text is auto, cpu, cuda or cuda:N
DeviceRequest parse_device(const std::string& text);

/// The result that selecting would have, for `doctor`.
struct BackEndStatus {
  std::string name;  ///< "cpu", "cuda", or "cuda:1"
  bool available = false;
  Message description;  ///< the device, or the reason for none and the remedy
};
/// More threads than any machine has cores only cost time, and the runtime's own limit ends the process.
constexpr int kMostThreads = 1024;

/// Where something is computed.
struct ComputingOptions {
  std::string device = "auto";  ///< as parse_device() reads it
  int threads = 0;              ///< of the CPU; 0 means available_threads()
};
/// The options of every command that computes.
const std::vector<OptionRow<ComputingOptions>>& computing_settings();

/// Default number of CPU threads: OMP_NUM_THREADS, which batch systems set, otherwise all cores available to the
/// process.
int available_threads();
BackEndStatus cpu_status();
/// The device that select_engine() would choose.
/// @throws DeviceError as select_engine()
BackEndStatus device_status(const DeviceRequest& device);
/// Status of the GPU that `cuda` chooses: the first.
BackEndStatus cuda_status();
/// Status of all GPUs that respond: "cuda:0" and so on.
std::vector<BackEndStatus> cuda_devices();
/// Status of the CPU's Fourier transforms, which PME potentials need.
BackEndStatus cpu_fourier_status();
BackEndStatus cuda_fourier_status();

/// Makes an engine.
/// @param n_threads CPU threads; 0 means available_threads(). A GPU ignores it.
/// @throws DeviceError if the requested GPU is absent or does not work; InputError for more than kMostThreads
std::unique_ptr<Engine> select_engine(const DeviceRequest& device, int n_threads);
std::unique_ptr<Engine> select_engine(const ComputingOptions& options);

}  // namespace espdiff
