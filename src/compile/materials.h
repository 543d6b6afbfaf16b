#pragma once

// The part of scene compilation that makes the records of images, textures and materials.

#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

struct CompiledMaterials {
  std::vector<TextureRange> emission;  ///< programs of emission textures, by index into scene.textures
  std::vector<bool> needs_uv;          ///< by material: whether it, or one that it mixes, uses uv
};

/// Fills images, texels, texture programs and materials of `out`; frees the texels of `scene`. A default material is
/// appended for shapes without one; its index is scene.materials.size(). `scene` has no cyclic mixes.
template <class Real>
CompiledMaterials compile_materials(Scene& scene, SceneArrays<Real>& out);

}  // namespace alhazen
