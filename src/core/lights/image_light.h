#pragma once

// Delta lights whose intensity is given by an image of all directions (goniometric) or by a projected one (projection).

#include "core/lights/kinds/light_base.h"
#include "core/lights/sphere_mapping.h"

namespace ALHAZEN_CORE {

/// The texel at (x, y), which may be one beyond the edges: an octahedral image continues as the sphere does, a
/// projected one repeats its edge.
template <class Real>
ALHAZEN_HD Vec3<Real> light_texel(const SceneView<Real>& scene, const LightImageRecord<Real>& image, bool is_sphere,
                                  int x, int y) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  const Texel at = is_sphere ? texel_of_sphere(SphereMapping::octahedral, x, y, width, height)
                             : Texel{clamp(x, 0, width - 1), clamp(y, 0, height - 1)};
  const float* t = scene.texel_floats + image.first_texel +
                   3 * (static_cast<uint64_t>(at.y) * image.width + static_cast<uint64_t>(at.x));
  return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
}

/// Factor on the light's intensity along unit `direction`; texels are interpolated.
template <class Real>
ALHAZEN_HD Vec3<Real> light_image_factor(const SceneView<Real>& scene, const LightImageRecord<Real>& image,
                                         bool is_sphere, const Vec3<Real>& direction) {
  const Vec3<Real> d = image.axes.to_local(direction);
  Vec2<Real> uv{};
  if (is_sphere) {
    uv = octahedral_of_direction(d);
  } else {
    if (!(d.z > Real(1e-3))) return {};
    uv = {Real(0.5) + Real(0.5) * d.x / (d.z * image.half_width),
          Real(0.5) - Real(0.5) * d.y / (d.z * image.half_height)};
  }
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return {};
  const Real x = uv.x * static_cast<Real>(image.width) - Real(0.5);
  const Real y = uv.y * static_cast<Real>(image.height) - Real(0.5);
  const Real fx = std::floor(x), fy = std::floor(y);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const auto texel = [&](int i, int j) { return light_texel(scene, image, is_sphere, ix + i, iy + j); };
  return lerp(lerp(texel(0, 0), texel(1, 0), x - fx), lerp(texel(0, 1), texel(1, 1), x - fx), y - fy);
}

}  // namespace ALHAZEN_CORE
