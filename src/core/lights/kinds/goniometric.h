#pragma once

// A point light scaled by an equal-area octahedral image of all directions.

#include "core/lights/image_light.h"
#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct GoniometricLight : LightBase {
  static constexpr LightTraits traits{.name = "goniometric light", .has_image = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double measure) {
    return amount * measure;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                             const Vec3<Real>& reference, const Vec3<Real>&, const Vec2<Real>&) {
    LightSample<Real> s = sample_position(light, reference, [](const Vec3<Real>&) { return Real(1); });
    if (s.is_finite)
      s.radiance = s.radiance * light_image_factor(scene, scene.light_images[light.primitive], true, -s.direction);
    return s;
  }
};

}  // namespace ALHAZEN_CORE
