#pragma once

// Compiles the images, textures and materials of a scene into records.

#include <string>
#include <vector>

#include "compile/images.h"
#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

struct CompiledMaterials {
  std::vector<TextureRange> emission;  ///< programs of emission textures, by index into scene.textures
  std::vector<bool> needs_uv;          ///< by material: whether it, or a material that it mixes, uses uv
  std::vector<ImagePyramid> images;    ///< by index into scene.images
  std::vector<bool> filtered_images;
  std::vector<std::string> names;  ///< by material
  std::vector<DerivedMaterial> derived;
  CoatModel coats = CoatModel::lossless;
};

/// Fills the images, texels, texture programs and materials of `out`, and frees the texels of `scene`. Appends a
/// default material, with the index scene.materials.size(), for shapes without one. `scene` must have no cyclic mixes.
template <class Real>
CompiledMaterials compile_materials(Scene& scene, SceneArrays<Real>& out);

/// The same without texels, for images and a model of coats that are those of `before`.
template <class Real>
CompiledMaterials compile_materials_again(const Scene& scene, const CompiledMaterials& before, SceneArrays<Real>& out);

}  // namespace alhazen::impl
