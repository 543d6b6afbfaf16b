#pragma once

// The integrators.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class IntegratorKind : uint32_t { branching, recursive, iterative, path };

}  // namespace ALHAZEN_CORE
