#pragma once

// What a camera sample returns.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "core/integrators/light_parts.h"
#include "core/integrators/sample_counters.h"
#include "core/math/field_list.h"
#include "core/math/vec.h"
#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// Radiance that a path gathers and the rays that it costs.
template <class Real>
struct PathRecord {
  Vec3<Real> radiance{};
  Real transparency = 0;  ///< fraction of the background that is seen: 1 if the camera ray hits nothing
  uint32_t segments = 0;  ///< closest-hit rays, the report's bounces
  uint32_t shadow_rays = 0;
  PartedLight<Real>* parts = nullptr;  ///< if not null, receives the radiance too; not stored with the path

  /// Adds the light that was sampled last.
  ALHAZEN_HD ALHAZEN_HOT void add_sampled(const Vec3<Real>& sampled) {
    radiance += sampled;
    if (parts) parts->add_sampled(sampled);
  }
  /// Ends the sample: multiplies what was gathered by the exposure.
  ALHAZEN_HD void expose(Real exposure) {
    radiance *= exposure;
    if (parts) parts->expose(exposure);
  }

  using Fields =
      FieldList<&PathRecord::radiance, &PathRecord::transparency, &PathRecord::segments, &PathRecord::shadow_rays>;
};

/// The first surface that the camera ray hits, or that it hits after perfectly specular ones.
template <class Real>
struct FirstHit {
  Vec3<Real> albedo{}, normal{};  ///< the normal is the shading normal, in world space
  Real depth = 0;                 ///< distance from the lens, or from the specular surface before, in scene units
};

/// Where the camera ray hits its first surface, which may be specular.
template <class Real>
struct FirstPoint {
  Vec3<Real> position{};      ///< in render space
  Vec3<Real> displacement{};  ///< of this point of the surface, from shutter open to shutter close, in world space
  Vec2<Real> uv{};
  uint32_t object_id = no_id, material_id = no_id;
};

/// What integrators write to: a PathRecord that also takes the first hit and the first point, if they are wanted.
template <class Record, class Real>
concept RecordOf = std::derived_from<Record, PathRecord<Real>> &&
    requires(Record& record, const FirstHit<Real>& hit, const FirstPoint<Real>& point) {
  { record.wants_first_hit() } -> std::same_as<bool>;
  { record.wants_first_point() } -> std::same_as<bool>;
  record.keep_first_hit(hit);
  record.keep_first_point(point);
};

/// Which of them are wanted.
struct WantedRecords {
  bool first_hit = true, first_point = false;
};

template <class Real>
struct SampleRecord : PathRecord<Real> {
  FirstHit<Real> first;          ///< valid if `has_hit`
  FirstPoint<Real> first_point;  ///< valid if `has_point`
  uint32_t has_hit = 0;          ///< 1 if there is a first hit
  uint32_t has_point = 0;        ///< 1 if there is a first point
  WantedRecords wanted;
  [[no_unique_address]] RecordCounters counters;

  /// Resets the record for another sample. It assigns member by member: assigning a whole record goes through a
  /// temporary, whose stores the loads then wait for.
  ALHAZEN_HD void begin(const WantedRecords& records) {
    this->radiance = {};
    this->transparency = 0;
    this->segments = this->shadow_rays = 0;
    has_hit = has_point = 0;
    wanted = records;
  }

  /// Called by integrators at the first surface.
  ALHAZEN_HD void keep_first_hit(const FirstHit<Real>& hit) {
    first = hit;
    has_hit = 1;
  }
  ALHAZEN_HD void keep_first_point(const FirstPoint<Real>& point) {
    first_point = point;
    has_point = 1;
  }
  ALHAZEN_HD bool wants_first_hit() const { return wanted.first_hit; }
  ALHAZEN_HD bool wants_first_point() const { return wanted.first_point; }
};

}  // namespace ALHAZEN_CORE
