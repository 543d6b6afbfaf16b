#pragma once

// The contract of ray queries. It holds for the BVHs, for brute force, and for Embree and OptiX.
//
//   Interval  A hit has 0 < t < t_max: both ends are open. t_max may be infinite. If it is NaN or not positive,
//             nothing is hit.
//   Left      The triangle that the ray starts on (Ray::left) is never hit; a sphere can be.
//   Ties      Among hits at the same t, the lowest PrimitiveId wins, then the lowest instance. The result therefore
//             does not depend on the order of the primitive tests. Embree and OptiX may return any of the tied hits.
//   NaN       A hit with a NaN t is rejected: a ray with a non-finite component in its origin or direction hits
//             nothing. Components of the direction may be +0 or -0. Box tests treat NaN as a hit; only primitive tests
//             decide what is hit.
//   Miss      After a miss, the contents of `hit` are unspecified.
//
// Tests of single primitives (core/shapes/) return t in (0, t_max], so that the caller can break a tie at t_max.

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/math/ray.h"
#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// Answers closest-hit and occlusion queries for one ray at a time.
template <class Intersector, class Real>
concept RayIntersector = requires(const Intersector& intersector, const Ray<Real>& ray, Real t_max, Hit<Real>& hit) {
  { intersector.closest_hit(ray, t_max, hit) } -> std::same_as<bool>;
  { intersector.occluded(ray, t_max) } -> std::same_as<bool>;
};

/// Return the ray and the t_max of query i.
template <class RayOf, class Real>
concept RayLookup = std::convertible_to < std::invoke_result_t<const RayOf&, uint32_t>,
const Ray<Real>& > ;
template <class Limit, class Real>
concept LimitLookup = std::is_invocable_r_v<Real, const Limit&, uint32_t>;

/// Receives the result of query i: `answer(i, found, hit)`.
template <class Answer, class Real>
concept HitReceiver = std::invocable < const Answer&,
        uint32_t, bool, const Hit<Real>
& > ;

/// The callbacks of a batch, for the concept below.
template <class Real>
struct BatchQueries {
  struct RayOf {
    const Ray<Real>& operator()(uint32_t i) const;
  };
  struct Limit {
    Real operator()(uint32_t i) const;
  };
  struct Answer {
    void operator()(uint32_t i, bool found, const Hit<Real>& hit) const;
  };
};

/// Also answers many queries in one call. `answer` is called once per query, in any order; its `hit` is unspecified for
/// any-hit queries. `trace_coherent` finds closest hits of coherent rays: neighbours have similar origins and
/// directions.
template <class Intersector, class Real>
concept BatchIntersector = RayIntersector<Intersector, Real> &&
    requires(const Intersector& intersector, uint32_t count, const typename BatchQueries<Real>::RayOf& ray,
             const typename BatchQueries<Real>::Limit& t_max, const typename BatchQueries<Real>::Answer& answer) {
  intersector.template trace<false>(count, ray, t_max, answer);
  intersector.template trace<true>(count, ray, t_max, answer);
  intersector.trace_coherent(count, ray, t_max, answer);
};

/// Implements batches with a single-ray intersector, one query after the other.
template <class Real, RayIntersector<Real> Single>
class SequentialBatches : public Single {
 public:
  using Single::Single;

  template <bool any_hit, RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    for (uint32_t i = 0; i < count; ++i) {
      Hit<Real> hit;
      const bool found = any_hit ? this->occluded(ray(i), t_max(i)) : this->closest_hit(ray(i), t_max(i), hit);
      answer(i, found, hit);
    }
  }

  template <RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    trace<false>(count, ray, t_max, answer);
  }
};

/// Returns the hit that a search starts with. In the order of `is_nearer`, it precedes every hit at t_max, which keeps
/// the interval open there.
template <class Real>
ALHAZEN_HD Hit<Real> end_of_interval(Real t_max) {
  return {t_max, 0, 0, PrimitiveId(PrimitiveKind::triangle, 0), 0};
}

/// Returns whether a hit on `primitive` at t precedes `hit`. Both must be in the same space.
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE bool is_nearer(Real t, PrimitiveId primitive, const Hit<Real>& hit) {
  return t < hit.t || (t == hit.t && primitive.bits < hit.primitive.bits);
}

/// Returns the primitive that replaces `hit.primitive` during a search within `instance`, so that is_nearer also breaks
/// ties between instances.
template <class Real>
ALHAZEN_HD PrimitiveId bound_within(uint32_t instance, const Hit<Real>& hit) {
  PrimitiveId bound = hit.primitive;
  bound.bits += instance < hit.instance ? 1 : 0;
  return bound;
}

}  // namespace ALHAZEN_CORE
