#pragma once

#include <cstdint>

namespace alhazen::cuda {

/// How a pass is dealt to the threads of a GPU (kernels/). The first is the default.
enum class CudaStrategy : uint32_t { persistent, pixel, chunk, wavefront };

}  // namespace alhazen::cuda
