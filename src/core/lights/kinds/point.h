#pragma once

// A point that emits equally in all directions; its radiance is intensity, W / sr.

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct PointLight : LightBase {
  static constexpr LightTraits traits{.name = "point light"};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double) {
    return amount * 4 * pi<double>;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>& light,
                                             const Vec3<Real>& reference, const Vec3<Real>&, const Vec2<Real>&) {
    return sample_position(light, reference, [](const Vec3<Real>&) { return Real(1); });
  }
};

}  // namespace ALHAZEN_CORE
