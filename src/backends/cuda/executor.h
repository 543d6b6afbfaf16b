#pragma once

// What runs kernels. An `Executor` is a device with one queue of work:
//   allocate(bytes), release(memory), free_bytes()          its memory; throws RenderError where there is not enough
//   upload(to, from, bytes), download(...), clear(...)      in the order of the queue; download waits for it
//   launch(kernel, threads, block)                          at least so many threads, in blocks of that size
//   resident_threads<Kernel>(block)                         how many threads of a kernel run at a time
//   wait()                                                  until the queue is empty
//   Range(name)                                             names what happens while it lives, for profilers
//   first_items                                             items of the first slice, before any speed is known
// GPUs are one (cuda_executor.cuh), the host the other (host_executor.h).

#include <cstddef>
#include <cstdint>

namespace alhazen::cuda {

struct Extent {
  uint32_t width = 1, height = 1;
};

/// Threads of a block where nobody asked for another number.
inline constexpr uint32_t usual_block = 128;

/// Memory of an executor for elements of one type.
template <class Executor, class T>
class Buffer {
 public:
  explicit Buffer(Executor& executor) : executor_(&executor) {}
  ~Buffer() { reset(); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  T* data() const { return data_; }
  size_t size() const { return size_; }
  /// Room for `size` elements or more; what was there is lost where it had less.
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

}  // namespace alhazen::cuda
