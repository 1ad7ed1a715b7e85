// make_engine.h: the entry point of each compiled back end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/message.h"

namespace espdiff {

namespace cpu_backend {
std::unique_ptr<Engine> make_engine(int n_threads);
/// Whether potentials can be computed; returns the Fourier transform library, or why there is none and the remedy.
Message probe_fourier(bool* available);
}  // namespace cpu_backend

namespace cuda_backend {
/// @param device its index
/// @throws DeviceError if it does not work
std::unique_ptr<Engine> make_engine(int device);

/// Facts about a GPU before it is used.
struct CudaDeviceStatus {
  bool usable;          ///< this build has code for it
  Message description;  ///< name, compute capability, memory; or why it cannot be used and the remedy
};
/// The GPUs that respond, by index; if there are none, the reason and the remedy. Starts no work on them.
std::vector<CudaDeviceStatus> probe_devices(Message* why_none);
Message probe_fourier(bool* available);
}  // namespace cuda_backend

}  // namespace espdiff
