#pragma once

// A disk at infinity about one direction, with the same radiance everywhere on it. Unlike a distant light it has a
// size: rays can hit it, so shadows have penumbrae and glass and mirrors show it and cast its caustics.

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct SunLight : LightBase {
  static constexpr LightTraits traits{.name = "distant light", .is_at_infinity = true, .has_size = true};

  /// A description has the irradiance at normal incidence, W / m^2, which is radiance times pi sin^2 of the disk's
  /// angular radius; the record has the radiance. The parameters are 1 minus the cosine of that radius, computed
  /// without cancellation, and the density of samples, one over the solid angle.
  template <class Description, class Real>
  static void set_record(const Description& description, LightRecord<Real>& light) {
    const double radius = description.cone_angle * pi<double> / 180;
    const double one_minus_cosine = 2 * sqr(std::sin(radius / 2));
    light.radiance = convert<Real>(description.radiance * (1 / (pi<double> * sqr(std::sin(radius)))));
    light.parameters = {static_cast<Real>(one_minus_cosine),
                        static_cast<Real>(1 / (2 * pi<double> * one_minus_cosine))};
  }

  template <class Real>
  static double power(const LightRecord<Real>& light, double amount, double) {
    const double one_minus_cosine = static_cast<double>(light.parameters.x);
    return amount * pi<double> * one_minus_cosine * (2 - one_minus_cosine);
  }

  /// Samples the cone uniformly over solid angle.
  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>& light, const Vec3<Real>&,
                                             const Vec3<Real>&, const Vec2<Real>& u) {
    LightSample<Real> s;
    const Real height = u.x * light.parameters.x;  // 1 minus the cosine
    const Real sine = safe_sqrt(height * (2 - height));
    const auto [sine_phi, cosine_phi] = sine_cosine_of_turn(2 * pi<Real> * u.y);
    s.direction = frame_about(-light.direction).to_world({sine * cosine_phi, sine * sine_phi, 1 - height});
    s.radiance = light.radiance;
    s.pdf = light.parameters.y;
    return s;
  }

  /// The squared distance of two unit vectors is 2 minus twice their cosine; unlike that it is exact for small angles.
  template <class Real>
  ALHAZEN_HD static EscapedLight<Real> escaped(const SceneView<Real>&, const LightRecord<Real>& light,
                                               const Vec3<Real>&, const Vec3<Real>& direction, bool) {
    if (!(length_squared(direction + light.direction) <= 2 * light.parameters.x)) return {};
    return {light.radiance, light.parameters.y};
  }
};

}  // namespace ALHAZEN_CORE
