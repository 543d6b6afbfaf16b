#pragma once

// Other lights, and other transforms of shapes and instances, in a compiled scene.

#include "compile/built_parts.h"
#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// What may be different from what was compiled. All else of the description is as it was.
struct SceneChanges {
  bool lights = false;      ///< lights, their number too, and the emission of shapes
  bool light_maps = false;  ///< environment maps, and images of lights
  bool transforms = false;  ///< of shapes and instances
};

/// Compiles again what depends on the changes: records of lights and how they are chosen among, with maps only if these
/// have changed; what has moved, and the tree of the world, but no trees of objects. The scene is then as
/// compile_scene would make it. `outline` is the description without the arrays of meshes, and without texels unless
/// maps have changed; the meshes of what has moved come from `meshes`. Returns false where that does not do, and all
/// must be compiled anew: if the scene is in another render space; if shapes with one-sided materials have moved, or
/// others so that other triangles have no area; if groups become objects or cease to be; if shapes of objects have
/// moved; if surfaces begin or cease to emit; and if names or groups of lights change that layers show. The scene may
/// then be half changed, as it may if InputError is thrown as by compile_scene.
template <class Real>
bool update_scene(const SceneChanges& changes, const std::vector<Mesh>& meshes, Scene&& outline,
                  CompiledScene<Real>& scene, BuiltParts<Real>& parts);

/// Searches again for light that paths of `path_segments` do not find (compile/lost_light.h) and keeps what to warn of.
/// Returns false where that takes a tree that the scene does not have.
template <class Real>
bool find_lost_light_again(uint32_t path_segments, CompiledScene<Real>& scene, BuiltParts<Real>& parts);

}  // namespace alhazen::impl
