#pragma once

// Prefetches what the next step of a traversal reads.

#include <cstddef>

#include "core/bvh/bvh8/node.h"
#include "core/scene_view.h"

namespace ALHAZEN_CORE {

/// The arrays of the kinds of children, so that one is prefetched without a branch.
template <class Real>
class Bvh8Prefetch {
 public:
  ALHAZEN_INLINE explicit Bvh8Prefetch(const SceneView<Real>& scene)
      : begin_{bytes_of(scene.bvh8_nodes), bytes_of(scene.triangle_blocks), bytes_of(scene.sphere_blocks),
               bytes_of(scene.moving_sphere_blocks)} {}

  ALHAZEN_INLINE void operator()(uint32_t child) const {
    constexpr size_t size[4] = {sizeof(Bvh8Node), sizeof(TriangleBlock<Real>), sizeof(SphereBlock<Real>),
                                sizeof(MovingSphereBlock<Real>)};
    const char* const at = begin_[Bvh8Child::kind(child)] + Bvh8Child::first(child) * size[Bvh8Child::kind(child)];
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
    __builtin_prefetch(at + sizeof(Bvh8Node) - 1);
  }

 private:
  static const char* bytes_of(const void* array) { return static_cast<const char*>(array); }

  const char* begin_[4];
};

}  // namespace ALHAZEN_CORE
