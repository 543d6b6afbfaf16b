// Compiled once per instruction set, in its namespace.

#include "core/bvh/bvh8/traversal.h"
#include "isa/request.h"

namespace ALHAZEN_CORE {

namespace {

template <test::Way way, bool any_hit, class Real>
void answer(const test::QueryRequest& request) {
  const SimdBvhIntersector<Real> intersector(*static_cast<const SceneView<Real>*>(request.scene));
  const auto* const rays = static_cast<const Ray<Real>*>(request.rays);
  const auto* const limits = static_cast<const Real*>(request.limits);
  auto* const hits = static_cast<Hit<Real>*>(request.hits);
  const auto ray = [&](uint32_t i) -> const Ray<Real>& { return rays[i]; };
  const auto limit = [&](uint32_t i) { return limits[i]; };
  const auto keep = [&](uint32_t i, bool found, const Hit<Real>& hit) {
    hits[i] = hit;
    request.found[i] = found;
  };
  if constexpr (way == test::Way::coherent) {
    intersector.trace_coherent(request.count, ray, limit, keep);
  } else if constexpr (way == test::Way::many) {
    intersector.template trace<any_hit>(request.count, ray, limit, keep);
  } else if constexpr (way == test::Way::in_turns) {
    if (static_cast<const SceneView<Real>*>(request.scene)->instances_count > 0)
      intersector.template trace_in_turns<any_hit, true>(request.count, ray, limit, keep);
    else
      intersector.template trace_in_turns<any_hit>(request.count, ray, limit, keep);
  } else {
    for (uint32_t i = 0; i < request.count; ++i)
      request.found[i] =
          any_hit ? intersector.occluded(rays[i], limits[i]) : intersector.closest_hit(rays[i], limits[i], hits[i]);
  }
}

template <class Real>
test::AnswerQueries select(test::Way way, bool any_hit) {
  switch (way) {
    case test::Way::coherent:
      return answer<test::Way::coherent, false, Real>;
    case test::Way::in_turns:
      return any_hit ? answer<test::Way::in_turns, true, Real> : answer<test::Way::in_turns, false, Real>;
    case test::Way::many:
      return any_hit ? answer<test::Way::many, true, Real> : answer<test::Way::many, false, Real>;
    case test::Way::one:
      break;
  }
  return any_hit ? answer<test::Way::one, true, Real> : answer<test::Way::one, false, Real>;
}

}  // namespace

test::AnswerQueries select_answers(test::Way way, bool any_hit, bool is_double) {
  return is_double ? select<double>(way, any_hit) : select<float>(way, any_hit);
}

}  // namespace ALHAZEN_CORE
