#pragma once

// Layered materials for the tests: a described material, compiled without shapes.

#include <initializer_list>
#include <string>
#include <utility>

#include "compile/materials.h"
#include "compile/scene_arrays.h"
#include "core/materials/bsdf.h"
#include "support/bsdfs.h"

namespace alhazen::impl::test {

/// The inputs of the principled material that tests vary; all others have their defaults.
struct PrincipledValues {
  double metallic = 0, roughness = 0.5, transmission = 0, clearcoat = 0, clearcoat_roughness = 0;
  double sheen = 0, sheen_roughness = 0.5, anisotropy = 0, iridescence = 0, specular = 1, ior = 1.5, dispersion = 0;
  bool thin = true;
  double colour = 1;
  double diffuse_transmission = 0, iridescence_ior = 1.3;
};

inline uint32_t constant_in(Scene& scene, double value) {
  Texture texture;
  texture.value = splat(value);
  scene.textures.push_back(texture);
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

inline Material principled_material(Scene& scene, const PrincipledValues& values) {
  Material material;
  material.kind = MaterialKind::principled;
  Principled& p = material.principled;
  p.base_colour = constant_in(scene, values.colour);
  p.metallic = constant_in(scene, values.metallic);
  p.roughness = constant_in(scene, values.roughness);
  p.specular = constant_in(scene, values.specular);
  p.transmission = constant_in(scene, values.transmission);
  p.clearcoat = constant_in(scene, values.clearcoat);
  p.clearcoat_roughness = constant_in(scene, values.clearcoat_roughness);
  p.sheen_colour = constant_in(scene, values.sheen);
  p.sheen_roughness = constant_in(scene, values.sheen_roughness);
  p.anisotropy = constant_in(scene, values.anisotropy);
  p.iridescence = constant_in(scene, values.iridescence);
  p.iridescence_ior = values.iridescence_ior;
  p.diffuse_transmission = constant_in(scene, values.diffuse_transmission);
  p.ior = values.ior;
  p.dispersion = values.dispersion;
  p.thin = values.thin;
  return material;
}

/// A compiled scene with one material and no shapes.
template <class Real>
class FlatMaterial {
 public:
  FlatMaterial(Scene& scene, const Material& material) {
    scene.materials = {material};
    compile_materials(scene, arrays_);
    view_.materials = arrays_.materials.data();
    view_.textures = arrays_.textures.data();
    view_.albedo_tables = arrays_.albedo_tables.data();
  }

  /// Returns the BSDF for that cosine of the view direction, in a tilted frame.
  Bsdf<Real> bsdf(double cosine, Real u_channel = 0) const {
    Bsdf<Real> bsdf{};
    bsdf.frame = tilted_frame<Real>();
    const Real z = static_cast<Real>(cosine);
    const auto view = [&] { return ClosureView<Real>{{safe_sqrt(1 - z * z), 0, z}, u_channel, {0, 0, 1}}; };
    make_bsdf(view_, view_.materials[0], TexturePoint<Real>{}, view, bsdf);
    return bsdf;
  }

 private:
  SceneArrays<Real> arrays_;
  SceneView<Real> view_;
};

template <class Real>
FlatMaterial<Real> principled_of(const PrincipledValues& values) {
  Scene scene;
  const Material material = principled_material(scene, values);
  return {scene, material};
}

}  // namespace alhazen::impl::test
