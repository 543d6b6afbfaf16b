#pragma once

// Runs kernels as loops on the CPU. The kernels, queues and strategies are those of a GPU, but tests and debuggers can
// inspect them. Threads run one after another, the last first, so that kernels that depend on their order are found.

#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "backends/cuda/executor.h"
#include "core/bvh/stack.h"
#include "util/diagnostics.h"

namespace alhazen::impl::cuda {

class HostThread {
 public:
  HostThread(uint32_t x, uint32_t y, uint32_t width) : x_(x), y_(y), width_(width) {}

  uint32_t x() const { return x_; }
  uint32_t y() const { return y_; }
  uint32_t index() const { return y_ * width_ + x_; }
  LocalStacks stacks() const { return {}; }
  uint32_t increment(uint32_t* counter) const { return (*counter)++; }
  void add(unsigned long long* total, uint32_t value) const { *total += value; }

 private:
  uint32_t x_, y_, width_;
};

class HostExecutor {
 public:
  /// Small, so that even small tests need more than one slice.
  static constexpr uint64_t first_items = 256;

  struct Range {
    explicit Range(const char*) {}
  };

  void* allocate(size_t bytes) {
    void* memory = std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    std::memset(memory, 0xa5, bytes);  // as on a GPU, uninitialized memory is not zero
    return memory;
  }
  void release(void* memory) { std::free(memory); }
  void upload(void* to, const void* from, size_t bytes) { std::memcpy(to, from, bytes); }
  void download(void* to, const void* from, size_t bytes) { std::memcpy(to, from, bytes); }
  void clear(void* memory, size_t bytes) { std::memset(memory, 0, bytes); }
  size_t free_bytes() const {
    return static_cast<size_t>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<size_t>(sysconf(_SC_PAGESIZE));
  }
  void wait() {}

  template <DeviceKernel Kernel>
  uint32_t resident_threads(uint32_t) {
    return 64;
  }

  template <DeviceKernel Kernel>
  void launch(const Kernel& kernel, Extent threads, Extent) {
    for (uint32_t y = threads.height; y-- > 0;)
      for (uint32_t x = threads.width; x-- > 0;) kernel(HostThread(x, y, threads.width));
  }
};

}  // namespace alhazen::impl::cuda
