// Compiled once per instruction set, in its namespace.

#include "core/bvh/bvh8/intersector.h"
#include "isa/request.h"

namespace ALHAZEN_CORE {

namespace {

template <test::QueryMode mode, bool any_hit, class Real>
void answer(const test::QueryRequest& request) {
  const Bvh8Intersector<Real> intersector(*static_cast<const SceneView<Real>*>(request.scene));
  const auto* const rays = static_cast<const Ray<Real>*>(request.rays);
  const auto* const limits = static_cast<const Real*>(request.limits);
  auto* const hits = static_cast<Hit<Real>*>(request.hits);
  const auto ray = [&](uint32_t i) -> const Ray<Real>& { return rays[i]; };
  const auto limit = [&](uint32_t i) { return limits[i]; };
  const auto keep = [&](uint32_t i, bool found, const Hit<Real>& hit) {
    hits[i] = hit;
    request.found[i] = found;
  };
  if constexpr (mode == test::QueryMode::coherent) {
    intersector.trace_coherent(request.count, ray, limit, keep);
  } else if constexpr (mode == test::QueryMode::many) {
    intersector.template trace<any_hit>(request.count, ray, limit, keep);
  } else if constexpr (mode == test::QueryMode::interleaved) {
    if (static_cast<const SceneView<Real>*>(request.scene)->instances_count > 0)
      intersector.template trace_interleaved<any_hit, true>(request.count, ray, limit, keep);
    else
      intersector.template trace_interleaved<any_hit>(request.count, ray, limit, keep);
  } else {
    for (uint32_t i = 0; i < request.count; ++i)
      request.found[i] =
          any_hit ? intersector.occluded(rays[i], limits[i]) : intersector.closest_hit(rays[i], limits[i], hits[i]);
  }
}

template <class Real>
test::AnswerQueries select(test::QueryMode mode, bool any_hit) {
  switch (mode) {
    case test::QueryMode::coherent:
      return answer<test::QueryMode::coherent, false, Real>;
    case test::QueryMode::interleaved:
      return any_hit ? answer<test::QueryMode::interleaved, true, Real>
                     : answer<test::QueryMode::interleaved, false, Real>;
    case test::QueryMode::many:
      return any_hit ? answer<test::QueryMode::many, true, Real> : answer<test::QueryMode::many, false, Real>;
    case test::QueryMode::single:
      break;
  }
  return any_hit ? answer<test::QueryMode::single, true, Real> : answer<test::QueryMode::single, false, Real>;
}

}  // namespace

test::AnswerQueries select_answers(test::QueryMode mode, bool any_hit, bool is_double) {
  return is_double ? select<double>(mode, any_hit) : select<float>(mode, any_hit);
}

}  // namespace ALHAZEN_CORE
