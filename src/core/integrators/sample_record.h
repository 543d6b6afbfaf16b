#pragma once

// What a camera sample returns.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "core/integrators/sample_counters.h"
#include "core/math/field_list.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Radiance that a path gathers and the rays that it costs.
template <class Real>
struct PathRecord {
  Vec3<Real> radiance{};
  uint32_t segments = 0;  ///< closest-hit rays, the report's bounces
  uint32_t shadow_rays = 0;

  using Fields = FieldList<&PathRecord::radiance, &PathRecord::segments, &PathRecord::shadow_rays>;
};

/// The first surface that the camera ray hits, or that it hits after perfectly specular ones.
template <class Real>
struct FirstHit {
  Vec3<Real> albedo{}, normal{};  ///< the normal is the shading normal, in world space
  Real depth = 0;                 ///< distance from the lens, or from the specular surface before, in scene units
};

/// What integrators write to: a PathRecord that also takes the first hit, if it is wanted.
template <class Record, class Real>
concept RecordOf = std::derived_from<Record, PathRecord<Real>> && requires(Record& record, const FirstHit<Real>& hit) {
  { record.wants_first_hit() } -> std::same_as<bool>;
  record.keep_first_hit(hit);
};

template <class Real>
struct SampleRecord : PathRecord<Real> {
  FirstHit<Real> first;  ///< valid if `has_hit`
  uint32_t has_hit = 0;  ///< 1 if there is a first hit
  bool keeps_first_hit = true;
  [[no_unique_address]] RecordCounters counters;

  /// Resets the record for another sample. It assigns member by member: assigning a whole record goes through a
  /// temporary, whose stores the loads then wait for.
  ALHAZEN_HD void begin(bool wants_first_hit) {
    this->radiance = {};
    this->segments = this->shadow_rays = 0;
    has_hit = 0;
    keeps_first_hit = wants_first_hit;
  }

  /// Called by integrators at the first surface.
  ALHAZEN_HD void keep_first_hit(const FirstHit<Real>& hit) {
    first = hit;
    has_hit = 1;
  }
  ALHAZEN_HD bool wants_first_hit() const { return keeps_first_hit; }
};

}  // namespace ALHAZEN_CORE
