// cuda_errors.cpp: messages for errors of the CUDA runtime, passed in directly; needs no GPU.
#include <doctest/doctest.h>

#include "base/error.h"
#include "support/test_data.h"

#if defined(ESPDIFF_HAVE_CUDA)
#include "cuda/device/cuda_errors.h"

using espdiff::ErrorClass;
using namespace espdiff::cuda_backend;

namespace {

CudaFacts facts_of(const char* architectures, int capability) {
  CudaFacts facts;
  facts.device = "cuda:1 (NVIDIA Test)";
  facts.capability = capability;
  facts.driver_version = 13000;
  facts.runtime_version = 13000;
  facts.architectures = architectures;
  return facts;
}

/// The message, after checking the error's class.
std::string words_for(cudaError_t status, ErrorClass expected, const CudaFacts& facts) {
  try {
    throw_cuda_error(status, "computing", facts);
  } catch (const espdiff::Error& error) {
    CHECK(error.error_class() == expected);
    return error.what();
  }
}

}  // namespace

TEST_SUITE_BEGIN("cuda errors");

TEST_CASE("a missing driver and one that is too old give different messages, with the version needed") {
  CudaFacts facts = facts_of("75-real;120", 0);
  facts.driver_version = 0;
  CHECK(words_for(cudaErrorInsufficientDriver, ErrorClass::kDevice, facts) ==
        "no NVIDIA driver is installed, or it cannot be loaded; install one that supports CUDA 13.0 (580 or newer), or "
        "use "
        "device cpu");
  facts.driver_version = 12040;
  CHECK(words_for(cudaErrorInsufficientDriver, ErrorClass::kDevice, facts) ==
        "the NVIDIA driver supports CUDA 12.4, this build needs CUDA 13.0 (580 or newer); update the driver, build "
        "with an "
        "older CUDA toolkit, or use device cpu");
}

TEST_CASE("no GPU") {
  CHECK(words_for(cudaErrorNoDevice, ErrorClass::kDevice, {}) == "no NVIDIA GPU was found; use device cpu");
}

TEST_CASE("running out of memory is a memory error that says how much was requested, what is free, and the remedy") {
  CudaFacts facts = facts_of("90", 90);
  facts.asked_bytes = std::size_t{3} << 29;
  facts.free_bytes = std::size_t{1} << 30;
  facts.total_bytes = std::size_t{8} << 30;
  CHECK(words_for(cudaErrorMemoryAllocation, ErrorClass::kMemory, facts) ==
        "cuda:1 (NVIDIA Test) has no room for another 1.50 GiB (computing): 1.00 GiB of its 8.00 GiB are free; use a "
        "larger "
        "grid spacing or fewer atoms, another GPU (device cuda:N), or device cpu");
  facts.asked_bytes = std::size_t{300} << 20;
  facts.free_bytes = 1 << 19;
  const std::string little = words_for(cudaErrorMemoryAllocation, ErrorClass::kMemory, facts);
  CHECK(little.find("another 300.0 MiB (computing): 0.5 MiB of its 8.00 GiB") != std::string::npos);
  // Seen on a card whose memory another program held: the first kernel could not be loaded.
  facts.asked_bytes = facts.free_bytes = 0;
  CHECK(words_for(cudaErrorMemoryAllocation, ErrorClass::kMemory, facts) ==
        "cuda:1 (NVIDIA Test) is full (computing): 0.0 MiB of its 8.00 GiB are free; end other programs that hold "
        "memory there (nvidia-smi lists them), use another GPU (device cuda:N), or device cpu");
}

TEST_CASE("a GPU without code in this build: the message says which code there is, and how to add it") {
  for (const cudaError_t status : {cudaErrorNoKernelImageForDevice, cudaErrorInvalidDeviceFunction,
                                   cudaErrorUnsupportedPtxVersion, cudaErrorJitCompilerNotFound}) {
    CHECK(words_for(status, ErrorClass::kDevice, facts_of("80-real;90-real", 89)) ==
          "this build has code for compute capability 8.0 and 9.0, none for cuda:1 (NVIDIA Test) of compute capability "
          "8.9; "
          "configure with -DCMAKE_CUDA_ARCHITECTURES=89 and build again, or use device cpu");
  }
  const std::string too_old = words_for(cudaErrorNoKernelImageForDevice, ErrorClass::kDevice, facts_of("90", 61));
  CHECK_MESSAGE(too_old.find("of compute capability 6.1; CUDA 13.0 supports no GPU below 7.5: use device cpu") !=
                    std::string::npos,
                too_old);
}

TEST_CASE("a lost device: the message says what was being done, what failed, and that the process must restart") {
  for (const cudaError_t status :
       {cudaErrorIllegalAddress, cudaErrorLaunchFailure, cudaErrorECCUncorrectable, cudaErrorLaunchTimeout}) {
    const std::string text = words_for(status, ErrorClass::kDevice, facts_of("90", 90));
    CHECK_MESSAGE(
        text.find("cuda:1 (NVIDIA Test) failed while computing (" + std::string(cudaGetErrorName(status))) == 0, text);
    CHECK_MESSAGE(text.find("start again, with device cpu if it recurs") != std::string::npos, text);
  }
}

TEST_CASE("a device in use by others, a runtime that does not start, and other errors") {
  const CudaFacts facts = facts_of("90", 90);
  CHECK(words_for(cudaErrorDevicesUnavailable, ErrorClass::kDevice, facts).find("is in use by another process") !=
        std::string::npos);
  CHECK(words_for(cudaErrorSystemDriverMismatch, ErrorClass::kDevice, facts).find("nvidia-smi") != std::string::npos);
  const std::string other = words_for(cudaErrorInvalidValue, ErrorClass::kDevice, facts);
  CHECK(other.find("cudaErrorInvalidValue") != std::string::npos);
  CHECK(other.find("try device cpu") != std::string::npos);
}

TEST_CASE("every message is one line with a remedy") {
  for (int code = 1; code < 1000; ++code) {
    try {
      throw_cuda_error(static_cast<cudaError_t>(code), "computing", facts_of("90", 90));
    } catch (const espdiff::Error& error) {
      const std::string text = error.what();
      CHECK_MESSAGE(text.find('\n') == std::string::npos, text);
      CHECK_MESSAGE(text.find("device cpu") != std::string::npos, text);
    }
  }
}

TEST_CASE("a call that succeeded throws nothing") { CHECK_NOTHROW(check_cuda(cudaSuccess, "computing")); }

TEST_CASE("the GPUs that a build runs on") {
  const std::string release = "75-real;80-real;86-real;89-real;90-real;100-real;120";
  for (const int capability : {75, 80, 86, 87, 89, 90, 100, 103, 120, 121, 130}) {
    CAPTURE(capability);
    CHECK(has_code_for(release, capability));
  }
  for (const int capability : {52, 61, 70, 72, 110}) {
    CAPTURE(capability);
    CHECK(!has_code_for(release, capability));
  }
  CHECK(has_code_for("90", 120));        // intermediate code is compiled for what came later
  CHECK(!has_code_for("90-real", 100));  // machine code is for its own major number
  CHECK(has_code_for("80-virtual", 86));
  CHECK(!has_code_for("90a", 100));  // tied to one architecture
  CHECK(has_code_for("native", 61));
  CHECK(!has_code_for("", 90));
}

TEST_CASE("architectures in words") {
  CHECK(architectures_in_words("75-real;80-real;120") == "compute capability 7.5, 8.0 and 12.0 or later");
  CHECK(architectures_in_words("75-real,120") == "compute capability 7.5 and 12.0 or later");
  CHECK(architectures_in_words("90") == "compute capability 9.0 or later");
  CHECK(architectures_in_words("native") == "the architectures 'native'");
  CHECK(architectures_in_words("") == "no architecture");
}

TEST_SUITE_END();

#else

TEST_CASE("errors of CUDA") { MESSAGE("SKIPPED: this build has no CUDA back end"); }

#endif
