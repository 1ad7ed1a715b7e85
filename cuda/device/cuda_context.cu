// cuda_context.cu: an engine's stream, memory pool and staging area, and the memory blocks allocated from the pool.
#include "cuda/device/cuda_context.h"

#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/device/memory.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::size_t kStagingBytes = std::size_t{4} << 20;
constexpr std::size_t kStagingAlignment = 64;

thread_local const std::shared_ptr<CudaContext>* current_context = nullptr;

/// Makes a device the runtime's current one and restores the previous one at the end. Ignores errors, since destructors
/// use it; the next call that needs the device reports them.
class DeviceGuard {
 public:
  explicit DeviceGuard(int device) {
    if (cudaGetDevice(&before_) != cudaSuccess) before_ = device;
    changed_ = before_ != device && cudaSetDevice(device) == cudaSuccess;
  }
  ~DeviceGuard() {
    if (changed_) cudaSetDevice(before_);
    cudaGetLastError();
  }
  DeviceGuard(const DeviceGuard&) = delete;
  DeviceGuard& operator=(const DeviceGuard&) = delete;

 private:
  int before_ = 0;
  bool changed_ = false;
};

class Event {
 public:
  Event() { check_cuda(cudaEventCreate(&event_), "making an event"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Loading it tells whether this build has code for the device.
__global__ void any_kernel() {}

/// The engine's own pool, which keeps released memory; null where the device has none.
cudaMemPool_t make_pool(int device) {
  int supported = 0;
  check_cuda(cudaDeviceGetAttribute(&supported, cudaDevAttrMemoryPoolsSupported, device), "asking for memory pools");
  if (supported == 0) return nullptr;
  cudaMemPoolProps properties{};
  properties.allocType = cudaMemAllocationTypePinned;
  properties.handleTypes = cudaMemHandleTypeNone;
  properties.location.type = cudaMemLocationTypeDevice;
  properties.location.id = device;
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaMemPoolCreate(&pool, &properties), "making a pool of memory");
  std::uint64_t keep = UINT64_MAX;
  const cudaError_t status = cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &keep);
  if (status != cudaSuccess) cudaMemPoolDestroy(pool);
  check_cuda(status, "setting up a pool of memory");
  return pool;
}

}  // namespace

CudaContext::CudaContext(int device) : device_(device) {
  const DeviceGuard guard(device);
  check_cuda(cudaSetDevice(device), "choosing the GPU");
  cudaFuncAttributes attributes{};
  check_cuda(cudaFuncGetAttributes(&attributes, any_kernel), "loading code");
  pool_ = make_pool(device);
  // Nothing below throws, so no resource leaks.
  cudaError_t status = cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking);
  if (status != cudaSuccess && pool_ != nullptr) cudaMemPoolDestroy(pool_);
  check_cuda(status, "making a stream");
  void* staging = nullptr;
  if (cudaMallocHost(&staging, kStagingBytes) == cudaSuccess) staging_ = static_cast<char*>(staging);
}

CudaContext::~CudaContext() {
  const DeviceGuard guard(device_);
  cudaStreamSynchronize(stream_);
  cudaStreamDestroy(stream_);
  if (pool_ != nullptr) cudaMemPoolDestroy(pool_);
  if (staging_ != nullptr) cudaFreeHost(staging_);
}

const std::shared_ptr<CudaContext>& CudaContext::current() {
  if (current_context == nullptr)
    throw Error(ErrorClass::kInternal, "the GPU was used outside a call of its engine; please report this");
  return *current_context;
}

CudaContext::Use::Use(const std::shared_ptr<CudaContext>& context) : before_(current_context) {
  check_cuda(cudaGetDevice(&device_before_), "asking for the current GPU");
  check_cuda(cudaSetDevice(context->device()), "choosing the GPU");
  current_context = &context;
}

CudaContext::Use::~Use() {
  int device = device_before_;
  current_context = before_;
  if (cudaGetDevice(&device) == cudaSuccess && device != device_before_) cudaSetDevice(device_before_);
  cudaGetLastError();
}

cudaError_t CudaContext::try_allocate(void** start, std::size_t n_bytes) {
  const cudaError_t status =
      pool_ != nullptr ? cudaMallocFromPoolAsync(start, n_bytes, pool_, stream_) : cudaMalloc(start, n_bytes);
  if (status != cudaSuccess) cudaGetLastError();
  return status;
}

void* CudaContext::allocate(std::size_t n_bytes) {
  if (n_bytes == 0) return nullptr;
  void* start = nullptr;
  cudaError_t status = try_allocate(&start, n_bytes);
  if (status == cudaErrorMemoryAllocation && pool_ != nullptr) {
    // The pool may hold blocks that are too small, and others are released once the work before is done.
    pending_ = true;
    synchronize();
    check_cuda(cudaMemPoolTrimTo(pool_, 0), "giving memory back");
    status = try_allocate(&start, n_bytes);
  }
  if (status != cudaSuccess) throw_cuda_error(status, "allocating", facts_of_current_device(n_bytes));
  return start;
}

void CudaContext::release(void* start) noexcept {
  if (start == nullptr) return;
  const DeviceGuard guard(device_);
  if (pool_ != nullptr) {
    cudaFreeAsync(start, stream_);
  } else {
    cudaStreamSynchronize(stream_);
    cudaFree(start);
  }
}

char* CudaContext::stage(std::size_t n_bytes) {
  const std::size_t rounded = (n_bytes + kStagingAlignment - 1) / kStagingAlignment * kStagingAlignment;
  if (staging_ == nullptr || rounded > kStagingBytes) return nullptr;
  if (n_staged_ + rounded > kStagingBytes) synchronize();
  char* const start = staging_ + n_staged_;
  n_staged_ += rounded;
  return start;
}

void CudaContext::upload(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes == 0) return;
  char* const staged = stage(n_bytes);
  if (staged != nullptr) std::memcpy(staged, from, n_bytes);
  check_cuda(cudaMemcpyAsync(to, staged != nullptr ? staged : from, n_bytes, cudaMemcpyHostToDevice, stream()),
             "copying to it");
  // Unstaged memory may change or be freed after we return.
  if (staged == nullptr) synchronize();
}

void CudaContext::begin_read(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes == 0) return;
  char* const staged = stage(n_bytes);
  check_cuda(cudaMemcpyAsync(staged != nullptr ? staged : to, from, n_bytes, cudaMemcpyDeviceToHost, stream()),
             "copying from it");
  if (staged != nullptr) reads_.push_back({to, staged, n_bytes});
}

void CudaContext::copy(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes == 0) return;
  check_cuda(cudaMemcpyAsync(to, from, n_bytes, cudaMemcpyDeviceToDevice, stream()), "copying on it");
}

void CudaContext::synchronize() {
  if (!pending_) return;
  check_cuda(cudaStreamSynchronize(stream_), "computing");
  for (const Read& read : reads_) std::memcpy(read.to, read.staged, read.n_bytes);
  reads_.clear();
  n_staged_ = 0;
  pending_ = false;
}

double CudaContext::elapsed_ms(const std::function<void()>& calls) {
  const Event start, end;
  check_cuda(cudaEventRecord(start.get(), stream()), "timing");
  calls();
  check_cuda(cudaEventRecord(end.get(), stream()), "timing");
  synchronize();
  float ms = 0;
  check_cuda(cudaEventElapsedTime(&ms, start.get(), end.get()), "timing");
  return static_cast<double>(ms);
}

double CudaContext::reserved_bytes() const {
  std::uint64_t reserved = 0;
  if (pool_ != nullptr)
    check_cuda(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrReservedMemCurrent, &reserved), "asking for its memory");
  return static_cast<double>(reserved);
}

double CudaContext::available_bytes() const {
  std::size_t free = 0, total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "asking for its memory");
  std::uint64_t used = 0;
  if (pool_ != nullptr)
    check_cuda(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemCurrent, &used), "asking for its memory");
  return static_cast<double>(free) + reserved_bytes() - static_cast<double>(used);
}

MemoryBlock::MemoryBlock(std::size_t n_bytes) {
  if (n_bytes == 0) return;
  context_ = CudaContext::current();
  start_ = context_->allocate(n_bytes);
}

MemoryBlock::~MemoryBlock() {
  if (context_) context_->release(start_);
}

void copy_to_device(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes > 0) CudaContext::current()->upload(to, from, n_bytes);
}
HostReads::HostReads() : context_(CudaContext::current()) {}
HostReads::~HostReads() { context_->forget_reads(); }
void HostReads::add(void* to, const void* from, std::size_t n_bytes) { context_->begin_read(to, from, n_bytes); }
void HostReads::wait() { context_->synchronize(); }

void copy_to_host(void* to, const void* from, std::size_t n_bytes) {
  HostReads reads;
  reads.add(to, from, n_bytes);
  reads.wait();
}
void copy_on_device(void* to, const void* from, std::size_t n_bytes) {
  if (n_bytes > 0) CudaContext::current()->copy(to, from, n_bytes);
}

double available_bytes() { return 0.9 * CudaContext::current()->available_bytes(); }

std::string describe_device(int device) {
  cudaDeviceProp properties{};
  if (cudaGetDeviceProperties(&properties, device) != cudaSuccess) {
    cudaGetLastError();
    return "a GPU that does not answer";
  }
  const std::string memory = formatted("%.2f GiB", static_cast<double>(properties.totalGlobalMem) / 1073741824.0);
  return std::string(properties.name) + " (compute capability " + std::to_string(properties.major) + "." +
         std::to_string(properties.minor) + ", " + memory + ")";
}

CudaFacts facts_of_current_device(std::size_t asked_bytes) {
  CudaFacts facts;
  facts.asked_bytes = asked_bytes;
  facts.architectures = ESPDIFF_CUDA_ARCHITECTURES;
  if (cudaDriverGetVersion(&facts.driver_version) != cudaSuccess) facts.driver_version = 0;
  int device = 0;
  cudaDeviceProp properties{};
  if (facts.driver_version > 0 && cudaGetDevice(&device) == cudaSuccess &&
      cudaGetDeviceProperties(&properties, device) == cudaSuccess) {
    facts.device = "cuda:" + std::to_string(device) + " (" + properties.name + ")";
    facts.capability = 10 * properties.major + properties.minor;
    facts.total_bytes = properties.totalGlobalMem;
    std::size_t total = 0;
    if (asked_bytes > 0 && cudaMemGetInfo(&facts.free_bytes, &total) != cudaSuccess) facts.free_bytes = 0;
  }
  cudaGetLastError();
  return facts;
}

}  // namespace espdiff::ESPDIFF_BACKEND
