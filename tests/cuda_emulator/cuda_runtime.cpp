// cuda_runtime.cpp: the functions of the CUDA runtime that espdiff calls, for a device that is this machine's CPU.
//
// Linked into a program before NVIDIA's static library, whose functions are then not taken. A function that is missing
// here shows as a symbol that is defined twice. Calls of several host threads take turns.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "device_memory.h"
#include "kernel.h"
#include "settings.h"
#include "streams.h"

namespace cuda_emulator {
namespace {

constexpr int kArchitecture = 90;
constexpr std::uint32_t kMaxShared = 48 << 10;
constexpr int kProcessors = 132;

std::recursive_mutex turn;
thread_local cudaError_t last_error = cudaSuccess;
thread_local int current_device = 0;

cudaError_t result(cudaError_t error) {
  if (error != cudaSuccess) last_error = error;
  return error;
}

/// Whether the device is lost, as when it falls off the bus; counts the operations until then. It stays lost.
bool is_lost() {
  static std::size_t n_operations = 0;
  return settings().lost > 0 && ++n_operations >= settings().lost;
}
constexpr cudaError_t kLost = cudaErrorLaunchFailure;

bool exists(int device) { return device >= 0 && device < settings().n_devices; }

struct Copies {
  std::size_t n = 0, n_bytes = 0;
  void add(std::size_t bytes) {
    ++n;
    n_bytes += bytes;
  }
};

struct Count {
  std::size_t launches = 0, graphs = 0, allocations = 0, waits = 0;
  std::size_t radix_sorts = 0, radix_passes = 0, merge_sorts = 0;
  Copies to_device, to_host, within;
  /// CUB's kernels tell by their names what they are part of. A radix sort of few elements is one kernel.
  void add_kernel(const std::string& name) {
    const auto is = [&name](const char* part) { return name.find(part) != std::string::npos; };
    ++launches;
    if (is("DeviceRadixSortHistogramKernel") || is("DeviceRadixSortSingleTileKernel")) ++radix_sorts;
    if (is("DeviceRadixSortOnesweepKernel") || is("DeviceRadixSortSingleTileKernel")) ++radix_passes;
    if (is("DeviceMergeSortBlockSortKernel")) ++merge_sorts;
  }
  ~Count() {
    if (!settings().count) return;
    std::fprintf(
        stderr,
        "cuda_emulator: %zu kernels and %zu graphs launched, %zu allocations, %zu times waited for a stream\n"
        "cuda_emulator: %zu radix sorts in %zu passes, %zu merge sorts\n"
        "cuda_emulator: copies: %zu to the device (%zu bytes), %zu to the host (%zu bytes), %zu on it (%zu bytes)\n",
        launches, graphs, allocations, waits, radix_sorts, radix_passes, merge_sorts, to_device.n, to_device.n_bytes,
        to_host.n, to_host.n_bytes, within.n, within.n_bytes);
  }
};
Count& count() {
  static Count counted;
  return counted;
}

// ---- kernels

/// The compiler's name of a kernel, by the address that the program knows it by.
std::map<const void*, std::string>& names() {
  static std::map<const void*, std::string> all;
  return all;
}

const Kernel* kernel_of(const void* function) {
  const auto name = names().find(function);
  if (name == names().end()) return nullptr;
  const Kernel* const kernel = find_kernel(name->second);
  if (kernel == nullptr)
    fail("no translation of kernel %s; give its object file to translate_ptx.py", name->second.c_str());
  return kernel;
}

cudaError_t launch(const Kernel* kernel, dim3 grid, dim3 block, void** parameters, std::size_t shared_bytes,
                   void* stream) {
  const std::lock_guard<std::recursive_mutex> lock(turn);
  if (is_lost()) return result(kLost);
  if (kernel == nullptr) return result(cudaErrorInvalidDeviceFunction);
  const std::uint64_t n = std::uint64_t{block.x} * block.y * block.z;
  if (n == 0 || n > kernel->max_threads || grid.x == 0 || grid.y == 0 || grid.z == 0 || grid.x > INT32_MAX ||
      grid.y > UINT16_MAX || grid.z > UINT16_MAX || kernel->shared_bytes + shared_bytes > kMaxShared)
    return result(cudaErrorInvalidConfiguration);
  count().add_kernel(kernel->name);
  // The parameters' values of now.
  auto values = std::make_shared<std::vector<std::vector<char>>>();
  for (std::size_t i = 0; i < kernel->parameter_bytes.size(); ++i) {
    const char* const value = static_cast<const char*>(parameters[i]);
    values->emplace_back(value, value + kernel->parameter_bytes[i]);
  }
  stream_of(stream).put([=] {
    std::vector<void*> places;
    for (std::vector<char>& value : *values) places.push_back(value.data());
    run_grid(*kernel, {grid.x, grid.y, grid.z}, {block.x, block.y, block.z}, static_cast<std::uint32_t>(shared_bytes),
             places.data());
  });
  return cudaSuccess;
}

struct Configuration {
  dim3 grid, block;
  std::size_t shared_bytes;
  void* stream;
};
thread_local std::vector<Configuration> configurations;

// ---- memory

struct Pool {
  std::size_t used = 0, reserved = 0;
};

struct PoolBlock {
  Pool* pool;
  std::size_t n_bytes;
};
std::map<void*, PoolBlock>& pool_blocks() {
  static std::map<void*, PoolBlock> all;
  return all;
}

/// Page-locked host memory: start, size.
std::map<const char*, std::size_t>& locked_memory() {
  static std::map<const char*, std::size_t> all;
  return all;
}

bool is_locked(const void* place) {
  const auto after = locked_memory().upper_bound(static_cast<const char*>(place));
  if (after == locked_memory().begin()) return false;
  const auto block = std::prev(after);
  return static_cast<const char*>(place) < block->first + block->second;
}

void copy(void* to, const void* from, std::size_t n_bytes) {
  std::memmove(view(static_cast<char*>(to)), view(static_cast<const char*>(from)), n_bytes);
  mark_copied(to, from, n_bytes);
}

struct Event {
  std::chrono::steady_clock::time_point time;
};

const char* error_name(cudaError_t error) {
  switch (error) {
    case cudaSuccess: return "cudaSuccess";
    case cudaErrorInvalidValue: return "cudaErrorInvalidValue";
    case cudaErrorMemoryAllocation: return "cudaErrorMemoryAllocation";
    case cudaErrorInvalidConfiguration: return "cudaErrorInvalidConfiguration";
    case cudaErrorInvalidDeviceFunction: return "cudaErrorInvalidDeviceFunction";
    case cudaErrorInvalidDevice: return "cudaErrorInvalidDevice";
    case cudaErrorNoDevice: return "cudaErrorNoDevice";
    case cudaErrorInsufficientDriver: return "cudaErrorInsufficientDriver";
    case cudaErrorDevicesUnavailable: return "cudaErrorDevicesUnavailable";
    case cudaErrorIllegalAddress: return "cudaErrorIllegalAddress";
    case cudaErrorLaunchFailure: return "cudaErrorLaunchFailure";
    case cudaErrorStreamCaptureUnsupported: return "cudaErrorStreamCaptureUnsupported";
    default: return "cudaErrorUnknown";
  }
}

int attribute_of(cudaDeviceAttr attribute) {
  switch (attribute) {
    case cudaDevAttrMaxThreadsPerBlock: return 1024;
    case cudaDevAttrMaxThreadsPerMultiProcessor: return 2048;
    case cudaDevAttrMaxBlocksPerMultiprocessor: return 32;
    case cudaDevAttrMultiProcessorCount: return kProcessors;
    case cudaDevAttrWarpSize: return 32;
    case cudaDevAttrComputeCapabilityMajor: return kArchitecture / 10;
    case cudaDevAttrComputeCapabilityMinor: return kArchitecture % 10;
    case cudaDevAttrMaxSharedMemoryPerBlock: return static_cast<int>(kMaxShared);
    case cudaDevAttrMaxSharedMemoryPerBlockOptin: return static_cast<int>(kMaxShared);
    case cudaDevAttrMaxSharedMemoryPerMultiprocessor: return 228 << 10;
    case cudaDevAttrReservedSharedMemoryPerBlock: return 1024;
    case cudaDevAttrMaxRegistersPerBlock: return 65536;
    case cudaDevAttrMaxGridDimX: return INT32_MAX;
    case cudaDevAttrMaxGridDimY:
    case cudaDevAttrMaxGridDimZ: return UINT16_MAX;
    case cudaDevAttrMemoryPoolsSupported: return settings().pools ? 1 : 0;
    case cudaDevAttrClockRate:
    case cudaDevAttrMemoryClockRate:
    case cudaDevAttrGlobalMemoryBusWidth:
    case cudaDevAttrL2CacheSize:
    case cudaDevAttrSingleToDoublePrecisionPerfRatio: return 1;  // it is no GPU: no bound is computed from this
    default: fail("device attribute %d is not known", static_cast<int>(attribute));
  }
}

using Lock = std::lock_guard<std::recursive_mutex>;

}  // namespace
}  // namespace cuda_emulator

using namespace cuda_emulator;

// NOLINTBEGIN(readability-identifier-naming): the names are NVIDIA's
extern "C" {

// ---- what the compiler's code calls

void** __cudaRegisterFatBinary(void* binary) { return static_cast<void**>(binary); }
void __cudaRegisterFatBinaryEnd(void**) {}
void __cudaUnregisterFatBinary(void**) {}
char __cudaInitModule(void**) { return 1; }
void __cudaRegisterVar(void**, char*, char*, const char*, int, std::size_t, int, int) {}
void __cudaRegisterFunction(void**, const char* function, char*, const char* name, int, uint3*, uint3*, dim3*, dim3*,
                            int*) {
  names()[function] = name;
}

unsigned __cudaPushCallConfiguration(dim3 grid, dim3 block, std::size_t shared_bytes, void* stream) {
  configurations.push_back({grid, block, shared_bytes, stream});
  return 0;
}
cudaError_t __cudaPopCallConfiguration(dim3* grid, dim3* block, std::size_t* shared_bytes, void* stream) {
  if (configurations.empty()) return result(cudaErrorMissingConfiguration);
  const Configuration last = configurations.back();
  configurations.pop_back();
  *grid = last.grid;
  *block = last.block;
  *shared_bytes = last.shared_bytes;
  *static_cast<void**>(stream) = last.stream;
  return cudaSuccess;
}
cudaError_t __cudaGetKernel(cudaKernel_t* kernel, const void* function) {
  *kernel = reinterpret_cast<cudaKernel_t>(const_cast<Kernel*>(kernel_of(function)));
  return *kernel != nullptr ? cudaSuccess : result(cudaErrorInvalidDeviceFunction);
}
cudaError_t __cudaLaunchKernel(cudaKernel_t kernel, dim3 grid, dim3 block, void** parameters, std::size_t shared_bytes,
                               cudaStream_t stream) {
  return launch(reinterpret_cast<const Kernel*>(kernel), grid, block, parameters, shared_bytes, stream);
}
cudaError_t cudaLaunchKernel(const void* function, dim3 grid, dim3 block, void** parameters, std::size_t shared_bytes,
                             cudaStream_t stream) {
  return launch(kernel_of(function), grid, block, parameters, shared_bytes, stream);
}
cudaError_t cudaLaunchKernelExC(const cudaLaunchConfig_t* config, const void* function, void** parameters) {
  return launch(kernel_of(function), config->gridDim, config->blockDim, parameters, config->dynamicSmemBytes,
                config->stream);
}

// ---- devices and errors

cudaError_t cudaGetDeviceCount(int* n) {
  *n = settings().driver ? settings().n_devices : 0;
  if (!settings().driver) return result(cudaErrorInsufficientDriver);
  return *n > 0 ? cudaSuccess : result(cudaErrorNoDevice);
}
cudaError_t cudaGetDevice(int* device) {
  *device = current_device;
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int device) {
  if (!exists(device)) return result(cudaErrorInvalidDevice);
  if (!settings().shared) return result(cudaErrorDevicesUnavailable);
  current_device = device;
  return cudaSuccess;
}
cudaError_t cudaDriverGetVersion(int* version) {
  *version = settings().driver ? CUDART_VERSION : 0;
  return cudaSuccess;
}
cudaError_t cudaGetLastError() { return std::exchange(last_error, cudaSuccess); }
cudaError_t cudaPeekAtLastError() { return last_error; }
const char* cudaGetErrorName(cudaError_t error) { return error_name(error); }
const char* cudaGetErrorString(cudaError_t error) { return error_name(error); }
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device) {
  if (!exists(device)) return result(cudaErrorInvalidDevice);
  *value = attribute_of(attribute);
  return cudaSuccess;
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  if (!exists(device)) return result(cudaErrorInvalidDevice);
  *properties = cudaDeviceProp{};
  std::strcpy(properties->name, "no GPU: PTX on the CPU");
  properties->major = kArchitecture / 10;
  properties->minor = kArchitecture % 10;
  properties->totalGlobalMem = settings().memory;
  properties->multiProcessorCount = kProcessors;
  properties->warpSize = 32;
  properties->maxThreadsPerBlock = 1024;
  properties->sharedMemPerBlock = kMaxShared;
  return cudaSuccess;
}
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, const void* function) {
  *attributes = cudaFuncAttributes{};
  const Kernel* const kernel = kernel_of(function);
  if (kernel == nullptr) return result(cudaErrorInvalidDeviceFunction);
  attributes->ptxVersion = attributes->binaryVersion = kArchitecture;
  attributes->maxThreadsPerBlock = static_cast<int>(kernel->max_threads);
  attributes->sharedSizeBytes = kernel->shared_bytes;
  attributes->maxDynamicSharedSizeBytes = static_cast<int>(kMaxShared - kernel->shared_bytes);
  return cudaSuccess;
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(int* n, const void*, int block, std::size_t,
                                                                   unsigned) {
  *n = std::max(1, 2048 / std::max(block, 1));
  return cudaSuccess;
}

// ---- memory

cudaError_t cudaMalloc(void** start, std::size_t n_bytes) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  ++count().allocations;
  *start = allocate(n_bytes);
  return *start != nullptr ? cudaSuccess : result(cudaErrorMemoryAllocation);
}
cudaError_t cudaFree(void* start) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  finish_all_streams();
  if (start != nullptr) release(static_cast<char*>(start));
  return cudaSuccess;
}
cudaError_t cudaMallocHost(void** start, std::size_t n_bytes) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  *start = std::malloc(n_bytes);
  if (*start == nullptr) return result(cudaErrorMemoryAllocation);
  locked_memory()[static_cast<const char*>(*start)] = n_bytes;
  return cudaSuccess;
}
cudaError_t cudaFreeHost(void* start) {
  const Lock lock(turn);
  locked_memory().erase(static_cast<const char*>(start));
  std::free(start);
  return cudaSuccess;
}
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  *total = settings().memory;
  *free = settings().memory - std::min(settings().memory, settings().others + allocated_bytes());
  return cudaSuccess;
}
cudaError_t cudaMemPoolCreate(cudaMemPool_t* pool, const cudaMemPoolProps*) {
  if (is_lost()) return result(kLost);
  *pool = reinterpret_cast<cudaMemPool_t>(new Pool);
  return cudaSuccess;
}
cudaError_t cudaMemPoolDestroy(cudaMemPool_t) { return cudaSuccess; }  // lives on in what was got from it
cudaError_t cudaMemPoolSetAttribute(cudaMemPool_t, cudaMemPoolAttr, void*) { return cudaSuccess; }
cudaError_t cudaMemPoolGetAttribute(cudaMemPool_t pool, cudaMemPoolAttr attribute, void* value) {
  const Pool& it = *reinterpret_cast<const Pool*>(pool);
  *static_cast<std::uint64_t*>(value) = attribute == cudaMemPoolAttrUsedMemCurrent ? it.used : it.reserved;
  return cudaSuccess;
}
cudaError_t cudaMemPoolTrimTo(cudaMemPool_t pool, std::size_t) {
  reinterpret_cast<Pool*>(pool)->reserved = reinterpret_cast<Pool*>(pool)->used;
  return cudaSuccess;
}
cudaError_t cudaMallocFromPoolAsync(void** start, std::size_t n_bytes, cudaMemPool_t pool, cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  if (stream_of(stream).capturing) fail("memory is allocated while a graph is made");
  ++count().allocations;
  *start = allocate(n_bytes);
  if (*start == nullptr) return result(cudaErrorMemoryAllocation);
  Pool* const it = reinterpret_cast<Pool*>(pool);
  it->used += n_bytes;
  it->reserved = std::max(it->reserved, it->used);
  pool_blocks()[*start] = {it, n_bytes};
  return cudaSuccess;
}
cudaError_t cudaFreeAsync(void* start, cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  if (stream_of(stream).capturing) fail("memory is released while a graph is made");
  const auto block = pool_blocks().find(start);
  if (block == pool_blocks().end()) return result(cudaErrorInvalidValue);
  block->second.pool->used -= block->second.n_bytes;
  pool_blocks().erase(block);
  stream_of(stream).put([start] { release(static_cast<char*>(start)); });
  return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t n_bytes, cudaMemcpyKind kind, cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  const bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
  const bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
  if (kind == cudaMemcpyDefault || on_device(to) != to_device || on_device(from) != from_device ||
      !allocated(to, n_bytes) || !allocated(from, n_bytes))
    return result(cudaErrorInvalidValue);
  (!from_device ? count().to_device : !to_device ? count().to_host : count().within).add(n_bytes);
  Stream& it = stream_of(stream);
  // Of host memory that is not locked a GPU takes a copy first, or waits.
  if (!from_device && !is_locked(from)) {
    const auto staged =
        std::make_shared<std::vector<char>>(static_cast<const char*>(from), static_cast<const char*>(from) + n_bytes);
    it.put([=] { copy(to, staged->data(), n_bytes); });
  } else {
    it.put([=] { copy(to, from, n_bytes); });
    if (!to_device && !is_locked(to)) {
      ++count().waits;
      it.finish();
    }
  }
  return cudaSuccess;
}
cudaError_t cudaMemsetAsync(void* start, int value, std::size_t n_bytes, cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  if (!on_device(start) || !allocated(start, n_bytes)) return result(cudaErrorInvalidValue);
  stream_of(stream).put([=] {
    std::memset(view(static_cast<char*>(start)), value, n_bytes);
    mark_written(start, n_bytes);
  });
  return cudaSuccess;
}

// ---- streams, graphs, events

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  if (is_lost()) return result(kLost);
  *stream = reinterpret_cast<cudaStream_t>(new Stream);
  return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  const Lock lock(turn);
  if (!is_lost()) stream_of(stream).finish();
  delete reinterpret_cast<Stream*>(stream);
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  if (stream_of(stream).capturing) return result(cudaErrorStreamCaptureUnsupported);
  ++count().waits;
  stream_of(stream).finish();
  return cudaSuccess;
}
cudaError_t cudaStreamIsCapturing(cudaStream_t stream, cudaStreamCaptureStatus* status) {
  *status = stream_of(stream).capturing ? cudaStreamCaptureStatusActive : cudaStreamCaptureStatusNone;
  return cudaSuccess;
}
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode) {
  const Lock lock(turn);
  stream_of(stream).capturing = true;
  return cudaSuccess;
}
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
  const Lock lock(turn);
  Stream& it = stream_of(stream);
  *graph = reinterpret_cast<cudaGraph_t>(new Graph{std::exchange(it.captured, {})});
  it.capturing = false;
  return cudaSuccess;
}
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* executable, cudaGraph_t graph, unsigned long long) {
  *executable = reinterpret_cast<cudaGraphExec_t>(new Graph(*reinterpret_cast<const Graph*>(graph)));
  return cudaSuccess;
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t executable, cudaStream_t stream) {
  const Lock lock(turn);
  if (is_lost()) return result(kLost);
  ++count().graphs;
  const Graph steps = *reinterpret_cast<const Graph*>(executable);
  stream_of(stream).put([steps] {
    for (const Work& step : steps.steps) step();
  });
  return cudaSuccess;
}
cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  delete reinterpret_cast<Graph*>(graph);
  return cudaSuccess;
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t executable) {
  delete reinterpret_cast<Graph*>(executable);
  return cudaSuccess;
}
cudaError_t cudaEventCreate(cudaEvent_t* event) {
  *event = reinterpret_cast<cudaEvent_t>(new Event);
  return cudaSuccess;
}
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  delete reinterpret_cast<Event*>(event);
  return cudaSuccess;
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  const Lock lock(turn);
  Event* const it = reinterpret_cast<Event*>(event);
  stream_of(stream).put([it] { it->time = std::chrono::steady_clock::now(); });
  return cudaSuccess;
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t from, cudaEvent_t to) {
  *ms = std::chrono::duration<float, std::milli>(reinterpret_cast<Event*>(to)->time -
                                                 reinterpret_cast<Event*>(from)->time)
            .count();
  return cudaSuccess;
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
