#include "compile/open_backs.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "compile/lights.h"
#include "core/bvh/bvh2/traversal.h"
#include "core/cameras/camera.h"
#include "core/integrators/transparency.h"
#include "core/sampling/warp.h"

namespace alhazen::impl {

namespace {

/// Rows of test points per radian that a triangle subtends; clamped between the two numbers.
constexpr double rows_per_radian = 16;
constexpr int min_rows = 1, max_rows = 6;
/// Maximum number of back faces that a ray passes through.
constexpr int max_backs = 64;
/// Maximum number of camera rays that search for back faces behind small openings; there is one per pixel up to this.
constexpr uint32_t max_camera_rays = 1u << 16;
/// Minimum fraction of directions that escape from a camera in the open: the ground is below and the subject in front.
/// From inside a room few do, through its windows.
constexpr double min_open_directions = 0.4;

template <class Real>
class Eye {
 public:
  explicit Eye(const SceneView<Real>& view) : view_(view), intersector_(view) {}

  /// Origin of the camera ray towards `point`, without the lens; returns false if there is none.
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
  Bvh2Intersector<Real> intersector_;
};

template <class Real>
bool has_one_side(const SceneView<Real>& view, uint32_t index) {
  return view.materials[view.surfaces[view.triangles[index].surface].material].features & MaterialFeatures::one_sided;
}

/// Returns whether the triangle may be absent.
template <class Real>
bool is_candidate(const SceneView<Real>& view, uint32_t index) {
  const SurfaceRecord& surface = view.surfaces[view.triangles[index].surface];
  const uint32_t features = view.materials[surface.material].features;
  return (features & MaterialFeatures::one_sided) && !(features & MaterialFeatures::half) && surface.light == no_light;
}

/// Marks the back faces of triangles below `end` that camera rays through pixel centres pass.
template <class Real>
void mark_backs_in_image(const SceneView<Real>& view, uint32_t width, uint32_t height, uint32_t end, int team,
                         std::vector<uint8_t>& is_open) {
  const Bvh2Intersector<Real> intersector(view);
  const double pixels = static_cast<double>(width) * height;
  const uint32_t step = static_cast<uint32_t>(std::ceil(std::sqrt(std::max(1.0, pixels / max_camera_rays))));
#pragma omp parallel for schedule(dynamic) num_threads(team)
  for (uint32_t y = step / 2; y < height; y += step)
    for (uint32_t x = step / 2; x < width; x += step) {
      const Vec2<Real> film{static_cast<Real>(x) + Real(0.5), static_cast<Real>(y) + Real(0.5)};
      Ray<Real> ray = camera_ray(view.camera, film, Vec2<Real>{Real(0.5), Real(0.5)}, Real(0));
      Hit<Real> hit;
      Real travelled = 0;
      for (int i = 0; i < max_backs && intersector.closest_hit(ray, infinity<Real>, hit); ++i) {
        const Vec3<Real> direction = ray.direction;
        if (!passes(view, hit, RayKind::camera, ray, travelled)) break;
        const uint32_t index = hit.primitive.index();
        if (hit.primitive.kind() != PrimitiveKind::triangle || index >= end || !is_candidate(view, index)) continue;
        if (!(dot(triangle_front_normal(view, view.triangles[index]), direction) > 0)) continue;
#pragma omp atomic write
        is_open[index] = 1;
      }
    }
}

/// Sets of connected triangles.
class JoinedSets {
 public:
  explicit JoinedSets(uint32_t count) : parent_(count) {
    for (uint32_t i = 0; i < count; ++i) parent_[i] = i;
  }
  uint32_t root_of(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[root_of(a)] = root_of(b); }

  /// The members of all sets that contain a marked one.
  std::vector<uint8_t> of_marked(const std::vector<uint8_t>& marked) {
    std::vector<uint8_t> has_marked(parent_.size()), members(parent_.size());
    for (uint32_t i = 0; i < parent_.size(); ++i)
      if (marked[i]) has_marked[root_of(i)] = 1;
    for (uint32_t i = 0; i < parent_.size(); ++i) members[i] = has_marked[root_of(i)];
    return members;
  }

 private:
  std::vector<uint32_t> parent_;
};

/// Triangles keyed by `points` of their corners in ascending order, and sorted so that equal keys are adjacent.
template <class Real, size_t points>
using ByCorners = std::vector<std::pair<std::array<std::array<Real, 3>, points>, uint32_t>>;

/// The triangles from `first` on for which `takes` is true, keyed by corner (`points` is 1), edge (2) or as a whole
/// (3).
template <size_t points, class Real, class Takes>
ByCorners<Real, points> by_corners(const SceneView<Real>& view, uint32_t first, uint32_t end, const Takes& takes) {
  ByCorners<Real, points> sorted;
  for (uint32_t i = first; i < end; ++i) {
    if (!takes(view, i)) continue;
    for (size_t k = 0; k < (points == 3 ? 1 : 3); ++k) {
      std::array<std::array<Real, 3>, points> corners;
      for (size_t n = 0; n < points; ++n) {
        const Vec3<Real>& p = view.positions[view.triangles[i].vertex[(k + n) % 3]];
        corners[n] = {p.x, p.y, p.z};
      }
      std::sort(corners.begin(), corners.end());
      sorted.push_back({corners, i});
    }
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Cosine of the angle below which triangles that share an edge belong to the same wall.
constexpr double min_cosine_of_wall = 0.9999;

/// Opens the walls of which a part is open: coplanar candidates that are connected by edges.
template <class Real>
void open_whole_walls(const SceneView<Real>& view, std::vector<uint8_t>& is_open) {
  const uint32_t end = static_cast<uint32_t>(is_open.size());
  const auto edges = by_corners<2>(view, 0, end, is_candidate<Real>);
  JoinedSets walls(end);
  for (size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].first != edges[i - 1].first) continue;
    const uint32_t a = edges[i].second, b = edges[i - 1].second;
    if (dot(triangle_front_normal(view, view.triangles[a]), triangle_front_normal(view, view.triangles[b])) >
        static_cast<Real>(min_cosine_of_wall))
      walls.join(a, b);
  }
  is_open = walls.of_marked(is_open);
}

/// Marks the triangles that are connected by corners, directly or by others, to an open one.
template <class Real>
std::vector<uint8_t> rooms_of(const SceneView<Real>& view, const std::vector<uint8_t>& is_open) {
  const uint32_t end = static_cast<uint32_t>(is_open.size());
  const auto corners = by_corners<1>(view, 0, end, is_candidate<Real>);
  JoinedSets rooms(end);
  for (size_t i = 1; i < corners.size(); ++i)
    if (corners[i].first == corners[i - 1].first) rooms.join(corners[i].second, corners[i - 1].second);
  std::vector<uint8_t> in_room = rooms.of_marked(is_open);
  for (uint32_t i = 0; i < end; ++i) in_room[i] = in_room[i] && !is_open[i];
  return in_room;
}

/// Returns whether the camera sees the scene from outside.
template <class Real>
bool is_in_the_open(const SceneView<Real>& view) {
  if (view.camera.kind == CameraKind::orthographic) return true;
  const auto& m = view.camera.world_from_camera;
  const Bvh2Intersector<Real> intersector(view);
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

/// Copies of surfaces whose material has an additional feature.
template <class Real>
class SurfacesWithFeature {
 public:
  SurfacesWithFeature(SceneArrays<Real>& out, uint32_t feature) : out_(out), feature_(feature) {}

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
      record.features |= MaterialFeatures::cutout | feature_;
      out_.materials.push_back(record);
    }
    return entry->second;
  }

  SceneArrays<Real>& out_;
  uint32_t feature_;
  std::map<uint32_t, uint32_t> surfaces_, materials_;
};

}  // namespace

template <class Real>
void split_coincident_sides(SceneArrays<Real>& out) {
  const SceneView<Real> view = out.view();
  std::vector<uint32_t> halves;
  const auto split = [&](uint32_t first, uint32_t end) {
    const auto placed = by_corners<3>(view, first, end, has_one_side<Real>);
    for (size_t i = 0; i + 1 < placed.size(); ++i) {
      const TriangleRecord &a = view.triangles[placed[i].second], &b = view.triangles[placed[i + 1].second];
      if (placed[i].first == placed[i + 1].first &&
          dot(triangle_front_normal(view, a), triangle_front_normal(view, b)) < 0)
        halves.insert(halves.end(), {placed[i].second, placed[i + 1].second});
    }
  };
  split(0, out.objects.empty() ? view.triangles_count : out.objects[0].first_triangle);
  for (const ObjectRecord& object : out.objects)
    split(object.first_triangle, object.first_triangle + object.triangle_count);
  SurfacesWithFeature<Real> with_half(out, MaterialFeatures::half);
  std::sort(halves.begin(), halves.end());
  halves.erase(std::unique(halves.begin(), halves.end()), halves.end());
  for (const uint32_t i : halves) out.triangles[i].surface = with_half.like(out.triangles[i].surface);
}

namespace {

/// By triangle of the world: whether it is absent, and whether it admits light from behind. Empty if no back is seen.
struct SeenBacks {
  std::vector<uint8_t> is_open, is_lit_through;
};

template <class Real>
uint32_t triangles_in_world(const SceneView<Real>& view) {
  return view.objects_count == 0 ? view.triangles_count : view.objects[0].first_triangle;
}

template <class Real>
SeenBacks find_seen_backs(const SceneView<Real>& view, uint32_t width, uint32_t height, int threads,
                          bool only_delta_lights) {
  const uint32_t end = triangles_in_world(view);
  std::vector<uint8_t> is_open(end);
  const int team = threads > 0 ? threads : omp_get_max_threads();
  mark_backs_in_image(view, width, height, end, team, is_open);
  const Eye<Real> eye(view);
#pragma omp parallel for schedule(dynamic, 256) num_threads(team)
  for (uint32_t i = 0; i < end; ++i)
    if (!is_open[i]) is_open[i] = is_candidate(view, i) && eye.looks_at_back_of(i);
  if (std::find(is_open.begin(), is_open.end(), 1) == is_open.end()) return {};
  open_whole_walls(view, is_open);
  std::vector<uint8_t> is_lit_through(end);
  if (only_delta_lights && is_in_the_open(view)) is_lit_through = rooms_of(view, is_open);
  return {std::move(is_open), std::move(is_lit_through)};
}

}  // namespace

template <class Real>
bool open_seen_backs(const SceneView<Real>& view, uint32_t width, uint32_t height, int threads,
                     SceneArrays<Real>& out) {
  const SeenBacks seen = find_seen_backs(view, width, height, threads, has_only_delta_lights(out.lights, view));
  // The view is not used from here on: it lacks the new surfaces and materials.
  SurfacesWithFeature<Real> absent(out, MaterialFeatures::absent), lit_through(out, MaterialFeatures::lit_through);
  for (size_t i = 0; i < seen.is_open.size(); ++i) {
    uint32_t& surface = out.triangles[i].surface;
    if (seen.is_open[i]) surface = absent.like(surface);
    if (seen.is_lit_through[i]) surface = lit_through.like(surface);
  }
  return !seen.is_open.empty();
}

template <class Real>
BackOpenings prepare_openings(const SceneView<Real>& view, SceneArrays<Real>& out) {
  BackOpenings backs;
  backs.has_only_delta_lights = has_only_delta_lights(out.lights, view);
  const uint32_t end = triangles_in_world(view);
  std::vector<uint8_t> is_needed(out.surfaces.size());
  for (uint32_t i = 0; i < end; ++i) {
    backs.closed.push_back(out.triangles[i].surface);
    if (is_candidate(view, i)) is_needed[backs.closed.back()] = 1;
  }
  SurfacesWithFeature<Real> absent(out, MaterialFeatures::absent), lit_through(out, MaterialFeatures::lit_through);
  for (uint32_t s = 0; s < is_needed.size(); ++s) {
    if (is_needed[s])
      backs.opened.push_back({absent.like(s), lit_through.like(s)});
    else
      backs.opened.push_back({s, s});
  }
  return backs;
}

template <class Real>
void close_backs(CompiledScene<Real>& scene) {
  const BackOpenings& backs = scene.backs;
  if (backs.closed.empty()) return;
  auto* const triangles = const_cast<TriangleRecord*>(scene.view.triangles);  // the arena is the scene's own
  for (size_t i = 0; i < backs.closed.size(); ++i) triangles[i].surface = backs.closed[i];
  scene.view.lets_light_through = backs.lets_light_through;
  ++scene.generation;
}

template <class Real>
void open_seen_backs(uint32_t width, uint32_t height, int threads, CompiledScene<Real>& scene) {
  const BackOpenings& backs = scene.backs;
  if (backs.closed.empty()) return;
  // The arena is the scene's own.
  auto* const triangles = const_cast<TriangleRecord*>(scene.view.triangles);
  close_backs(scene);
  const SeenBacks seen = find_seen_backs(scene.view, width, height, threads, backs.has_only_delta_lights);
  for (size_t i = 0; i < seen.is_open.size(); ++i) {
    const std::array<uint32_t, 2>& opened = backs.opened[backs.closed[i]];
    if (seen.is_open[i] || seen.is_lit_through[i]) triangles[i].surface = opened[seen.is_open[i] ? 0 : 1];
  }
  if (!seen.is_open.empty()) scene.view.lets_light_through = 1;
}

template void split_coincident_sides(SceneArrays<float>&);
template void split_coincident_sides(SceneArrays<double>&);
template bool open_seen_backs(const SceneView<float>&, uint32_t, uint32_t, int, SceneArrays<float>&);
template bool open_seen_backs(const SceneView<double>&, uint32_t, uint32_t, int, SceneArrays<double>&);
template BackOpenings prepare_openings(const SceneView<float>&, SceneArrays<float>&);
template BackOpenings prepare_openings(const SceneView<double>&, SceneArrays<double>&);
template void close_backs(CompiledScene<float>&);
template void close_backs(CompiledScene<double>&);
template void open_seen_backs(uint32_t, uint32_t, int, CompiledScene<float>&);
template void open_seen_backs(uint32_t, uint32_t, int, CompiledScene<double>&);

}  // namespace alhazen::impl
