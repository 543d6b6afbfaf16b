#pragma once

// The part of flattening that turns images, textures and materials into records.

#include <vector>

#include "scene/scene.h"
#include "scene/scene_arrays.h"

namespace alhazen {

/// Fills images, texels, texture programs and materials of `out`; frees the texels of `scene`. A material is added at
/// the end for shapes that name none; its index is scene.materials.size(). Returns the programs of the textures that
/// shapes shine by, by index into scene.textures.
template <class Real>
std::vector<TextureRange> flatten_materials(Scene& scene, SceneArrays<Real>& out);

/// The mixes among materials, each behind the mixes that it is made of. `of_itself` receives one that is made of
/// itself, where there is one (the order is cut short then), else no_index.
std::vector<uint32_t> order_of_mixes(const std::vector<Material>& materials, uint32_t& of_itself);

/// Throws where mixes are made of themselves.
void check_mixes(const Scene& scene);

/// By material: whether any texture of it, or of what it mixes, looks at uv. `scene` has no mixes of themselves.
std::vector<bool> materials_that_need_uv(const Scene& scene);

}  // namespace alhazen
