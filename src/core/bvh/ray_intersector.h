#pragma once

// What a ray query answers: one contract for the BVHs, for brute force, and for Embree and OptiX in their place.
//
//   Interval  A hit has 0 < t < t_max: both ends are open. t_max may be infinite; where it is NaN or not positive,
//             nothing is hit.
//   Left      The triangle that the ray leaves (Ray::left) is not hit; spheres are.
//   Ties      Of hits at the same t the lowest PrimitiveId counts, and of the same primitive the lowest instance. So a
//             hit does not depend on the order in which primitives are tested. Embree and OptiX return any of them.
//   NaN       A t that is NaN is no hit: a ray whose origin or direction has a component that is not finite hits
//             nothing. Components of the direction may be 0 of either sign. Box tests take NaN for a hit, since only
//             primitives say what is hit.
//   Miss      What `hit` holds after a miss is unspecified.
//
// Tests of single primitives (core/shapes/) return t in (0, t_max], so that the caller can break a tie at t_max.

#include <concepts>
#include <cstdint>

#include "core/math/ray.h"
#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// Answers queries of one ray at a time.
template <class Intersector, class Real>
concept RayIntersector = requires(const Intersector& intersector, const Ray<Real>& ray, Real t_max, Hit<Real>& hit) {
  { intersector.closest_hit(ray, t_max, hit) } -> std::same_as<bool>;
  { intersector.occluded(ray, t_max) } -> std::same_as<bool>;
};

/// What a batch is asked by: `ray(i)` and `t_max(i)` are query i, `answer(i, found, hit)` receives what it finds.
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

/// Answers many queries in one call too. `answer` is called once for each, in any order; where `any_hit` is set, its
/// `hit` is unspecified. `trace_coherent` is for closest hits of rays of which neighbours have much the same origin and
/// direction.
template <class Intersector, class Real>
concept BatchIntersector = RayIntersector<Intersector, Real> &&
    requires(const Intersector& intersector, uint32_t count, const typename BatchQueries<Real>::RayOf& ray,
             const typename BatchQueries<Real>::Limit& t_max, const typename BatchQueries<Real>::Answer& answer) {
  intersector.template trace<false>(count, ray, t_max, answer);
  intersector.template trace<true>(count, ray, t_max, answer);
  intersector.trace_coherent(count, ray, t_max, answer);
};

/// Batches by an intersector of single rays, one query after the other.
template <class Real, RayIntersector<Real> Single>
class SequentialBatches : public Single {
 public:
  using Single::Single;

  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    for (uint32_t i = 0; i < count; ++i) {
      Hit<Real> hit;
      const bool found = any_hit ? this->occluded(ray(i), t_max(i)) : this->closest_hit(ray(i), t_max(i), hit);
      answer(i, found, hit);
    }
  }

  template <class RayOf, class Limit, class Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    trace<false>(count, ray, t_max, answer);
  }
};

/// Precedes every hit at t_max in the order of `is_nearer`: where a search begins with it, t_max is open.
template <class Real>
ALHAZEN_HD Hit<Real> end_of_interval(Real t_max) {
  return {t_max, 0, 0, PrimitiveId(PrimitiveKind::triangle, 0), 0};
}

/// Whether a hit on `primitive` at t comes before `hit`, both of one space.
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE bool is_nearer(Real t, PrimitiveId primitive, const Hit<Real>& hit) {
  return t < hit.t || (t == hit.t && primitive.bits < hit.primitive.bits);
}

/// What stands for `hit.primitive` in a search within `instance`: is_nearer then breaks ties of instances too.
template <class Real>
ALHAZEN_HD PrimitiveId bound_within(uint32_t instance, const Hit<Real>& hit) {
  PrimitiveId bound = hit.primitive;
  bound.bits += instance < hit.instance ? 1 : 0;
  return bound;
}

}  // namespace ALHAZEN_CORE
