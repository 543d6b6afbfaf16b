#pragma once

// A recorded ray query, and the loops over many that are timed (rays.cpp), compiled once an instruction set.

#include <cstdint>

#include "core/math/ray.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Query {
  Ray<Real> ray;
  Real t_max;
};

}  // namespace ALHAZEN_CORE

namespace alhazen {

/// One ray a call; as many as a render has under way a call; the same for rays of which neighbours go much the same
/// way; one ray a call by Embree alone, or by our backend over it.
enum class Call : uint32_t { one, many, coherent, plain_embree, embree_backend };

/// Answers `count` queries over `scene`, a SceneView of their precision; returns how many met something.
using TraceQueries = uint64_t (*)(const void* scene, const void* tracer, const void* queries, uint32_t count,
                                  bool any_hit);

}  // namespace alhazen
