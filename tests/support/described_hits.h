#pragma once

// Closest hits by brute force over a scene's description, in double precision and without any code of the renderer.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scene/scene.h"

namespace alhazen::impl::test {

struct DescribedHit {
  double t = std::numeric_limits<double>::infinity();
  uint32_t primitive = no_index, shape = no_index, instance = no_index;
  double b1 = 0, b2 = 0;     ///< weights of the second and the third vertex
  Vec3d normal;              ///< unit, on either side
  bool is_doubtful = false;  ///< rounding may decide: an edge, a silhouette, or another surface is close by
};

/// Keeps the closest hit of a ray with what it is given, and whether anything in front of it or near it is doubtful
/// within `slack`.
class HitSearch {
 public:
  HitSearch(const Vec3d& origin, const Vec3d& direction, double slack)
      : origin_(origin), direction_(direction), slack_(slack) {}

  /// `inside` is how far the hit is within its surface, in some unit of about its size; negative: outside.
  void offer(double inside, DescribedHit hit) {
    if (!(hit.t > 0)) return;
    if (std::abs(inside) < slack_) doubts_.push_back(hit.t);
    if (inside < 0) return;
    if (std::abs(hit.t - best_.t) < slack_ * hit.t) doubts_.push_back(hit.t);
    if (hit.t < best_.t) best_ = hit;
  }
  void doubt(double t) { doubts_.push_back(t); }

  void triangle(const Vec3d (&p)[3], DescribedHit hit) {
    const Vec3d e1 = p[1] - p[0], e2 = p[2] - p[0], normal = cross(e1, e2);
    const double area = length(normal);
    if (!(area > 0)) return;
    const double slope = dot(normal, direction_);
    hit.t = dot(normal, p[0] - origin_) / slope;
    const Vec3d q = origin_ + direction_ * hit.t - p[0];
    hit.b1 = dot(cross(q, e2), normal) / (area * area);
    hit.b2 = dot(cross(e1, q), normal) / (area * area);
    hit.normal = normal / area;
    // Grazing rays are displaced in proportion.
    const double inside =
        std::min({hit.b1, hit.b2, 1 - hit.b1 - hit.b2}) * std::abs(slope) / (area * length(direction_));
    offer(inside, hit);
  }

  /// A sphere, cylinder or disk; `ray_from_world` gives its object space.
  void quadric(const Shape& shape, const Transform& object_from_world, DescribedHit hit) {
    const Vec3d o = object_from_world.point(origin_), d = object_from_world.direction(direction_);
    const bool is_disk = shape.type == ShapeType::disk, is_sphere = shape.type == ShapeType::sphere;
    const auto offer_at = [&](double t, double inside, const Vec3d& normal) {
      const Vec3d p = o + d * t;
      const double half = std::min(shape.phi_max, 360.0) / 2 * (pi<double> / 180);
      double phi = std::atan2(p.y, p.x);
      if (phi < 0) phi += 2 * pi<double>;
      if (!is_sphere && shape.phi_max < 360) inside = std::min(inside, half - std::abs(phi - half));
      hit.t = t;
      hit.normal = normalize(object_from_world.transposed().direction(normal));
      offer(inside, hit);
    };
    if (is_disk) {
      const double t = (shape.z_min - o.z) / d.z;
      const Vec3d p = o + d * t;
      const double radius = std::hypot(p.x, p.y);
      return offer_at(t, std::min(shape.radius - radius, shape.inner_radius > 0 ? radius - shape.inner_radius : 1.0),
                      {0, 0, 1});
    }
    const Vec3d mask{1, 1, is_sphere ? 1.0 : 0.0}, oq = o * mask, dq = d * mask;
    const double a = dot(dq, dq), b = dot(oq, dq), c = dot(oq, oq) - shape.radius * shape.radius;
    const double discriminant = b * b - a * c;
    if (std::abs(discriminant) < slack_ * (b * b + std::abs(a * c))) doubt(-b / a);
    if (discriminant < 0) return;
    for (const double root : {-std::sqrt(discriminant), std::sqrt(discriminant)}) {
      const double t = (-b + root) / a;
      const Vec3d p = o + d * t;
      offer_at(t, is_sphere ? 1.0 : std::min(p.z - shape.z_min, shape.z_max - p.z), p * mask);
    }
  }

  DescribedHit result() const {
    DescribedHit hit = best_;
    for (const double t : doubts_) hit.is_doubtful |= t < best_.t * (1 + slack_);
    return hit;
  }

 private:
  Vec3d origin_, direction_;
  double slack_;
  DescribedHit best_;
  std::vector<double> doubts_;
};

/// The transform of a shape at a time in [0, 1] of the shutter, whose interval must be that of the motion.
inline Transform placed_at(const MovingTransform& outer, const MovingTransform& inner, double time) {
  const Matrix4 start = (outer.start * inner.start).matrix(), end = (outer.end * inner.end).matrix();
  Matrix4 at;
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) at[i][j] = start[i][j] * (1 - time) + end[i][j] * time;
  return Transform(at);
}

inline DescribedHit described_hit(const Scene& scene, const Vec3d& origin, const Vec3d& direction, double time,
                                  double slack) {
  HitSearch search(origin, direction, slack);
  const auto visit = [&](const ShapeGroup& group, const MovingTransform& outer, uint32_t instance) {
    for (uint32_t s = 0; s < group.shapes.size(); ++s) {
      const Shape& shape = group.shapes[s];
      DescribedHit hit;
      hit.shape = s;
      hit.instance = instance;
      const Transform world_from_object = placed_at(outer, shape.world_from_object, time);
      if (shape.type != ShapeType::mesh) {
        hit.primitive = 0;
        search.quadric(shape, world_from_object.inverse(), hit);
        continue;
      }
      const Mesh& mesh = scene.meshes[shape.mesh];
      for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
        hit.primitive = i;
        Vec3d p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = world_from_object.point(mesh.positions[mesh.indices[3 * i + k]]);
        search.triangle(p, hit);
      }
    }
  };
  visit(scene.groups[0], {}, no_index);
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    visit(scene.groups[scene.instances[i].group], scene.instances[i].world_from_group, i);
  return search.result();
}

}  // namespace alhazen::impl::test
