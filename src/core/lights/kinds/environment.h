#pragma once

// Radiance from every direction, given by a map; the radiance of the record is the mean over all directions. Samples
// are of what exceeds the mean, and so is its power.

#include "core/lights/environment.h"
#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct EnvironmentLight : LightBase {
  static constexpr LightTraits traits{.name = "infinite light", .is_at_infinity = true, .has_size = true};

  template <class Real>
  static double power(const LightRecord<Real>&, double amount, double excess) {
    return amount * pi<double> * excess;
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                             const Vec3<Real>&, const Vec3<Real>& normal, const Vec2<Real>& u) {
    LightSample<Real> s;
    const EnvironmentSample<Real> e = sample_environment(scene, scene.environments[light.primitive], normal, u);
    s.direction = e.direction;
    s.radiance = e.radiance;
    s.pdf = e.pdf;
    return s;
  }

  template <class Real>
  ALHAZEN_HD static EscapedLight<Real> escaped(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                               const Vec3<Real>& normal, const Vec3<Real>& direction, bool wants_pdf) {
    const EnvironmentSample<Real> e =
        evaluate_environment_and_pdf(scene, scene.environments[light.primitive], normal, direction, wants_pdf);
    return {e.radiance, e.pdf};
  }
};

}  // namespace ALHAZEN_CORE
