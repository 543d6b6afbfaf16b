#pragma once

// The same radiance from every direction. A scene has at most one, the sum of those described, and rays that escape
// find it as SceneView::background.

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct ConstantInfiniteLight : LightBase {
  static constexpr LightTraits traits{.name = "infinite light", .is_at_infinity = true, .has_size = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double) {
    return amount * pi<double>;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>& light, const Vec3<Real>&,
                                             const Vec2<Real>& u) {
    LightSample<Real> s;
    s.direction = sample_uniform_sphere(u);
    s.radiance = light.radiance;
    s.pdf = pdf_uniform_sphere<Real>;
    return s;
  }
};

}  // namespace ALHAZEN_CORE
