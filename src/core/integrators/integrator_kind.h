#pragma once

// The integrators.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// `guided_path` is `path` with guiding (core/guiding); renders are of the kind `path` then, and only some of their
/// passes are guided.
enum class IntegratorKind : uint32_t { branching, recursive, iterative, path, guided_path };

/// Returns whether the integrator is a path tracer that samples lights.
ALHAZEN_HD constexpr bool samples_lights(IntegratorKind kind) {
  return kind == IntegratorKind::path || kind == IntegratorKind::guided_path;
}

}  // namespace ALHAZEN_CORE
