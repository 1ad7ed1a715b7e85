// deform_graph.cu: deform()'s iterations as a CUDA graph, recorded once and launched until the device reports
// convergence.
#include "cuda/deform/deform_graph.h"

#include <utility>

#include "cuda/deform/deform_iteration.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Rounds of kCheckInterval iterations in a graph. Even, so that a graph ends in the buffer it began with.
constexpr int kRounds = 4;
static_assert(kRounds * kCheckInterval % 2 == 0);

/// State of the iteration on the device.
struct Course {
  double mean_displacement_A;
  int iterations;  // number at convergence
  int converged;
};

// Each kernel returns at once after convergence, so the positions of that iteration are kept.

__global__ void __launch_bounds__(kThreadsPerBlock) laplacian_kernel(Iteration it, const Course* course) {
  const std::size_t v = static_cast<std::size_t>(blockIdx.x) * kThreadsPerBlock + threadIdx.x;
  if (v < it.topology.n_vertices && course->converged == 0) take_laplacian(it, v);
}

__global__ void __launch_bounds__(kThreadsPerBlock) move_kernel(Iteration it, const Course* course) {
  const std::size_t v = static_cast<std::size_t>(blockIdx.x) * kThreadsPerBlock + threadIdx.x;
  if (v < it.topology.n_vertices && course->converged == 0) move_vertex(it, v);
}

/// Distance that a vertex moved in the last iteration.
struct Displacement {
  const Vec4f* x;
  __device__ double operator()(std::size_t v) const { return static_cast<double>(x[v].w); }
};

/// The end of a round: the sum in sum_over()'s order, then the convergence test.
__global__ void __launch_bounds__(kReductionThreads)
    decide_kernel(std::size_t n_chunks, const double* partial, std::size_t n_vertices, double least, Course* course) {
  __shared__ double total;
  block_sum<double>(0, n_chunks, ElementOf<double>{partial}, &total);
  if (threadIdx.x != 0 || course->converged != 0) return;
  course->mean_displacement_A = total / static_cast<double>(n_vertices);
  course->iterations += kCheckInterval;
  course->converged = course->mean_displacement_A < least ? 1 : 0;
}

/// Loads a kernel's code, which would otherwise happen at first use and interrupt the recording.
template <typename Kernel>
void load(Kernel kernel) {
  cudaFuncAttributes attributes{};
  check_cuda(cudaFuncGetAttributes(&attributes, kernel), "loading code");
}

/// A stream only for recording. The engine's own stream cannot record, because another thread may release memory on it.
class RecordingStream {
 public:
  RecordingStream() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream"); }
  ~RecordingStream() {
    cudaStreamCaptureStatus status = cudaStreamCaptureStatusNone;
    if (cudaStreamIsCapturing(stream_, &status) == cudaSuccess && status != cudaStreamCaptureStatusNone) {
      cudaGraph_t left = nullptr;
      if (cudaStreamEndCapture(stream_, &left) == cudaSuccess && left != nullptr) cudaGraphDestroy(left);
    }
    cudaStreamDestroy(stream_);
    cudaGetLastError();
  }
  RecordingStream(const RecordingStream&) = delete;
  RecordingStream& operator=(const RecordingStream&) = delete;
  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

/// A recorded sequence of kernels, ready to be launched.
class Graph {
 public:
  /// Records the kernels that `launch` launches on the stream it is given.
  template <typename Launch>
  explicit Graph(Launch launch) {
    const RecordingStream stream;
    check_cuda(cudaStreamBeginCapture(stream.get(), cudaStreamCaptureModeThreadLocal), "recording a graph");
    launch(stream.get());
    check_cuda(cudaGetLastError(), "recording a graph");
    cudaGraph_t recorded = nullptr;
    check_cuda(cudaStreamEndCapture(stream.get(), &recorded), "recording a graph");
    const cudaError_t status = cudaGraphInstantiate(&graph_, recorded, 0);
    cudaGraphDestroy(recorded);
    check_cuda(status, "making a graph");
  }
  ~Graph() {
    cudaGraphExecDestroy(graph_);
    cudaGetLastError();
  }
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  void launch(cudaStream_t stream) const { check_cuda(cudaGraphLaunch(graph_, stream), "launching a graph"); }

 private:
  cudaGraphExec_t graph_ = nullptr;
};

}  // namespace

void iterate_in_graphs(DeformState& state, const DeformOptions& options, const std::string& stage,
                       const Progress& progress, DeformReport& report) {
  const std::size_t n = state.positions.size();
  const std::size_t n_chunks = (n + kReductionChunk - 1) / kReductionChunk;
  if (n > 0 && options.max_iterations >= kRounds * kCheckInterval) {
    const unsigned n_blocks = static_cast<unsigned>((n + kThreadsPerBlock - 1) / kThreadsPerBlock);
    Buffer<double> partial_sums(n_chunks);
    Buffer<Course> courses(1, Course{0.0, 0, 0});
    double* const partial = raw(partial_sums);
    Course* const course = raw(courses);
    Iteration there = state.iteration, back = state.iteration;
    there.from = back.to = raw(state.positions);
    there.to = raw(state.moved);
    back.from = there.to;
    const double least = options.min_displacement_A;
    load(laplacian_kernel);
    load(move_kernel);
    load(sum_chunks_kernel<double, Displacement>);
    load(decide_kernel);
    const Graph graph([&](cudaStream_t stream) {
      for (int i = 1; i <= kRounds * kCheckInterval; ++i) {
        const Iteration& now = i % 2 == 1 ? there : back;
        laplacian_kernel<<<n_blocks, kThreadsPerBlock, 0, stream>>>(now, course);
        move_kernel<<<n_blocks, kThreadsPerBlock, 0, stream>>>(now, course);
        if (i % kCheckInterval != 0) continue;
        sum_chunks_kernel<<<static_cast<unsigned>(n_chunks), kReductionThreads, 0, stream>>>(n, Displacement{now.to},
                                                                                             partial);
        decide_kernel<<<1, kReductionThreads, 0, stream>>>(n_chunks, partial, n, least, course);
      }
    });
    while (report.iterations + kRounds * kCheckInterval <= options.max_iterations && !report.converged) {
      graph.launch(CudaContext::current()->stream());
      const Course now = courses[0];
      report.iterations = now.iterations;
      report.mean_displacement_A = now.mean_displacement_A;
      report.converged = now.converged != 0;
      progress.report(stage, static_cast<double>(report.iterations) / options.max_iterations);
    }
    if (report.iterations % 2 == 1) state.positions.swap(state.moved);
  }
  iterate_one_by_one(state, options, stage, progress, report);
}

}  // namespace espdiff::ESPDIFF_BACKEND
