#pragma once

// LightBase, from which the kinds of lights that are not emissive shapes derive, with defaults for what a kind may
// lack; and what sampling any light (LightSample) and rays that escape (EscapedLight) return.

#include <cstdint>

#include "core/math/frame.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

template <class Real>
struct SceneView;
template <class Real>
struct LightRecord;
template <class Real>
struct LightImageRecord;
template <class Real>
struct EnvironmentRecord;

template <class Real>
struct LightSample {
  Vec3<Real> direction{};  ///< unit, from the reference point
  Vec3<Real> radiance{};   ///< arriving along it if unoccluded
  Real pdf = 0;            ///< 0 if nothing was sampled
  bool is_delta = false;   ///< BSDF sampling cannot find the light; pdf is then the probability of the choice
  /// Whether the shadow ray ends at a point, with its error and normal; not so for infinite and distant lights.
  bool is_finite = false;
  Vec3<Real> point{}, point_error{}, normal{};

  using Fields =
      FieldList<&LightSample::direction, &LightSample::radiance, &LightSample::pdf, &LightSample::is_delta,
                &LightSample::is_finite, &LightSample::point, &LightSample::point_error, &LightSample::normal>;
};

/// What a ray that escapes finds of a light at infinity.
template <class Real>
struct EscapedLight {
  Vec3<Real> radiance{};
  Real pdf = 0;  ///< density over solid angle with which the light samples this direction, without that of its choice
};

struct LightTraits {
  const char* name = "";        ///< in messages
  bool is_at_infinity = false;  ///< else it is at a point
  bool has_size = false;        ///< whether rays can hit it
  bool has_image = false;       ///< whether it has a LightImageRecord
};

/// Bounds the directions into which a light at a point emits: those within `emission` of one that is within `normals`
/// of the light's direction, radians.
struct LightCone {
  double normals = pi<double>, emission = pi<double> / 2;
};

/// The base of the kinds. Each adds
///   static constexpr LightTraits traits;
///   static LightSample<Real> sample(const SceneView<Real>&, const LightRecord<Real>&, const Vec3<Real>& reference,
///                                   const Vec3<Real>& normal, const Vec2<Real>& u);
///     the light that arrives at a point, with a density over solid angle that excludes the choice of the light;
///     `normal` is on the side of the surface from which light must arrive, zero means any
///   static double power(const LightRecord<Real>&, double amount, double measure);
///     emitted power, W, or at infinity irradiance, W / m^2, for an `amount` of the record's radiance; `measure` is the
///     integral of the light's image over solid angle, if it has one; of a map, the part of its light that is above
///     the mean
struct LightBase {
  /// Sets what a record has beyond radiance, position and direction, from a described light (scene/scene.h).
  template <class Description, class Real>
  static void set_record(const Description&, LightRecord<Real>&) {}

  /// Of a light at a point.
  template <class Real>
  static LightCone cone(const SceneView<Real>&, const LightRecord<Real>&) {
    return {};
  }
  /// A direction in which a light at a point emits.
  template <class Real>
  static Vec3<Real> sample_emission(const SceneView<Real>&, const LightRecord<Real>&, const Vec2<Real>& u) {
    return sample_uniform_sphere(u);
  }

  /// What a ray along unit `direction`, from a surface with `normal` as in `sample`, finds of a light at infinity that
  /// has a size.
  template <class Real>
  ALHAZEN_HD static EscapedLight<Real> escaped(const SceneView<Real>&, const LightRecord<Real>&, const Vec3<Real>&,
                                               const Vec3<Real>&, bool /*wants_pdf*/) {
    return {};
  }
};

/// Samples a light at a point, whose intensity in the direction of the reference point, which is -s.direction, is
/// `falloff(s.direction)` times its radiance.
template <class Real, class Falloff>
ALHAZEN_HD LightSample<Real> sample_position(const LightRecord<Real>& light, const Vec3<Real>& reference,
                                             const Falloff& falloff) {
  LightSample<Real> s;
  const Vec3<Real> to_light = light.position - reference;
  const Real distance_squared = length_squared(to_light);
  if (!(distance_squared > 0)) return s;
  s.direction = to_light * (1 / std::sqrt(distance_squared));
  s.radiance = light.radiance * (falloff(s.direction) / distance_squared);
  s.pdf = 1;
  s.is_delta = true;
  s.is_finite = true;
  s.point = light.position;
  return s;
}

}  // namespace ALHAZEN_CORE
