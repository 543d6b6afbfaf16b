#pragma once

// Writes what rays hit to the arrays of a caller.

#include <type_traits>

#include "core/shapes/interaction.h"
#include "queries/kernels/ray_chunk.h"

namespace ALHAZEN_CORE {

template <class Real, class Number>
class HitWriter {
 public:
  HitWriter(const RayQueryRequest<Number>& request, const SceneView<Real>& scene)
      : request_(&request), hits_(request.hits), scene_(&scene) {}

  bool wants_surface() const {
    return hits_.positions || hits_.normals || hits_.shading_normals || hits_.offsets || hits_.uvs;
  }
  bool wants_records() const { return wants_surface() || hits_.shapes || hits_.instances; }

  /// Writes the results of the rays of a chunk, of which the first is `first` of all.
  void write(const RayChunk<Real, Number>& rays, const ChunkHits<Real>& results, size_t first) const {
    const uint32_t count = rays.count;
    const bool* const found = results.found;
    const Hit<Real>* const hits = results.hit;
    if (hits_.primitives || hits_.barycentrics)
      for (uint32_t i = 0; i < count; ++i)
        if (found[i] && is_triangle(hits[i])) __builtin_prefetch(request_->triangles + hits[i].primitive.index());
    if (hits_.t)
      for (uint32_t i = 0; i < count; ++i)
        store_number(hits_.t + first + i, found[i] ? rays.parameter(i, hits[i].t) : infinity<Number>);
    if (hits_.barycentrics)
      for (uint32_t i = 0; i < count; ++i) write_barycentrics(first + i, found[i], hits[i]);
    if (hits_.primitives)
      for (uint32_t i = 0; i < count; ++i)
        store_number(hits_.primitives + first + i, found[i] ? primitive_of(hits[i]) : invalid_id);
    if (hits_.shapes || hits_.instances)
      for (uint32_t i = 0; i < count; ++i) write_ids(first + i, found[i], hits[i]);
    if (!wants_surface()) return;
    constexpr uint32_t ahead = 8;
    for (uint32_t i = 0; i < count; ++i) {
      if (i + ahead < count && found[i + ahead]) prefetch_vertices(*scene_, hits[i + ahead].primitive);
      if (found[i])
        write_surface(first + i, rays.rays[i], hits[i]);
      else
        clear_surface(first + i);
    }
  }

 private:
  /// The weights of the vertices of a triangle, in the order of the description.
  struct Weights {
    Real of[3];
  };

  Weights weights_of(const Hit<Real>& hit) const {
    const uint32_t turn = request_->triangles[hit.primitive.index()].turn;
    const Real b[3] = {1 - hit.b1 - hit.b2, hit.b1, hit.b2};
    return {{b[(3 - turn) % 3], b[(4 - turn) % 3], b[(5 - turn) % 3]}};
  }

  static bool is_triangle(const Hit<Real>& hit) { return hit.primitive.kind() == PrimitiveKind::triangle; }

  uint32_t primitive_of(const Hit<Real>& hit) const {
    return is_triangle(hit) ? request_->triangles[hit.primitive.index()].index : 0;
  }

  void write_barycentrics(size_t ray, bool found, const Hit<Real>& hit) const {
    const Weights weights = found && is_triangle(hit) ? weights_of(hit) : Weights{};
    write_vector<2>(hits_.barycentrics, ray, {weights.of[1], weights.of[2]});
  }

  void write_ids(size_t ray, bool found, const Hit<Real>& hit) const {
    ShapeOrigin origin;
    if (found) origin = request_->surfaces[surface_of(*scene_, hit.primitive)];
    if (found && hit.instance != no_instance) origin.instance = request_->instances[hit.instance];
    if (hits_.shapes) store_number(hits_.shapes + ray, origin.shape);
    if (hits_.instances) store_number(hits_.instances + ray, origin.instance);
  }

  void write_surface(size_t ray, const Ray<Real>& of, const Hit<Real>& hit) const {
    SurfaceInteraction<Real> si;
    meet_surface(*scene_, of, hit, si);
    const double position[3] = {static_cast<double>(si.position.x) + request_->world_origin[0],
                                static_cast<double>(si.position.y) + request_->world_origin[1],
                                static_cast<double>(si.position.z) + request_->world_origin[2]};
    if (hits_.positions) write_vector<3>(hits_.positions, ray, position);
    if (hits_.normals) write_vector<3>(hits_.normals, ray, {si.normal.x, si.normal.y, si.normal.z});
    if (hits_.shading_normals)
      write_vector<3>(hits_.shading_normals, ray, {si.shading_normal.x, si.shading_normal.y, si.shading_normal.z});
    if (hits_.offsets) write_vector<1>(hits_.offsets, ray, {offset_of(si, position)});
    if (hits_.uvs) {
      Vec2<Real> uv = si.uv;
      if (is_triangle(hit) && scene_->surfaces[si.surface].uv_offset == no_offset) {
        const Weights weights = weights_of(hit);  // of (0, 0), (1, 0), (1, 1)
        uv = {weights.of[1] + weights.of[2], weights.of[2]};
      }
      write_vector<2>(hits_.uvs, ray, {uv.x, uv.y});
    }
  }

  /// The bound on the error of the position along the normal. The caller rounds the position, the sum of it and the
  /// offset, and the origin of the next ray in render space; `offset_margin` covers the test of that ray against the
  /// same surface, which intersectors skip for the rays of a render (Ray::left).
  double offset_of(const SurfaceInteraction<Real>& si, const double (&position)[3]) const {
    using Coarse = std::conditional_t<sizeof(Real) < sizeof(Number), Real, Number>;
    const double rounding = static_cast<double>(rounding_bound<Coarse>(3));
    const auto along = [&](Real normal, Real error, double at) {
      return std::abs(static_cast<double>(normal)) * (static_cast<double>(error) + rounding * std::abs(at));
    };
    return offset_margin * (along(si.normal.x, si.position_error.x, position[0]) +
                            along(si.normal.y, si.position_error.y, position[1]) +
                            along(si.normal.z, si.position_error.z, position[2]));
  }
  static constexpr double offset_margin = 4;

  void clear_surface(size_t ray) const {
    if (hits_.positions) write_vector<3>(hits_.positions, ray, {0, 0, 0});
    if (hits_.normals) write_vector<3>(hits_.normals, ray, {0, 0, 0});
    if (hits_.shading_normals) write_vector<3>(hits_.shading_normals, ray, {0, 0, 0});
    if (hits_.offsets) write_vector<1>(hits_.offsets, ray, {0});
    if (hits_.uvs) write_vector<2>(hits_.uvs, ray, {0, 0});
  }

  template <size_t size, class Component = Real>
  static void write_vector(Number* to, size_t ray, const Component (&vector)[size]) {
    for (size_t k = 0; k < size; ++k) store_number(to + ray * size + k, static_cast<Number>(vector[k]));
  }

  const RayQueryRequest<Number>* request_;
  HitArrays<Number> hits_;
  const SceneView<Real>* scene_;
};

}  // namespace ALHAZEN_CORE
