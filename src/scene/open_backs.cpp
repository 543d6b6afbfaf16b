#include "scene/open_backs.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/bvh/traversal.h"
#include "core/integrators/passage.h"
#include "core/sampling/warp.h"

namespace alhazen {

namespace {

/// Rows of points that are looked at on a triangle which is seen under an angle of 1; between the two numbers.
constexpr double rows_per_radian = 16;
constexpr int min_rows = 1, max_rows = 6;
/// Backs that a ray goes through before it gives up.
constexpr int max_backs = 64;
/// Of all directions from a camera in the open, how many lead out of the scene: below is the ground, and before it what
/// is looked at. From within a room few do, through its windows.
constexpr double min_open_directions = 0.4;

template <class Real>
class Eye {
 public:
  explicit Eye(const SceneView<Real>& view) : view_(view), intersector_(view) {}

  /// Where a ray of the camera towards `point` begins, without its lens; false where there is none.
  bool origin_towards(const Vec3<Real>& point, Vec3<Real>& origin) const {
    const auto& m = view_.camera.world_from_camera;
    origin = {m[0][3], m[1][3], m[2][3]};
    if (view_.camera.kind != CameraKind::orthographic) return true;
    const Vec3<Real> axis = camera_axis(view_.camera);
    const Real depth = dot(point - origin, axis);
    origin = point - axis * depth;
    return depth > 0;
  }

  bool looks_at_back_of(uint32_t index) const {
    const TriangleRecord& triangle = view_.triangles[index];
    Vec3<Real> p[3], origin;
    for (int i = 0; i < 3; ++i) p[i] = view_.positions[triangle.vertex[i]];
    const Vec3<Real> middle = (p[0] + p[1] + p[2]) * (Real(1) / 3);
    if (!origin_towards(middle, origin) || !(dot(triangle_front_normal(view_, triangle), middle - origin) > 0))
      return false;
    const Real size = std::max({length(p[1] - p[0]), length(p[2] - p[0]), length(p[2] - p[1])});
    const double angle = static_cast<double>(size / length(middle - origin));
    const bool is_perspective = view_.camera.kind != CameraKind::orthographic;
    const int rows =
        is_perspective ? static_cast<int>(std::clamp<double>(rows_per_radian * angle, min_rows, max_rows)) : max_rows;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; i + j < rows; ++j) {
        const Real b1 = (static_cast<Real>(i) + Real(1) / 3) / static_cast<Real>(rows);
        const Real b2 = (static_cast<Real>(j) + Real(1) / 3) / static_cast<Real>(rows);
        if (sees(p[0] * (1 - b1 - b2) + p[1] * b1 + p[2] * b2, index)) return true;
      }
    return false;
  }

 private:
  bool sees(const Vec3<Real>& point, uint32_t index) const {
    Ray<Real> ray;
    if (!origin_towards(point, ray.origin)) return false;
    ray.direction = normalize(point - ray.origin);
    const PrimitiveId wanted(PrimitiveKind::triangle, index);
    Hit<Real> hit;
    Real travelled = 0;
    for (int i = 0; i < max_backs && intersector_.closest_hit(ray, infinity<Real>, hit); ++i) {
      if (hit.primitive == wanted) return true;
      if (!passes(view_, hit, RayKind::camera, ray, travelled)) return false;
    }
    return false;
  }

  const SceneView<Real>& view_;
  BvhIntersector<Real> intersector_;
};

/// The surface like `surface` whose material lets all rays through.
template <class Real>
class AbsentSurfaces {
 public:
  explicit AbsentSurfaces(SceneArrays<Real>& out) : out_(out) {}

  uint32_t like(uint32_t surface) {
    const auto [entry, is_new] = surfaces_.try_emplace(surface, static_cast<uint32_t>(out_.surfaces.size()));
    if (is_new) {
      SurfaceRecord record = out_.surfaces[surface];
      record.material = material_like(record.material);
      out_.surfaces.push_back(record);
    }
    return entry->second;
  }

 private:
  uint32_t material_like(uint32_t material) {
    const auto [entry, is_new] = materials_.try_emplace(material, static_cast<uint32_t>(out_.materials.size()));
    if (is_new) {
      MaterialRecord<Real> record = out_.materials[material];
      record.features |= MaterialFeatures::cutout | MaterialFeatures::absent;
      out_.materials.push_back(record);
    }
    return entry->second;
  }

  SceneArrays<Real>& out_;
  std::map<uint32_t, uint32_t> surfaces_, materials_;
};

}  // namespace

template <class Real>
bool open_seen_backs(const SceneView<Real>& view, int threads, SceneArrays<Real>& out) {
  const uint32_t end = out.objects.empty() ? view.triangles_count : out.objects[0].first_triangle;
  std::vector<uint8_t> is_open(end);
  const Eye<Real> eye(view);
  const int team = threads > 0 ? threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 256) num_threads(team)
  for (uint32_t i = 0; i < end; ++i) {
    const SurfaceRecord& surface = view.surfaces[view.triangles[i].surface];
    const bool is_candidate =
        (view.materials[surface.material].features & MaterialFeatures::one_sided) && surface.light == no_light;
    is_open[i] = is_candidate && eye.looks_at_back_of(i);
  }
  AbsentSurfaces<Real> absent(out);
  bool any = false;
  for (uint32_t i = 0; i < end; ++i)
    if (is_open[i]) out.triangles[i].surface = absent.like(out.triangles[i].surface), any = true;
  return any;
}

template <class Real>
bool stands_in_the_open(const SceneView<Real>& view) {
  if (view.camera.kind == CameraKind::orthographic) return true;
  const auto& m = view.camera.world_from_camera;
  const BvhIntersector<Real> intersector(view);
  constexpr uint32_t directions = 256;
  uint32_t outwards = 0;
  for (uint32_t i = 0; i < directions; ++i) {
    const Vec2<Real> u{(static_cast<Real>(i) + Real(0.5)) / directions, unit_interval<Real>(reverse_bits(i))};
    Ray<Real> ray{{m[0][3], m[1][3], m[2][3]}, sample_uniform_sphere(u), Real(0)};
    Hit<Real> hit;
    Real travelled = 0;
    outwards += closest_stop(view, intersector, RayKind::camera, ray, hit, travelled) ? 0 : 1;
  }
  return outwards >= directions * min_open_directions;
}

template bool stands_in_the_open(const SceneView<float>&);
template bool stands_in_the_open(const SceneView<double>&);
template bool open_seen_backs(const SceneView<float>&, int, SceneArrays<float>&);
template bool open_seen_backs(const SceneView<double>&, int, SceneArrays<double>&);

}  // namespace alhazen
