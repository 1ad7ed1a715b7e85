// cuda_errors.cu: turns errors of the CUDA runtime into messages. Host code only; tests pass it errors directly.
#include "cuda/device/cuda_errors.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/device/cuda_context.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The oldest compute capability that this toolkit supports.
constexpr int kOldestCapability = CUDART_VERSION >= 13000 ? 75 : 50;

std::string dotted(int capability) { return std::to_string(capability / 10) + "." + std::to_string(capability % 10); }
std::string cuda_version(int version) {
  return "CUDA " + std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}
std::string memory_text(std::size_t bytes) {
  constexpr double kMebi = 1048576.0, kGibi = 1073741824.0;
  const double n = static_cast<double>(bytes);
  return n < kGibi ? formatted("%.1f MiB", n / kMebi) : formatted("%.2f GiB", n / kGibi);
}

/// One entry of CMAKE_CUDA_ARCHITECTURES.
struct Architecture {
  int capability = 0;                             ///< 0 if not a number
  bool machine_code = true, intermediate = true;  ///< the latter is PTX
};

std::vector<Architecture> parse(const std::string& architectures) {
  std::vector<Architecture> all;
  std::string separated = architectures;
  std::replace(separated.begin(), separated.end(), ',', ';');
  std::istringstream entries(separated);
  for (std::string entry; std::getline(entries, entry, ';');) {
    Architecture a;
    std::size_t n = 0;
    while (n < entry.size() && entry[n] >= '0' && entry[n] <= '9')
      a.capability = 10 * a.capability + (entry[n++] - '0');
    const std::string suffix = entry.substr(n);
    if (suffix == "-real") a.intermediate = false;
    if (suffix == "-virtual") a.machine_code = false;
    // Letters (90a, 100f) tie the code to one architecture.
    if (!suffix.empty() && suffix[0] != '-') a.intermediate = false;
    all.push_back(a);
  }
  return all;
}

Message of_the_driver(const CudaFacts& facts) {
  const std::string needed =
      cuda_version(facts.runtime_version) + (facts.runtime_version / 1000 == 13   ? " (580 or newer)"
                                             : facts.runtime_version / 1000 == 12 ? " (525 or newer)"
                                                                                  : "");
  if (facts.driver_version == 0)
    return "no NVIDIA driver is installed, or it cannot be loaded; install one that supports " + needed + ", or use " +
           option("device", "cpu");
  return "the NVIDIA driver supports " + cuda_version(facts.driver_version) + ", this build needs " + needed +
         "; update the driver, build with an older CUDA toolkit, or use " + option("device", "cpu");
}

Message of_the_architecture(const std::string& device, const CudaFacts& facts) {
  const std::string has = "this build has code for " + architectures_in_words(facts.architectures) + ", none for " +
                          device + (facts.capability > 0 ? " of compute capability " + dotted(facts.capability) : "");
  if (facts.capability > 0 && facts.capability < kOldestCapability)
    return has + "; " + cuda_version(facts.runtime_version) + " supports no GPU below " + dotted(kOldestCapability) +
           ": use " + option("device", "cpu");
  return has + "; configure with -DCMAKE_CUDA_ARCHITECTURES=" +
         (facts.capability > 0 ? std::to_string(facts.capability) : std::string("native")) +
         " and build again, or use " + option("device", "cpu");
}

bool lacks_code(cudaError_t status) {
  switch (status) {
    case cudaErrorNoKernelImageForDevice:
    case cudaErrorInvalidDeviceFunction:
    case cudaErrorInvalidKernelImage:
    case cudaErrorInvalidPtx:
    case cudaErrorUnsupportedPtxVersion:
    case cudaErrorJitCompilerNotFound:
    case cudaErrorJitCompilationDisabled: return true;
    default: return false;
  }
}

/// After these errors the process can no longer use the device.
bool is_unrecoverable(cudaError_t status) {
  switch (status) {
    case cudaErrorIllegalAddress:
    case cudaErrorLaunchFailure:
    case cudaErrorLaunchTimeout:
    case cudaErrorAssert:
    case cudaErrorHardwareStackError:
    case cudaErrorIllegalInstruction:
    case cudaErrorMisalignedAddress:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorInvalidPc:
    case cudaErrorECCUncorrectable:
    case cudaErrorNvlinkUncorrectable:
    case cudaErrorContained:
    case cudaErrorContextIsDestroyed:
    case cudaErrorExternalDevice:
    case cudaErrorUnknown: return true;
    default: return false;
  }
}

}  // namespace

std::string architectures_in_words(const std::string& architectures) {
  const std::vector<Architecture> all = parse(architectures);
  std::string text = "compute capability ";
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].capability == 0) return "the architectures '" + architectures + "'";
    if (i > 0) text += i + 1 == all.size() ? " and " : ", ";
    text += dotted(all[i].capability) + (all[i].intermediate ? " or later" : "");
  }
  return all.empty() ? "no architecture" : text;
}

bool has_code_for(const std::string& architectures, int capability) {
  for (const Architecture& a : parse(architectures)) {
    if (a.capability == 0) return true;
    const bool not_newer = a.capability <= capability;
    if (not_newer && ((a.machine_code && a.capability / 10 == capability / 10) || a.intermediate)) return true;
  }
  return false;
}

void throw_cuda_error(cudaError_t status, const std::string& doing, const CudaFacts& facts) {
  const std::string device = facts.device.empty() ? "the GPU" : facts.device;
  const std::string words = std::string(cudaGetErrorName(status)) + ", " + cudaGetErrorString(status);
  if (status == cudaErrorMemoryAllocation) {
    // The runtime takes memory of its own, for a kernel's code, and does not say how much.
    const bool is_ours = facts.asked_bytes > 0;
    const std::string full = is_ours ? "has no room for another " + memory_text(facts.asked_bytes) : "is full",
                      remedy =
                          is_ours
                              ? "use a larger grid spacing or fewer atoms, another GPU"
                              : "end other programs that hold memory there (nvidia-smi lists them), use another GPU";
    throw MemoryError(device + " " + full + " (" + doing + "): " + memory_text(facts.free_bytes) + " of its " +
                      memory_text(facts.total_bytes) + " are free; " + remedy + " (" + option("device", "cuda:N") +
                      "), or " + option("device", "cpu"));
  }
  if (status == cudaErrorNoDevice) throw DeviceError("no NVIDIA GPU was found; use " + option("device", "cpu"));
  if (status == cudaErrorInsufficientDriver || status == cudaErrorStubLibrary ||
      status == cudaErrorCallRequiresNewerDriver)
    throw DeviceError(of_the_driver(facts));
  if (lacks_code(status)) throw DeviceError(of_the_architecture(device, facts));
  if (status == cudaErrorDevicesUnavailable || status == cudaErrorDeviceAlreadyInUse)
    throw DeviceError(device + " is in use by another process, which does not share it (" + words +
                      "); wait for it, take another (" + option("device", "cuda:N") + "), or use " +
                      option("device", "cpu"));
  if (status == cudaErrorInitializationError || status == cudaErrorSystemNotReady ||
      status == cudaErrorSystemDriverMismatch || status == cudaErrorCompatNotSupportedOnDevice)
    throw DeviceError("CUDA could not be started (" + words +
                      "); check the driver with nvidia-smi, restart the machine after an update of it, or use " +
                      option("device", "cpu"));
  if (is_unrecoverable(status))
    throw DeviceError(device + " failed while " + doing + " (" + words +
                      ") and cannot be used by this process any more; start again, with " + option("device", "cpu") +
                      " if it recurs, and report it with the command line");
  throw DeviceError(device + " failed while " + doing + " (" + words + "); try " + option("device", "cpu"));
}

void check_cuda(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  cudaGetLastError();
  throw_cuda_error(status, doing, facts_of_current_device());
}

}  // namespace espdiff::ESPDIFF_BACKEND
