#pragma once

// A point light with a falloff about its direction; its radiance is the intensity on the axis, W / sr.

#include "core/lights/kinds/light_base.h"

namespace ALHAZEN_CORE {

struct SpotLight : LightBase {
  static constexpr LightTraits traits{.name = "spot light"};

  /// The parameters are the cosines of the cone's edge and of the start of the falloff.
  template <class Description, class Real>
  static void set_record(const Description& description, LightRecord<Real>& light) {
    const auto cosine = [](double degrees) { return static_cast<Real>(std::cos(degrees * pi<double> / 180)); };
    light.parameters = {cosine(description.cone_angle), cosine(min(description.falloff_start, description.cone_angle))};
  }

  template <class Real>
  static double power(const LightRecord<Real>& light, double amount, double) {
    return amount * 2 * pi<double> * (1 - 0.5 * static_cast<double>(light.parameters.x + light.parameters.y));
  }

  template <class Real>
  static LightCone cone(const SceneView<Real>&, const LightRecord<Real>& light) {
    const double outer = std::acos(static_cast<double>(light.parameters.x));
    // Parts of a wide cone are more than 90 degrees from its axis.
    const double normals = max(0.0, outer - pi<double> / 2 + 2e-3);
    return {normals, min(pi<double> / 2, outer - normals + 1e-3)};
  }

  template <class Real>
  static Vec3<Real> sample_emission(const SceneView<Real>&, const LightRecord<Real>& light, const Vec2<Real>& u) {
    const Real cosine = 1 - u.x * (1 - light.parameters.x), sine = safe_sqrt(1 - cosine * cosine);
    const auto [sine_phi, cosine_phi] = sine_cosine_of_turn(2 * pi<Real> * u.y);
    return frame_about(light.direction).to_world({sine * cosine_phi, sine * sine_phi, cosine});
  }

  /// Smooth falloff from 1 at the inner cosine to 0 at the outer one.
  template <class Real>
  ALHAZEN_HD static Real falloff(const LightRecord<Real>& light, Real cos_angle) {
    const Real outer = light.parameters.x, inner = light.parameters.y;
    if (cos_angle <= outer) return 0;
    if (cos_angle >= inner) return 1;
    const Real x = (cos_angle - outer) / (inner - outer);
    return x * x * (3 - 2 * x);
  }

  template <class Real>
  ALHAZEN_HD static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>& light,
                                             const Vec3<Real>& reference, const Vec3<Real>&, const Vec2<Real>&) {
    return sample_position(light, reference,
                           [&](const Vec3<Real>& d) { return falloff(light, -dot(d, light.direction)); });
  }
};

}  // namespace ALHAZEN_CORE
