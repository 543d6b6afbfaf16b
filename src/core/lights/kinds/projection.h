#pragma once

// A point light that projects an image along its z axis; x points right in the image, y up.

#include "core/lights/image_light.h"
#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct ProjectionLight : LightBase {
  static constexpr LightTraits traits{.name = "projection light", .has_image = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double measure) {
    return amount * measure;
  }

  template <class Real>
  static LightCone cone(const SceneView<Real>& scene, const LightRecord<Real>& light) {
    const LightImageRecord<Real>& image = scene.light_images[light.primitive];
    const double corner = std::hypot(static_cast<double>(image.half_width), static_cast<double>(image.half_height));
    return {0, min(pi<double> / 2, std::atan(corner) + 1e-3)};
  }

  template <class Real>
  static Vec3<Real> sample_emission(const SceneView<Real>& scene, const LightRecord<Real>& light, const Vec2<Real>& u) {
    const LightImageRecord<Real>& image = scene.light_images[light.primitive];
    return normalize(
        image.axes.to_world({image.half_width * (2 * u.x - 1), image.half_height * (2 * u.y - 1), Real(1)}));
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                             const Vec3<Real>& reference, const Vec3<Real>&, const Vec2<Real>&) {
    LightSample<Real> s = sample_position(light, reference, [](const Vec3<Real>&) { return Real(1); });
    if (s.is_finite)
      s.radiance = s.radiance * light_image_factor(scene, scene.light_images[light.primitive], false, -s.direction);
    return s;
  }
};

}  // namespace ALHAZEN_CORE
