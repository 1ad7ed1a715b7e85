// cuda_errors.h: what the CUDA runtime reports, in words that say what to do.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>

namespace espdiff::ESPDIFF_BACKEND {

/// What an error's message is made of; what is unknown stays 0 or empty.
struct CudaFacts {
  std::string device;  ///< "cuda:0 (NVIDIA H200)"
  int capability = 0;  ///< ten times the major number and the minor one: 90
  std::size_t asked_bytes = 0, free_bytes = 0, total_bytes = 0;
  int driver_version = 0;  ///< the newest CUDA that the driver supports, 13000 for 13.0; 0 where there is no driver
  int runtime_version = CUDART_VERSION;
  std::string architectures;  ///< that this build has code for, as CMAKE_CUDA_ARCHITECTURES says it, by ; or ,
};

/// Throws MemoryError where memory ran out, else DeviceError: what was being done, what failed, and the remedy.
/// @param doing such as "sorting"
[[noreturn]] void throw_cuda_error(cudaError_t status, const std::string& doing, const CudaFacts& facts);

/// Throws as throw_cuda_error() unless the call succeeded, with the facts of the engine that runs on this thread. Takes
/// the error out of the runtime's memory, so that nobody else in the process is told of it.
void check_cuda(cudaError_t status, const char* doing);

/// "compute capability 7.5, 8.0 and 12.0 or later" from "75-real;80-real;120".
std::string architectures_in_words(const std::string& architectures);

/// Whether a build for these architectures runs on a GPU: machine code of the same major number that is not newer, or
/// intermediate code that is not newer. True for names that are not numbers ("native").
bool has_code_for(const std::string& architectures, int capability);

}  // namespace espdiff::ESPDIFF_BACKEND
