// select_engine.cpp: probes the back ends and makes the requested engine.
#include "engine/select_engine.h"
#include "engine/engine.h"

#include <cstdlib>

#include "base/error.h"
#include "engine/make_engine.h"
#include "system/control_groups.h"

namespace espdiff {
namespace {

/// The GPUs, or the reason for none.
struct CudaDevices {
  std::vector<BackEndStatus> all;
  Message why_none;
};

CudaDevices find_cuda_devices() {
  CudaDevices found;
#if defined(ESPDIFF_HAVE_CUDA)
  for (const auto& device : cuda_backend::probe_devices(&found.why_none))
    found.all.push_back({"cuda:" + std::to_string(found.all.size()), device.usable, device.description});
#else
  found.why_none =
      "this build has no CUDA back end; configure with -DESPDIFF_CUDA=ON where nvcc is installed, or use " +
      option("device", "cpu");
#endif
  return found;
}

/// The argument of the option `device`, for messages.
Message option_of(const DeviceRequest& device) {
  return option("device", "cuda" + (device.index > 0 ? ":" + std::to_string(device.index) : std::string()));
}

void check_cuda_device(const DeviceRequest& device, const CudaDevices& found) {
  const Message given = option_of(device);
  if (found.all.empty()) throw DeviceError(given + ": " + found.why_none);
  const std::size_t n = found.all.size(), index = static_cast<std::size_t>(device.index);
  if (index >= n) {
    throw DeviceError(
        given + ": there " +
        (n == 1 ? "is 1 GPU, cuda:0" : "are " + std::to_string(n) + " GPUs, cuda:0 to cuda:" + std::to_string(n - 1)) +
        "; take one of them, or use " + option("device", "cpu"));
  }
  if (!found.all[index].available) throw DeviceError(given + ": " + found.all[index].description);
}

}  // namespace

DeviceRequest parse_device(const std::string& text) {
  if (text == "auto") return DeviceChoice::kAuto;
  if (text == "cpu") return DeviceChoice::kCpu;
  if (text == "cuda") return DeviceChoice::kCuda;
  const std::string index = text.rfind("cuda:", 0) == 0 ? text.substr(5) : std::string();
  constexpr std::size_t kMostDigits = 4;
  if (!index.empty() && index.size() <= kMostDigits && index.find_first_not_of("0123456789") == std::string::npos)
    return {DeviceChoice::kCuda, std::stoi(index)};
  refuse_value("device", text, "auto, cpu, cuda or cuda:N, the GPU of that index");
}

const std::vector<OptionRow<ComputingOptions>>& computing_settings() {
  using Rows = RowsOf<ComputingOptions>;
  const std::string group = "Computation";
  static const std::vector<Rows::Row> all = [&] {
    Rows::Row device = Rows::parsed(
        "device", group,
        [](auto& o, const std::string& text) {
          parse_device(text);
          o.device = text;
        },
        [](const auto& o) { return o.device; },
        "Where to compute: auto takes a GPU if one works, cuda:1 the second one; doctor lists the GPUs");
    device.kind = SettingKind::kChoice;
    device.choices = {"auto", "cpu", "cuda", "cuda:N"};
    return std::vector{device,
                       Rows::count(
                           "threads", group, {0, kMostThreads}, [](auto& o) -> auto& { return o.threads; },
                           "CPU threads; 0 takes OMP_NUM_THREADS, otherwise all. The result does not depend on it")};
  }();
  return all;
}

int available_threads() {
  // Like OpenMP: the first number of a list, for the outermost team. Read here because the engine sets the number of
  // threads itself.
  const char* const text = std::getenv("OMP_NUM_THREADS");
  const long wanted = text != nullptr ? std::strtol(text, nullptr, 10) : 0;
  if (wanted > 0 && wanted <= kMostThreads) return static_cast<int>(wanted);
  return usable_processors();
}

BackEndStatus cpu_status() {
  const int n = available_threads();
  return {"cpu", true, std::to_string(n) + (n == 1 ? " thread" : " threads")};
}

BackEndStatus cuda_status() {
  const CudaDevices found = find_cuda_devices();
  if (found.all.empty()) return {"cuda", false, found.why_none};
  return {"cuda", found.all.front().available, found.all.front().description};
}

BackEndStatus device_status(const DeviceRequest& device) {
  if (device.choice == DeviceChoice::kCpu) return cpu_status();
  const CudaDevices found = find_cuda_devices();
  if (device.choice == DeviceChoice::kCuda) {
    check_cuda_device(device, found);
    return found.all[static_cast<std::size_t>(device.index)];
  }
  return !found.all.empty() && found.all.front().available ? found.all.front() : cpu_status();
}

std::vector<BackEndStatus> cuda_devices() { return find_cuda_devices().all; }

BackEndStatus cpu_fourier_status() {
  BackEndStatus status{"cpu", false, ""};
  status.description = cpu_backend::probe_fourier(&status.available);
  return status;
}

BackEndStatus cuda_fourier_status() {
  BackEndStatus status = cuda_status();
#if defined(ESPDIFF_HAVE_CUDA)
  if (status.available) status.description = cuda_backend::probe_fourier(&status.available);
#endif
  return status;
}

std::unique_ptr<Engine> select_engine(const DeviceRequest& device, int n_threads) {
  if (n_threads < 0 || n_threads > kMostThreads)
    refuse_value("threads", std::to_string(n_threads), "a whole number from 0 to " + std::to_string(kMostThreads));
#if defined(ESPDIFF_HAVE_CUDA)
  if (device_status(device).name != "cpu") return cuda_backend::make_engine(device.index);
#else
  device_status(device);
#endif
  return cpu_backend::make_engine(n_threads > 0 ? n_threads : available_threads());
}

std::unique_ptr<Engine> select_engine(const ComputingOptions& options) {
  return select_engine(parse_device(options.device), options.threads);
}

}  // namespace espdiff
