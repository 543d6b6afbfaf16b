#pragma once

// The arguments of the kernels for ray queries. Nothing here depends on the instruction set for which they are
// compiled.

#include <cstdint>

#include "alhazen/rays.h"
#include "queries/primitive_origins.h"

namespace alhazen::impl {

/// Rays [first, first + count) of arrays whose numbers have the type `Number`.
template <class Number>
struct RayQueryRequest {
  const void* scene;       ///< SceneView of the precision of the kernel
  double world_origin[3];  ///< CompiledScene::world_origin
  const PrimitiveOrigins* primitives;
  const uint32_t* instances;  ///< SceneOrigins::instances
  RayArrays<Number> rays;
  HitArrays<Number> hits;  ///< of closest hits
  uint8_t* occluded;       ///< of occlusion
  size_t first, count;
};

template <class Number>
using RayQueryKernel = void (*)(const RayQueryRequest<Number>&);

}  // namespace alhazen::impl
