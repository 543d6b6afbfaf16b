#pragma once

// Parts of the radiance of a sample: by how its path was first scattered, and how often, and by the light that it comes
// from. Each division sums to all of it.

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

/// Most groups of lights that a render tells apart.
inline constexpr uint32_t max_light_groups = 8;

template <class Real, uint32_t count>
struct RadianceSums {
  Vec3<Real> radiance[count];

  ALHAZEN_HD void add(const RadianceSums& other, Real weight = 1) {
    for (uint32_t k = 0; k < count; ++k) radiance[k] += other.radiance[k] * weight;
  }
};

template <class Real>
using LightPartSums = RadianceSums<Real, light_parts>;
template <class Real>
using LightGroupSums = RadianceSums<Real, max_light_groups>;

/// How light is scattered at the first surface: transmitted, or reflected and then diffuse by a fraction per channel.
template <class Real>
struct FirstScattering {
  Vec3<Real> diffuse{};
  bool is_transmitted = false;
};

/// Divides the radiance that a path gathers.
template <class Real>
struct PartedLight {
  LightPartSums<Real> sums{};
  LightGroupSums<Real> groups{};
  FirstScattering<Real> path;     ///< of the path itself
  FirstScattering<Real> sampled;  ///< of the light that is sampled at its first surface
  bool is_at_first = false;       ///< whether the light that was sampled last is
  uint32_t sampled_group = 0;     ///< of that light

  /// Adds emission, or the background, that the path finds after `vertex` surfaces, of a light of that group.
  ALHAZEN_HD ALHAZEN_COLD void add_found(uint32_t vertex, uint32_t group, const Vec3<Real>& radiance) {
    groups.radiance[group] += radiance;
    if (vertex == 0)
      sums.radiance[static_cast<uint32_t>(LightPart::emission)] += radiance;
    else
      add(path, vertex >= 2, radiance);
  }

  /// Adds the light that was sampled last.
  ALHAZEN_HD ALHAZEN_COLD void add_sampled(const Vec3<Real>& radiance) {
    groups.radiance[sampled_group] += radiance;
    add(is_at_first ? sampled : path, !is_at_first, radiance);
  }

  ALHAZEN_HD void expose(Real exposure) {
    for (Vec3<Real>& part : sums.radiance) part *= exposure;
    for (Vec3<Real>& group : groups.radiance) group *= exposure;
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
