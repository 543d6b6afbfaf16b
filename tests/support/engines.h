#pragma once

// The acceleration structures, for tests that hold for each of them.

#include <gtest/gtest.h>

#include "core/bvh/bvh8/intersector.h"
#include "core/bvh/cwbvh/traversal.h"
#include "isa/queries.h"

namespace alhazen::impl::test {

template <class Any>
struct Bvh2Engine {
  using Real = Any;
  using Intersector = Bvh2Intersector<Any>;
};
struct CwbvhEngine {
  using Real = float;
  using Intersector = CwbvhIntersector<>;
};

template <class Any>
struct Bvh8Engine {
  using Real = Any;
  using Intersector = Bvh8Intersector<Any>;
};

/// The wide BVH of the CPU, as compiled for one of the instruction sets.
template <class Any, InstructionSet set>
struct IsaEngine {
  using Real = Any;
  using Intersector = IsaIntersector<Any, set>;
};

using Engines =
    ::testing::Types<Bvh2Engine<float>, Bvh2Engine<double>, CwbvhEngine, Bvh8Engine<float>, Bvh8Engine<double>,
                     IsaEngine<float, InstructionSet::avx2>, IsaEngine<double, InstructionSet::avx2>,
                     IsaEngine<float, InstructionSet::avx512>, IsaEngine<double, InstructionSet::avx512>>;

}  // namespace alhazen::impl::test
