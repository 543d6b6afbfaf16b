#pragma once

// Executors run kernels and own device memory.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace alhazen::impl::cuda {

struct Extent {
  uint32_t width = 1, height = 1;
};

/// A device with one queue of commands: a GPU (cuda_executor.cuh) or the CPU in place of one (host_executor.h).
/// allocate() throws RenderError if there is not enough memory. upload(), download() and clear() are executed in the
/// order of the queue; download() and wait() return when the queue is empty. A Range marks its lifetime in profilers.
/// `first_items` is the number of items in the first slice, when the speed is still unknown.
template <class Executor>
concept KernelExecutor = requires(Executor& executor, const Executor& unchanged, void* memory, const void* source,
                                  size_t bytes) {
  requires std::constructible_from<typename Executor::Range, const char*>;
  { Executor::first_items } -> std::convertible_to<uint64_t>;
  { executor.allocate(bytes) } -> std::same_as<void*>;
  executor.release(memory);
  { unchanged.free_bytes() } -> std::same_as<size_t>;
  executor.upload(memory, source, bytes);
  executor.download(memory, source, bytes);
  executor.clear(memory, bytes);
  executor.wait();
};

/// An object whose operator() runs once per thread. It is copied to the device.
template <class Kernel>
concept DeviceKernel = std::is_trivially_copyable_v<Kernel>;

/// Launches at least `threads` threads of the kernel, in blocks of the given size.
template <class Executor, class Kernel>
concept LaunchesKernel = KernelExecutor<Executor> && DeviceKernel<Kernel> &&
    requires(Executor& executor, const Kernel& kernel, Extent extent) {
  executor.launch(kernel, extent, extent);
};

/// Also returns how many threads of the kernel are resident at the same time.
template <class Executor, class Kernel>
concept LaunchesResidentKernel = LaunchesKernel<Executor, Kernel> && requires(Executor& executor, uint32_t block) {
  { executor.template resident_threads<Kernel>(block) } -> std::same_as<uint32_t>;
};

/// Threads per block, unless the user asks for another number.
inline constexpr uint32_t default_block_threads = 128;

/// Owns memory of an executor for elements of one type.
template <KernelExecutor Executor, class T>
class Buffer {
 public:
  explicit Buffer(Executor& executor) : executor_(&executor) {}
  ~Buffer() { reset(); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  T* data() const { return data_; }
  size_t size() const { return size_; }
  /// Makes room for at least `size` elements. The contents are lost if the memory grows.
  void reserve(size_t size) {
    if (size <= size_) return;
    reset();
    data_ = static_cast<T*>(executor_->allocate(size * sizeof(T)));
    size_ = size;
  }
  void reset() {
    if (data_) executor_->release(data_);
    data_ = nullptr;
    size_ = 0;
  }

 private:
  Executor* executor_;
  T* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace alhazen::impl::cuda
