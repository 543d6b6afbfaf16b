#pragma once

// Evaluates textures: one switch over the kinds, and a stack for nested nodes.

#include "core/scene_view.h"
#include "core/textures/image.h"
#include "core/textures/texture_list.h"

namespace ALHAZEN_CORE {

/// A node at a point, as the kinds see it.
template <class Real>
struct TextureNode {
  const SceneView<Real>& scene;
  const TextureRecord<Real>& record;
  const TexturePoint<Real>& at;

  ALHAZEN_HD Vec3<Real> parameters() const { return record.parameters; }
  ALHAZEN_HD uint32_t number() const { return record.number; }
  ALHAZEN_HD Vec2<Real> st() const { return map_texture(scene, mapping(), at); }
  ALHAZEN_HD Vec3<Real> point() const { return map_solid(mapping(), at.position); }
  ALHAZEN_HD Vec3<Real> normal() const { return at.normal; }
  ALHAZEN_HD Vec3<Real> image() const {
    KnownOfPoint<Real>& known = at.known;
    if (known.image != record.image || known.mapping != record.mapping) {
      known.value = lookup_filtered(scene, record.image, mapping(), at);
      known.image = record.image, known.mapping = record.mapping;
    }
    return known.value;
  }
  ALHAZEN_HD auto vertex_colour() const { return mesh_colour(scene, at.hit); }
  ALHAZEN_HD const uint8_t* permutation() const { return scene.noise_permutation; }

 private:
  ALHAZEN_HD const TextureMapping<Real>& mapping() const { return scene.texture_mappings[record.mapping]; }
};

/// The value of one node; `inputs` are the values of its input textures.
template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_texture_node(const SceneView<Real>& scene, const TextureRecord<Real>& record,
                                            const TexturePoint<Real>& at, const Vec3<Real>* inputs) {
  const TextureNode<Real> node{scene, record, at};
  switch (record.kind) {
#define ALHAZEN_CASE(name, Name) \
  case TextureKind::name:        \
    return Name##Texture::evaluate(node, inputs);
    ALHAZEN_TEXTURES(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return {};
}

/// Evaluates textures that are not constant. It is not inlined: GPU compilers would copy it into each of its many
/// callers.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD Vec3<Real> evaluate_texture_nodes(const SceneView<Real>& scene, TextureRange range,
                                                          const TexturePoint<Real>& at) {
  const TextureRecord<Real>* nodes = scene.textures + range.first;
  if (range.count == 1) return evaluate_texture_node(scene, nodes[0], at, static_cast<const Vec3<Real>*>(nullptr));
  Vec3<Real> stack[max_texture_stack];
  uint32_t height = 0;
  for (uint32_t i = 0; i < range.count; ++i) {
    height -= texture_input_count(nodes[i].kind);
    stack[height] = evaluate_texture_node(scene, nodes[i], at, stack + height);
    ++height;
  }
  return stack[0];
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> evaluate_texture(const SceneView<Real>& scene, TextureRange range,
                                                   const TexturePoint<Real>& at) {
  const TextureRecord<Real>& first = scene.textures[range.first];
  if (range.count == 1 && first.kind == TextureKind::constant) return first.parameters;
  return evaluate_texture_nodes(scene, range, at);
}

}  // namespace ALHAZEN_CORE
