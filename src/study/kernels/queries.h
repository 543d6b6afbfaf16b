#pragma once

// The kernels of the study, by name. Nothing here depends on the instruction set for which they are compiled.

#include <cstdint>

namespace alhazen::impl {

enum class StudyKernel : uint32_t { path_at_a_time, linear_scan, binary_bvh };

}  // namespace alhazen::impl
