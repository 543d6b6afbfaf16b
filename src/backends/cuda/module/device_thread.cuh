#pragma once

// The GPU thread that kernels receive (kernels/launch.h).

#include "core/bvh/stack.h"

namespace alhazen::impl::cuda {

/// Number of entries of a traversal stack in shared memory. The others, which few rays need, are in local memory.
inline constexpr int shared_entries = 8;
/// Size of the largest entry, that of the binary BVH in double, in bytes.
inline constexpr int shared_entry_bytes = 16;

/// Entries `i` of all threads of a block are adjacent, so that the accesses of a warp fall into different banks.
template <class Entry, int capacity>
class SharedStack {
 public:
  static_assert(sizeof(Entry) <= shared_entry_bytes && capacity > shared_entries);

  __device__ SharedStack(void* memory, uint32_t thread, uint32_t threads)
      : shared_(static_cast<Entry*>(memory) + thread), stride_(threads) {}

  __device__ int height() const { return height_; }
  __device__ void push(const Entry& entry) {
    if (height_ < shared_entries)
      shared_[height_ * stride_] = entry;
    else
      local_[height_ - shared_entries] = entry;
    ++height_;
  }
  __device__ Entry pop() {
    --height_;
    return height_ < shared_entries ? shared_[height_ * stride_] : local_[height_ - shared_entries];
  }

 private:
  Entry* shared_;
  uint32_t stride_;
  int height_ = 0;
  Entry local_[capacity - shared_entries];
};

struct SharedStacks {
  void* memory;

  template <class Entry, int capacity>
  __device__ SharedStack<Entry, capacity> make() const {
    return {memory, threadIdx.y * blockDim.x + threadIdx.x, blockDim.x * blockDim.y};
  }
};

class DeviceThread {
 public:
  __device__ explicit DeviceThread(void* shared) : shared_(shared) {}

  __device__ uint32_t x() const { return blockIdx.x * blockDim.x + threadIdx.x; }
  __device__ uint32_t y() const { return blockIdx.y * blockDim.y + threadIdx.y; }
  __device__ uint32_t index() const { return x(); }
  __device__ SharedStacks stacks() const { return {shared_}; }

  /// Lanes that increment the same counter together share one atomic operation.
  __device__ uint32_t increment(uint32_t* counter) const {
    const unsigned peers = __match_any_sync(__activemask(), reinterpret_cast<unsigned long long>(counter));
    const int leader = __ffs(static_cast<int>(peers)) - 1;
    const unsigned below = peers & ((1u << lane()) - 1u);
    uint32_t first = 0;
    if (static_cast<int>(lane()) == leader) first = atomicAdd(counter, static_cast<uint32_t>(__popc(peers)));
    return __shfl_sync(peers, first, leader) + static_cast<uint32_t>(__popc(below));
  }

  __device__ void add(unsigned long long* total, uint32_t value) const {
#if __CUDA_ARCH__ >= 800
    const unsigned peers = __activemask();
    const uint32_t sum = __reduce_add_sync(peers, value);
    if (static_cast<int>(lane()) == __ffs(static_cast<int>(peers)) - 1) atomicAdd(total, sum);
#else
    atomicAdd(total, static_cast<unsigned long long>(value));
#endif
  }

 private:
  __device__ static unsigned lane() { return (threadIdx.y * blockDim.x + threadIdx.x) % 32u; }

  void* shared_;
};

}  // namespace alhazen::impl::cuda
