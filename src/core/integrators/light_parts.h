#pragma once

// Parts of the radiance of a sample: by how its path was first scattered, and how often. They sum to all of it.

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// What a part is. Direct light was scattered once; emission is of what the camera sees directly.
enum class LightPart : uint32_t {
  emission,
  diffuse_direct,
  diffuse_indirect,
  specular_direct,
  specular_indirect,
  transmission_direct,
  transmission_indirect
};
inline constexpr uint32_t light_parts = 7;

/// Sums of parts.
template <class Real>
struct LightPartSums {
  Vec3<Real> radiance[light_parts]{};

  ALHAZEN_HD void add(const LightPartSums& other, Real weight = 1) {
    for (uint32_t k = 0; k < light_parts; ++k) radiance[k] += other.radiance[k] * weight;
  }
};

/// How light is scattered at the first surface: transmitted, or reflected and then diffuse by a fraction per channel.
template <class Real>
struct FirstScattering {
  Vec3<Real> diffuse{};
  bool is_transmitted = false;
};

/// Divides the radiance that a path gathers.
template <class Real>
struct PartedLight {
  LightPartSums<Real> sums;
  FirstScattering<Real> path;     ///< of the path itself
  FirstScattering<Real> sampled;  ///< of the light that is sampled at its first surface
  bool is_at_first = false;       ///< whether the light that was sampled last is

  /// Adds emission, or the background, that the path finds at its end after `vertex` surfaces.
  ALHAZEN_HD ALHAZEN_COLD void add_found(uint32_t vertex, const Vec3<Real>& radiance) {
    if (vertex == 0)
      sums.radiance[static_cast<uint32_t>(LightPart::emission)] += radiance;
    else
      add(path, vertex >= 2, radiance);
  }

  /// Adds the light that was sampled last.
  ALHAZEN_HD ALHAZEN_COLD void add_sampled(const Vec3<Real>& radiance) {
    add(is_at_first ? sampled : path, !is_at_first, radiance);
  }

 private:
  ALHAZEN_HD void add(const FirstScattering<Real>& first, bool is_indirect, const Vec3<Real>& radiance) {
    const auto part = [&](LightPart direct) -> Vec3<Real>& {
      return sums.radiance[static_cast<uint32_t>(direct) + (is_indirect ? 1u : 0u)];
    };
    if (first.is_transmitted) {
      part(LightPart::transmission_direct) += radiance;
      return;
    }
    const Vec3<Real> diffuse = radiance * first.diffuse;
    part(LightPart::diffuse_direct) += diffuse;
    part(LightPart::specular_direct) += radiance - diffuse;
  }
};

}  // namespace ALHAZEN_CORE
