#pragma once

// A recorded ray query, and the timed loops over many of them (rays.cpp), compiled once per instruction set.

#include <cstdint>

#include "core/math/ray.h"
#include "render/kernels/request.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Query {
  Ray<Real> ray;
  Real t_max;
};

}  // namespace ALHAZEN_CORE

namespace alhazen::impl {

/// One ray per call; as many per call as a render traces at a time; the same as coherent packets; one ray per call by
/// Embree alone, or by our backend over it.
enum class Call : uint32_t { one, many, coherent, plain_embree, embree_backend };

/// Answers `count` queries over `scene`, a SceneView of their precision; returns the number of hits.
using TraceQueries = uint64_t (*)(const void* scene, const ExternalTracer* tracer, const void* queries, uint32_t count,
                                  bool any_hit);

}  // namespace alhazen::impl
