#pragma once

// From the described scene to the flat one: validation, transforms applied, instances placed, BVHs built.

#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace alhazen {

/// What rays are traced by. The binary tree serves tests and GPUs in double, the compressed wide one GPUs in float, the
/// SIMD one CPUs.
struct Trees {
  bool binary = true, wide = false, simd = false;
};

/// What the command line or a caller may override in the description.
struct CompileOptions {
  int64_t width = 0, height = 0;  ///< 0: as the scene says
  int threads = 0;                ///< for the BVH; 0: as OpenMP has it
  Trees trees;
  /// Instances that all together come to no more triangles than this are copied into the world, which is walked faster.
  uint64_t most_copied_triangles = 1u << 17;
  uint64_t texture_budget = 0;  ///< bytes that pictures may take; 0: any
  /// Whether a scene far from the world's origin is moved there (compile/render_space.h).
  bool in_render_space = true;
  /// How many segments paths have where `path` renders, so that light which it does not find is warned of; 0: that is
  /// not asked.
  uint32_t path_segments = 0;
};

/// Takes the description apart as it goes, so that meshes are not held twice.
/// Throws InputError for what cannot be rendered: indices out of range, coordinates that are not finite, radii that are
/// not positive, too many primitives. Warns of what is left out: triangles of no area, motion of meshes and cameras,
/// detail of pictures, light that is not found.
template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
