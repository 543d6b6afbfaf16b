#pragma once

// What a camera sample brings back.

#include <cstddef>
#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// What a path gathers and costs.
template <class Real>
struct PathRecord {
  Vec3<Real> radiance{};
  uint32_t segments = 0;  ///< closest-hit rays, the report's bounces
  uint32_t shadow_rays = 0;
};

/// The first surface that the camera ray met.
template <class Real>
struct FirstHit {
  Vec3<Real> albedo{}, normal{};  ///< the normal is the shading normal, in world space
  Real depth = 0;                 ///< distance to it from the lens, scene units
};

template <class Real>
struct SampleRecord : PathRecord<Real> {
  FirstHit<Real> first;  ///< where `has_hit`
  uint32_t has_hit = 0;  ///< 1 where there was one
  bool keeps_first_hit = true;

  /// For another sample. Member by member: a whole one is written elsewhere first and waited for.
  ALHAZEN_HD void begin(bool wants_first_hit) {
    this->radiance = {};
    this->segments = this->shadow_rays = 0;
    has_hit = 0;
    keeps_first_hit = wants_first_hit;
  }

  /// What an integrator calls at the first surface.
  ALHAZEN_HD void keep_first_hit(const FirstHit<Real>& hit) {
    first = hit;
    has_hit = 1;
  }
  ALHAZEN_HD bool wants_first_hit() const { return keeps_first_hit; }
};

}  // namespace ALHAZEN_CORE
