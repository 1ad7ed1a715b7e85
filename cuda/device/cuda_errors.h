// cuda_errors.h: messages for errors of the CUDA runtime, each with a remedy.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>

namespace espdiff::ESPDIFF_BACKEND {

/// The facts that an error message needs; unknown ones stay 0 or empty.
struct CudaFacts {
  std::string device;  ///< "cuda:0 (NVIDIA H200)"
  int capability = 0;  ///< 10 * major + minor: 90
  std::size_t asked_bytes = 0, free_bytes = 0, total_bytes = 0;
  int driver_version = 0;  ///< the newest CUDA that the driver supports, 13000 for 13.0; 0 where there is no driver
  int runtime_version = CUDART_VERSION;
  std::string architectures;  ///< that this build has code for, in CMAKE_CUDA_ARCHITECTURES' syntax, separated by ; or
                              ///< ,
};

/// Throws MemoryError if memory ran out, DeviceError otherwise. The message says what was being done, what failed, and
/// the remedy.
/// @param doing a verb phrase such as "sorting"
[[noreturn]] void throw_cuda_error(cudaError_t status, const std::string& doing, const CudaFacts& facts);

/// Throws as throw_cuda_error() unless the call succeeded, with the facts of the engine that runs on this thread.
/// Clears the runtime's last error, so that no other code in the process sees it.
void check_cuda(cudaError_t status, const char* doing);

/// "compute capability 7.5, 8.0 and 12.0 or later" from "75-real;80-real;120".
std::string architectures_in_words(const std::string& architectures);

/// Whether a build for these architectures runs on a GPU. True for machine code of the same major version that is not
/// newer, for PTX that is not newer, and for names that are not numbers ("native").
bool has_code_for(const std::string& architectures, int capability);

}  // namespace espdiff::ESPDIFF_BACKEND
