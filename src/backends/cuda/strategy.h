#pragma once

#include <cstdint>

namespace alhazen::impl::cuda {

/// How the threads of a GPU divide a pass among them (kernels/). The first is the default.
enum class CudaStrategy : uint32_t { persistent, pixel, chunk, wavefront };

}  // namespace alhazen::impl::cuda
