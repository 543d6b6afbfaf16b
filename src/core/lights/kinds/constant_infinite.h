#pragma once

// The same radiance from every direction. Rays that escape find the sum of those described as SceneView::background.
// None is sampled: what BSDF sampling alone finds of it has less variance (see compile/environment.cpp).

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct ConstantInfiniteLight : LightBase {
  static constexpr LightTraits traits{.name = "infinite light", .is_at_infinity = true, .has_size = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double, double) {
    return 0;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>&, const Vec3<Real>&,
                                             const Vec3<Real>&, const Vec2<Real>&) {
    return {};
  }
};

}  // namespace ALHAZEN_CORE
