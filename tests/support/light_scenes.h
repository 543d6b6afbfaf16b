#pragma once

// Scenes of many lights, and of lights with emission textures.

#include <string>
#include <utility>

#include "support/compiled_scenes.h"
#include "support/random.h"

namespace alhazen::impl::test {

inline std::string text_of(const Vec3d& v) {
  return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + " ";
}

/// `count` small lights in a box of half side 2 about (0, 0, 0): one-sided and two-sided triangles, spheres, and, if
/// `with_delta`, points and spots; some are a hundred times as bright as others.
inline std::string small_lights(int count, uint64_t seed, bool with_delta, double size = 0.1) {
  Random random(seed);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const Vec3d p = random.in_box(-2, 2), radiance = splat(random.magnitude_between(0.1, 10));
    const int kind = static_cast<int>(random.below(with_delta ? 5 : 3));
    text += "AttributeBegin ";
    if (kind < 3)
      text += "AreaLightSource \"diffuse\" \"rgb L\" [ " + text_of(radiance) + "] \"bool twosided\" " +
              (kind == 0 ? "true " : "false ");
    if (kind < 2)
      text += "Shape \"trianglemesh\" \"point3 P\" [ " + text_of(p) + text_of(p + random.on_sphere() * size) +
              text_of(p + random.on_sphere() * size) + "] \"integer indices\" [ 0 1 2 ]";
    else if (kind == 2)
      text += "Translate " + text_of(p) + "Shape \"sphere\" \"float radius\" " + std::to_string(size / 2);
    else if (kind == 3)
      text += "LightSource \"point\" \"point3 from\" [ " + text_of(p) + "] \"rgb I\" [ " +
              text_of(radiance * (size * size)) + "]";
    else
      text += "LightSource \"spot\" \"point3 from\" [ " + text_of(p) + "] \"point3 to\" [ " +
              text_of(p + random.on_sphere()) + "] \"float coneangle\" " + std::to_string(random.between(10, 170)) +
              " \"rgb I\" [ " + text_of(radiance * (size * size)) + "]";
    text += " AttributeEnd\n";
  }
  return text;
}

/// Multiplies every emission of `scene` by an image of 4 x 4 colours, half of them black.
inline Scene with_emission_texture(Scene scene) {
  ImageTexels image;
  image.width = image.height = 4;
  image.srgb = false;
  image.name = "emission";
  Random random(5);
  for (int i = 0; i < 16; ++i) {
    const bool is_lit = (i / 4 + i) % 2 == 0;
    for (int c = 0; c < 3; ++c) image.floats.push_back(is_lit ? static_cast<float>(random.between(0.2, 2)) : 0.0f);
  }
  Texture texture;
  texture.name = "emission";
  texture.kind = TextureKind::image;
  texture.image = static_cast<uint32_t>(scene.images.size());
  scene.images.push_back(std::move(image));
  const auto index = static_cast<uint32_t>(scene.textures.size());
  scene.textures.push_back(texture);
  for (ShapeGroup& group : scene.groups)
    for (Shape& shape : group.shapes)
      if (shape.emission) shape.emission->texture = index;
  return scene;
}

/// A room of diffuse and metal walls around small lights.
inline std::string room_of_lights(int count, bool with_delta, double size) {
  return R"(
    LookAt 0 -1 -5.5  0 0 0  0 1 0
    Camera "perspective" "float fov" 50
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
    AttributeBegin ReverseOrientation Shape "sphere" "float radius" 6 AttributeEnd
    Shape "trianglemesh" "point3 P" [-2.5 -2.2 -2.5  2.5 -2.2 -2.5  2.5 -2.2 2.5  -2.5 -2.2 2.5]
      "integer indices" [0 2 1 0 3 2]
    AttributeBegin
      Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.2
      Translate 0.9 -1.2 0 Shape "sphere" "float radius" 0.8
    AttributeEnd
    AttributeBegin
      Material "dielectric" "float eta" 1.5 "float roughness" 0.3
      Translate -0.9 -1.2 0 Shape "sphere" "float radius" 0.8
    AttributeEnd
)" + small_lights(count, 17, with_delta, size);
}

}  // namespace alhazen::impl::test
