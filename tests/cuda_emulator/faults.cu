// faults.cu: kernels with the faults that the checks are to find; each is run by a test that looks for what is said.
#include <cstdio>
#include <cstring>

namespace {

constexpr int kN = 64;

__global__ void add_one(int* values, int n) {
  const int i = static_cast<int>(threadIdx.x);
  if (i < n) values[i] += 1;
}
__global__ void store_all(int* values, int offset) { values[static_cast<int>(threadIdx.x) + offset] = 1; }
__global__ void load_neighbour(int* values) { values[threadIdx.x] = values[(threadIdx.x + 1) % kN]; }
__global__ void store_in_pairs(int* values) { values[threadIdx.x / 2] = static_cast<int>(threadIdx.x); }
__global__ void count_atomically(int* values) { atomicAdd(values, 1); }
__global__ void load_misaligned(const char* bytes, int* values) {
  values[threadIdx.x] = *reinterpret_cast<const int*>(bytes + 1);
}
/// The first half of a warp waits for all threads, the second half for the first.
__global__ void two_barriers(int* values) {
  __shared__ int shared[kN];
  shared[threadIdx.x] = 1;
  if (threadIdx.x % 32 < 16) {
    __syncthreads();
  } else {
    __syncwarp();
  }
  values[threadIdx.x] = shared[kN - 1 - threadIdx.x];
}
/// The sum of all, by shuffles in each warp and shared memory.
__global__ void sum(const int* values, int* total) {
  __shared__ int sums[kN / 32];
  int value = values[threadIdx.x];
  for (int step = 16; step > 0; step /= 2) value += __shfl_down_sync(0xffffffffU, value, step);
  if (threadIdx.x % 32 == 0) sums[threadIdx.x / 32] = value;
  __syncthreads();
  if (threadIdx.x == 0) *total = sums[0] + sums[1];
}

}  // namespace

int main(int n_words, char** words) {
  const char* const fault = n_words > 1 ? words[1] : "";
  const auto is = [fault](const char* name) { return std::strcmp(fault, name) == 0; };
  cudaStream_t stream = nullptr;
  cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
  int *values = nullptr, *total = nullptr;
  cudaMalloc(reinterpret_cast<void**>(&values), kN * sizeof(int));
  cudaMalloc(reinterpret_cast<void**>(&total), sizeof(int));
  if (!is("never-written")) cudaMemsetAsync(values, 0, kN * sizeof(int), stream);
  cudaMemsetAsync(total, 0, sizeof(int), stream);

  if (is("none") || is("never-written")) {
    add_one<<<1, kN, 0, stream>>>(values, kN);
    sum<<<1, kN, 0, stream>>>(values, total);
    count_atomically<<<1, kN, 0, stream>>>(total);
    int result = 0;
    cudaMemcpyAsync(&result, total, sizeof result, cudaMemcpyDeviceToHost, stream);
    cudaStreamSynchronize(stream);
    std::printf("the sum is %d\n", result);
  } else if (is("out-of-bounds")) {
    store_all<<<1, kN, 0, stream>>>(values, 1);
  } else if (is("race-of-loads")) {
    load_neighbour<<<1, kN, 0, stream>>>(values);
  } else if (is("race-of-stores")) {
    store_in_pairs<<<1, kN, 0, stream>>>(values);
  } else if (is("misaligned")) {
    load_misaligned<<<1, kN, 0, stream>>>(reinterpret_cast<const char*>(values), values);
  } else if (is("barrier")) {
    two_barriers<<<1, kN, 0, stream>>>(values);
  } else if (is("released")) {
    cudaFree(values);
    store_all<<<1, kN, 0, stream>>>(values, 0);
  } else if (is("too-many-threads")) {
    add_one<<<1, 2048, 0, stream>>>(values, kN);
    std::printf("%s\n", cudaGetErrorName(cudaGetLastError()));
  } else if (is("host")) {
    std::printf("%d\n", *values);
  }
  cudaStreamSynchronize(stream);
  return 0;
}
