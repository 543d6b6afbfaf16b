#pragma once

// The part of compiling that turns images, textures and materials into records.

#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// Fills images, texels, texture programs and materials of `out`; frees the texels of `scene`. A material is added at
/// the end for shapes that name none; its index is scene.materials.size(). Returns the programs of the textures that
/// shapes shine by, by index into scene.textures.
template <class Real>
std::vector<TextureRange> compile_materials(Scene& scene, SceneArrays<Real>& out);

/// By material: whether any texture of it, or of what it mixes, looks at uv. `scene` has no mixes of themselves.
std::vector<bool> materials_that_need_uv(const Scene& scene);

}  // namespace alhazen
