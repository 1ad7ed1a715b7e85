// device_forms_cuda.cu: the parallel primitives of the CUDA back end, and the device's state around a call.
#include "cuda/device/device_forms.h"
#include "engine/select_engine.h"

using namespace espdiff::cuda_backend;

namespace {

/// False without a GPU, after printing a line that says so.
bool can_run() {
  const espdiff::BackEndStatus cuda = espdiff::cuda_status();
  if (!cuda.available) MESSAGE("SKIPPED: cuda: ", cuda.description.plain());
  return cuda.available;
}

}  // namespace

TEST_CASE("the primitives of the CUDA back end") {
  if (!can_run()) return;
  const auto context = std::make_shared<CudaContext>(0);
  const CudaContext::Use use(context);
  forms::check_all();
  context->synchronize();
}

TEST_CASE("memory is reused: a second run of the same size takes no more from the device than the first") {
  if (!can_run()) return;
  const auto context = std::make_shared<CudaContext>(0);
  const CudaContext::Use use(context);
  constexpr std::size_t kElements = 10000000;
  double after[3];  // the pool's own, since other processes change what is free on the card
  for (double& held : after) {
    {
      const Buffer<float> a(kElements, 1.0F), b = a;
      CHECK(b[kElements - 1] == 1.0F);
    }
    held = context->reserved_bytes();
    CHECK((held == 0 || held >= 2 * sizeof(float) * kElements));  // 0 where the device has no pools
  }
  CHECK(after[1] == after[0]);
  CHECK(after[2] == after[0]);
}

TEST_CASE("a buffer may outlive its engine's context and be released by any thread's call or none") {
  if (!can_run()) return;
  Buffer<float> kept;
  {
    const auto context = std::make_shared<CudaContext>(0);
    const CudaContext::Use use(context);
    kept = Buffer<float>(1000, 2.0F);
  }
  CHECK(kept.size() == 1000);
}

TEST_CASE("the caller's current device is restored") {
  if (!can_run()) return;
  int n = 0, before = 0, after = -1;
  REQUIRE(cudaGetDeviceCount(&n) == cudaSuccess);
  if (n < 2) MESSAGE("SKIPPED: one GPU only: it is always the current one");
  REQUIRE(cudaGetDevice(&before) == cudaSuccess);
  for (int device = 0; device < n; ++device) {
    const auto context = std::make_shared<CudaContext>(device);
    { const CudaContext::Use use(context); }
    REQUIRE(cudaGetDevice(&after) == cudaSuccess);
    CHECK(after == before);
  }
}

TEST_CASE("too large an allocation: the message says how much was requested, and the engine stays usable") {
  if (!can_run()) return;
  const auto context = std::make_shared<CudaContext>(0);
  const CudaContext::Use use(context);
  CHECK_THROWS_AS(Buffer<char>(std::size_t{1} << 50), espdiff::MemoryError);
  CHECK(Buffer<float>(10, 3.0F)[9] == 3.0F);
}
