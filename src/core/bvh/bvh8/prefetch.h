#pragma once

// Prefetches the data that the next step of a traversal reads.

#include <cstddef>

#include "core/bvh/bvh8/node.h"
#include "core/scene_view.h"

namespace ALHAZEN_CORE {

/// Prefetches a child. The array of each kind is found in a table, without a branch.
template <class Real>
class Bvh8Prefetch {
 public:
  ALHAZEN_INLINE explicit Bvh8Prefetch(const SceneView<Real>& scene)
      : begin_{bytes_of(scene.bvh8_nodes),
#define ALHAZEN_BEGIN(X, kind, Record, records, Block, blocks) bytes_of(scene.blocks),
               ALHAZEN_PRIMITIVES(ALHAZEN_BEGIN, )
#undef ALHAZEN_BEGIN
        } {
  }

  ALHAZEN_INLINE void operator()(uint32_t child) const {
    constexpr size_t size[Bvh8Child::kinds] = {sizeof(Bvh8Node),
#define ALHAZEN_SIZE(X, kind, Record, records, Block, blocks) sizeof(Block),
                                               ALHAZEN_PRIMITIVES(ALHAZEN_SIZE, )
#undef ALHAZEN_SIZE
    };
    const char* const at = begin_[Bvh8Child::kind(child)] + Bvh8Child::first(child) * size[Bvh8Child::kind(child)];
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
    __builtin_prefetch(at + sizeof(Bvh8Node) - 1);
  }

 private:
  static const char* bytes_of(const void* array) { return static_cast<const char*>(array); }

  const char* begin_[Bvh8Child::kinds];
};

}  // namespace ALHAZEN_CORE
