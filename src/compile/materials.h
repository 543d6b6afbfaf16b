#pragma once

// The part of scene compilation that makes the records of images, textures and materials.

#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// Fills images, texels, texture programs and materials of `out`; frees the texels of `scene`. A default material is
/// appended for shapes without one; its index is scene.materials.size(). Returns the programs of emission textures, by
/// index into scene.textures.
template <class Real>
std::vector<TextureRange> compile_materials(Scene& scene, SceneArrays<Real>& out);

/// By material: whether any of its textures, or of those of its mixed materials, uses uv. `scene` has no cyclic mixes.
std::vector<bool> materials_that_need_uv(const Scene& scene);

}  // namespace alhazen
