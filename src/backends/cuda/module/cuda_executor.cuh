#pragma once

// Runs kernels on a GPU. executor.h describes what an executor does.

#include <nvtx3/nvToolsExt.h>

#include <string>

#include "backends/cuda/executor.h"
#include "backends/cuda/module/cuda_error.h"
#include "backends/cuda/module/device_thread.cuh"
#include "util/diagnostics.h"

namespace alhazen::impl::cuda {

template <DeviceKernel Kernel>
__global__ void run_kernel(const __grid_constant__ Kernel kernel) {
  extern __shared__ uint4 traversal_stacks[];
  kernel(DeviceThread(traversal_stacks));
}

/// The same for kernels that are only launched in blocks of `default_block_threads` threads. The compiler limits the
/// registers per thread so that `resident_blocks` blocks fit on a multiprocessor at the same time.
template <DeviceKernel Kernel>
__global__ void __launch_bounds__(default_block_threads, Kernel::resident_blocks)
    run_resident_kernel(const __grid_constant__ Kernel kernel) {
  extern __shared__ uint4 traversal_stacks[];
  kernel(DeviceThread(traversal_stacks));
}

template <DeviceKernel Kernel>
constexpr auto kernel_function() {
  if constexpr (requires { Kernel::resident_blocks; })
    return run_resident_kernel<Kernel>;
  else
    return run_kernel<Kernel>;
}

class CudaExecutor {
 public:
  /// Fills a large GPU, and takes little time on a small one.
  static constexpr uint64_t first_items = uint64_t{1} << 17;

  class Range {
   public:
    explicit Range(const char* name) { nvtxRangePushA(name); }
    ~Range() { nvtxRangePop(); }
    Range(const Range&) = delete;
    Range& operator=(const Range&) = delete;
  };

  explicit CudaExecutor(int device) : device_(device) {
    use_device();
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "starting");
  }
  ~CudaExecutor() { cudaStreamDestroy(stream_); }
  CudaExecutor(const CudaExecutor&) = delete;
  CudaExecutor& operator=(const CudaExecutor&) = delete;

  /// The calls of this thread go to this GPU.
  void use_device() { check(cudaSetDevice(device_), "starting"); }

  void* allocate(size_t bytes) {
    void* memory = nullptr;
    check(cudaMalloc(&memory, bytes), "allocating memory for the scene, the film and the paths");
    return memory;
  }
  void release(void* memory) { cudaFree(memory); }
  void upload(void* to, const void* from, size_t bytes) {
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_), "copying to it");
    wait();
  }
  void download(void* to, const void* from, size_t bytes) {
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream_), "copying from it");
    wait();
  }
  void clear(void* memory, size_t bytes) { check(cudaMemsetAsync(memory, 0, bytes, stream_), "clearing its memory"); }
  size_t free_bytes() const {
    size_t free = 0, total = 0;
    check(cudaMemGetInfo(&free, &total), "querying its free memory");
    return free;
  }
  cudaStream_t stream() const { return stream_; }
  void wait() { check(cudaStreamSynchronize(stream_), "rendering"); }

  template <DeviceKernel Kernel>
  uint32_t resident_threads(uint32_t block) {
    int blocks = 0, multiprocessors = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel_function<Kernel>(), static_cast<int>(block),
                                                        stack_bytes(block)),
          "querying its occupancy");
    check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device_), "querying its properties");
    return static_cast<uint32_t>(blocks < 1 ? 1 : blocks) * static_cast<uint32_t>(multiprocessors) * block;
  }

  template <DeviceKernel Kernel>
  void launch(const Kernel& kernel, Extent threads, Extent block) {
    const uint32_t block_threads = block.width * block.height;
    if (block_threads > default_block_threads) check_block<Kernel>(block);
    const dim3 grid((threads.width + block.width - 1) / block.width,
                    (threads.height + block.height - 1) / block.height);
    kernel_function<Kernel>()<<<grid, dim3(block.width, block.height), stack_bytes(block_threads), stream_>>>(kernel);
    check(cudaGetLastError(), "launching");
  }

 private:
  static size_t stack_bytes(uint32_t threads) {
    return static_cast<size_t>(threads) * shared_entries * shared_entry_bytes;
  }

  /// Throws InputError if the threads of a block need more registers than there are. The report's tables have no values
  /// for such blocks.
  template <DeviceKernel Kernel>
  static void check_block(Extent block) {
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, kernel_function<Kernel>()), "querying a kernel");
    const uint32_t threads = block.width * block.height;
    if (threads > static_cast<uint32_t>(attributes.maxThreadsPerBlock))
      throw InputError("a block of " + std::to_string(block.width) + "x" + std::to_string(block.height) +
                       " asks for too many registers: its " + std::to_string(threads) + " threads take " +
                       std::to_string(attributes.numRegs) + " each, and this GPU has room for " +
                       std::to_string(attributes.maxThreadsPerBlock) +
                       " such threads in a block: give a smaller --block");
    const size_t bytes = stack_bytes(threads);
    if (bytes > 48 * 1024)
      check(cudaFuncSetAttribute(kernel_function<Kernel>(), cudaFuncAttributeMaxDynamicSharedMemorySize,
                                 static_cast<int>(bytes)),
            "reserving shared memory");
  }

  int device_;
  cudaStream_t stream_ = nullptr;
};

}  // namespace alhazen::impl::cuda
