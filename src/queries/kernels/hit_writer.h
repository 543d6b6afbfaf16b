#pragma once

// Writes what rays hit to the arrays of a caller.

#include <type_traits>

#include "core/shapes/interaction.h"
#include "queries/kernels/ray_chunk.h"
#include "queries/kernels/surface_points.h"

namespace ALHAZEN_CORE {

template <class Real, class Number>
class HitWriter {
 public:
  HitWriter(const RayQueryRequest<Number>& request, const SceneView<Real>& scene)
      : request_(&request), hits_(request.hits), scene_(&scene), rows_(*request.primitives) {}

  /// Whether anything but the parameters of hits is wanted.
  bool wants_more() const { return wants_surface() || wants_rows(); }

  /// Prefetches what `write` reads first for a hit.
  ALHAZEN_INLINE void prefetch(const Hit<Real>& hit) const {
    if (wants_rows()) __builtin_prefetch(&rows_.of(hit));
    if (wants_surface()) prefetch_primitive(*scene_, hit.primitive);
  }

  /// Writes the results of the rays of a chunk, of which the first is `first` of all.
  void write(const RayChunk<Real, Number>& rays, const ChunkHits<Real>& results, size_t first) {
    if (hits_.t)
      write_vectors<1>(hits_.t + first, rays.count,
                       [&](uint32_t i, size_t) ALHAZEN_INLINE_LAMBDA { return rays.parameter(i, results.t[i]); });
    if (hits_.primitives || hits_.shapes || hits_.instances || hits_.barycentrics)
      write_ids(results.hit, first, rays.count);
    if (!wants_surface()) return;
    const WantedOfSurface wanted{hits_.positions || hits_.offsets, hits_.uvs != nullptr};
    for (uint32_t from = 0; from < rays.count; from += points_.capacity) {
      const uint32_t some = min(points_.capacity, rays.count - from);
      points_.meet(*scene_, rays, results, from, some, rows_, wanted);
      write_surfaces(first + from, some);
    }
  }

 private:
  bool wants_surface() const {
    return hits_.positions || hits_.normals || hits_.shading_normals || hits_.offsets || hits_.uvs;
  }
  bool wants_rows() const {
    return hits_.primitives || hits_.shapes || hits_.instances || hits_.barycentrics || hits_.uvs;
  }

  ALHAZEN_NOINLINE void write_ids(const Hit<Real>* hits, size_t first, uint32_t count) const {
    uint32_t* const primitives = hits_.primitives ? hits_.primitives + first : nullptr;
    uint32_t* const shapes = hits_.shapes ? hits_.shapes + first : nullptr;
    uint32_t* const instances = hits_.instances ? hits_.instances + first : nullptr;
    Number* const barycentrics = hits_.barycentrics ? hits_.barycentrics + 2 * first : nullptr;
    for (uint32_t i = 0; i < count; ++i) {
      const Hit<Real>& hit = hits[i];
      const PrimitiveOrigin& row = rows_.of(hit);
      if (primitives) store_number(primitives + i, row.primitive);
      if (shapes) store_number(shapes + i, row.shape);
      if (instances)
        store_number(instances + i, hit.instance == no_instance ? row.instance : request_->instances[hit.instance]);
      if (!barycentrics) continue;
      const Vec2<Real> weights = described_weights(hit, row.turn);  // 0, 0 on other shapes, and of misses
      store_number(barycentrics + 2 * i, static_cast<Number>(weights.x));
      store_number(barycentrics + 2 * i + 1, static_cast<Number>(weights.y));
    }
  }

  ALHAZEN_NOINLINE void write_surfaces(size_t first, uint32_t count) {
    const double(&from)[3] = request_->world_origin;
    const auto position = [&](uint32_t i, size_t k) ALHAZEN_INLINE_LAMBDA {
      return static_cast<double>(points_.point(i).position[static_cast<int>(k)]) + from[k];
    };
    const auto if_hit = [&](uint32_t i, auto number) ALHAZEN_INLINE_LAMBDA {
      return select(points_.is_hit(i) != 0, number, decltype(number)(0));
    };
    if (hits_.positions)
      write_vectors<3>(hits_.positions + 3 * first, count,
                       [&](uint32_t i, size_t k) ALHAZEN_INLINE_LAMBDA { return if_hit(i, position(i, k)); });
    if (hits_.normals)
      write_vectors<3>(hits_.normals + 3 * first, count, [&](uint32_t i, size_t k) ALHAZEN_INLINE_LAMBDA {
        return if_hit(i, points_.point(i).normal[static_cast<int>(k)]);
      });
    if (hits_.shading_normals)
      write_vectors<3>(hits_.shading_normals + 3 * first, count, [&](uint32_t i, size_t k) ALHAZEN_INLINE_LAMBDA {
        return if_hit(i, points_.point(i).shading_normal[static_cast<int>(k)]);
      });
    if (hits_.offsets)
      write_vectors<1>(hits_.offsets + first, count, [&](uint32_t i, size_t) ALHAZEN_INLINE_LAMBDA {
        return if_hit(i, offset_of(points_.point(i), {position(i, 0), position(i, 1), position(i, 2)}));
      });
    if (hits_.uvs)
      write_vectors<2>(hits_.uvs + 2 * first, count, [&](uint32_t i, size_t k) ALHAZEN_INLINE_LAMBDA {
        const Vec2<Real> uv = points_.uv(i);
        return if_hit(i, k == 0 ? uv.x : uv.y);
      });
  }

  /// The bound on the error of the position along the normal. The caller rounds the position, the sum of it and the
  /// offset, and the origin of the next ray in render space; `offset_margin` covers the test of that ray against the
  /// same surface, which intersectors skip for the rays of a render (Ray::left).
  ALHAZEN_INLINE double offset_of(const SurfaceInteraction<Real>& si, const Vec3<double>& position) const {
    using Coarse = std::conditional_t<sizeof(Real) < sizeof(Number), Real, Number>;
    const double rounding = static_cast<double>(rounding_bound<Coarse>(3));
    const auto along = [&](Real normal, Real error, double at) ALHAZEN_INLINE_LAMBDA {
      return std::abs(static_cast<double>(normal)) * (static_cast<double>(error) + rounding * std::abs(at));
    };
    return offset_margin *
           (along(si.normal.x, si.position_error.x, position.x) + along(si.normal.y, si.position_error.y, position.y) +
            along(si.normal.z, si.position_error.z, position.z));
  }
  static constexpr double offset_margin = 4;

  const RayQueryRequest<Number>* request_;
  HitArrays<Number> hits_;
  const SceneView<Real>* scene_;
  HitRows rows_;
  SurfacePoints<Real> points_;
};

}  // namespace ALHAZEN_CORE
