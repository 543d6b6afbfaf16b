#pragma once

// Light from a single direction; its radiance is irradiance at normal incidence, W / m^2.

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct DistantLight : LightBase {
  static constexpr LightTraits traits{.name = "distant light", .is_at_infinity = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double) {
    return amount;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>& light, const Vec3<Real>&,
                                             const Vec3<Real>&, const Vec2<Real>&) {
    LightSample<Real> s;
    s.direction = -light.direction;
    s.radiance = light.radiance;
    s.pdf = 1;
    s.is_delta = true;
    return s;
  }
};

}  // namespace ALHAZEN_CORE
