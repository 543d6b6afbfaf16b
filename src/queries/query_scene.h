#pragma once

// A scene that answers ray queries: the geometry of a description, compiled in one precision.

#include <string>
#include <variant>
#include <vector>

#include "alhazen/rays.h"
#include "compile/compiled_scene.h"
#include "queries/primitive_origins.h"
#include "render/sample_kernel.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

class QueryScene {
 public:
  /// Uses the shapes and instances of `scene`, and the shutter of its camera; it may have no valid materials, lights or
  /// film. `threads` build the BVH; 0: all processors. Throws what compile_scene throws. Keeps the warnings of
  /// `diagnostics` and its own.
  QueryScene(Scene&& scene, Precision precision, int threads, Diagnostics& diagnostics);

  /// What RayQueries says of them. Another instruction set gives the same results.
  template <class Number>
  void closest_hits(const RayArrays<Number>& rays, const HitArrays<Number>& hits, int threads,
                    InstructionSet set = instruction_sets().back()) const;
  template <class Number>
  void occluded(const RayArrays<Number>& rays, uint8_t* occluded, int threads,
                InstructionSet set = instruction_sets().back()) const;

  const Box& bounds() const { return bounds_; }
  const std::vector<alhazen::Warning>& warnings() const { return warnings_; }

 private:
  template <class Real>
  void compile(Scene&& scene, int threads, Diagnostics& diagnostics);
  template <class Number>
  void answer(const RayArrays<Number>& rays, const HitArrays<Number>& hits, uint8_t* occluded, int threads,
              InstructionSet set) const;

  std::variant<CompiledScene<float>, CompiledScene<double>> compiled_;
  PrimitiveOrigins origins_;  ///< instead of compiled_'s of triangles and surfaces
  Box bounds_;
  std::vector<alhazen::Warning> warnings_;
};

}  // namespace alhazen::impl
