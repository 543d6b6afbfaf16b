#pragma once

// Ray queries: the closest hits of arrays of rays with a scene, or whether anything occludes them.
//
//   alhazen::RayQueries queries(scene);  // or RayQueries::from_file("scene.pbrt")
//   std::vector<float> origins(3 * n), directions(3 * n), t(n), normals(3 * n);
//   alhazen::RayArrays<float> rays{origins.data(), directions.data(), n};
//   alhazen::HitArrays<float> hits;
//   hits.t = t.data();
//   hits.normals = normals.data();
//   queries.closest_hits(rays, hits);
//
// All positions and directions are in the world space of the scene, in its unit of length.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/geometry.h"
#include "alhazen/version.h"

namespace alhazen::impl {
class QueryScene;
}

namespace ALHAZEN_NAMESPACE {

class Scene;

/// Rays to trace, in arrays of the caller. A hit at the parameter t, at origin + t * direction, counts if
/// 0 < t < t_max: both ends are open.
///
/// A ray hits nothing if its origin, direction or time has a NaN or infinite component, its direction is zero, or its
/// t_max is NaN or not positive.
template <class Real>
struct RayArrays {
  const Real* origins = nullptr;     ///< x, y, z of each ray
  const Real* directions = nullptr;  ///< x, y, z of each ray, of any length above 0
  size_t count = 0;                  ///< number of rays
  const Real* t_max = nullptr;       ///< null: infinite
  /// In [0, 1]: when the shutter opens and closes; clamped to that. Null: 0. Only moving shapes depend on it.
  const Real* times = nullptr;
  /// Number of elements from the value of a ray to that of the next, in each array. 0: all rays have the same, so one
  /// is enough. The three components of a vector are next to each other.
  std::ptrdiff_t origin_stride = 3, direction_stride = 3, t_max_stride = 1, time_stride = 1;
};

/// An index that does not exist.
inline constexpr uint32_t invalid_id = 0xffffffffu;

/// Where to write what the rays hit. Each array has room for all rays, without gaps; null if it is not wanted, which
/// saves its time. After a miss t is infinity, ids are invalid_id, and everything else is 0.
template <class Real>
struct HitArrays {
  Real* t = nullptr;  ///< in units of the length of the direction: the hit is at origin + t * direction
  /// x, y, z of the hit, on the surface: more accurate than origin + t * direction. Positions keep some rounding errors
  /// of distance from the edges of triangles, so that rays which start there do not slip through an edge.
  Real* positions = nullptr;
  Real* normals = nullptr;  ///< x, y, z: unit geometric normal on the front of the surface, whichever side is hit
  /// x, y, z: unit interpolated vertex normal; the geometric one where there are none. Normal maps do not count.
  Real* shading_normals = nullptr;
  /// How far to move a position along its normal, or against it, to start another ray on that side: then the ray does
  /// not hit the surface that it starts on by rounding. See docs/rays.md.
  Real* offsets = nullptr;
  Real* uvs = nullptr;           ///< u, v of the first set; a mesh without has (0, 0), (1, 0), (1, 1) in each triangle
  Real* barycentrics = nullptr;  ///< weights of the second and third vertex of the triangle; 0, 0 on other shapes
  /// Index of the triangle in its mesh as the file, its reader or MeshArrays::indices gives it, triangles without area
  /// counted; 0 on other shapes. Stretched spheres and some cylinders and disks are traced as meshes, whose triangles
  /// then count.
  uint32_t* primitives = nullptr;
  /// Index of the shape, in the order of the file or in which shapes were added: among the shapes of the group (pbrt:
  /// object) that is instanced if `instances` is valid, otherwise among those that are not part of a group.
  ///
  /// Of a Scene that has not changed since, the shape is the ShapeId `scene.shapes(group)[shape]`, where the group is
  /// `scene.instance(scene.instances()[instance]).group`, or GroupId() if there is no instance. Its mesh, if it is one,
  /// is the MeshId `std::get<MeshId>(scene.shape(id).geometry)`.
  uint32_t* shapes = nullptr;
  /// Index of the instance, in the order of the file or in which instances were added: `scene.instances()[instance]` is
  /// its InstanceId. invalid_id if there is none.
  uint32_t* instances = nullptr;
};

/// Answers ray queries on a scene. Its methods can be called by several threads at the same time. Copies share the
/// scene.
///
/// Queries see geometry alone: both sides of every surface are hit, whatever its material, and opacities (cutouts) are
/// ignored. They run on CPUs, in the precision in which the scene was built (Settings::precision); arrays of the other
/// precision are converted.
///
/// The result of a ray depends on neither the other rays, the number of threads, nor the instruction set.
class RayQueries {
 public:
  /// Reads a scene in any format that `render` reads, and builds a BVH. Of `settings`, only `precision`, `threads`, and
  /// those that choose what is read (confine, search_paths, strict, variant, animation, animation_time, shutter,
  /// frames_per_second, definitions) matter. Throws what `render` throws for a bad scene.
  static RayQueries from_file(const std::string& scene_file, const Settings& settings = {},
                              const ProgressFunction& progress = {});

  /// Builds a BVH of a copy of the scene's geometry: the scene may be changed and destroyed afterwards, which the
  /// queries do not see. Of `settings`, only `precision` and `threads` matter. Results are the same as those of
  /// `from_file` if the scene was loaded from that file and not changed. Throws InputError for these settings out of
  /// range, and for geometry that cannot be represented in this precision.
  explicit RayQueries(const Scene& scene, const Settings& settings = {}, const ProgressFunction& progress = {});

  /// For scenes that are built within the library.
  explicit RayQueries(std::shared_ptr<const impl::QueryScene> scene);

  // There is no moved-from state: moving copies.
  RayQueries(const RayQueries&) = default;
  RayQueries& operator=(const RayQueries&) = default;

  /// Finds the closest hit of every ray, or that it misses everything. `threads` is the maximum number of threads; 0:
  /// all processors. Throws InputError, before it writes anything, if `origins` or `directions` is null although there
  /// are rays, or `threads` is negative.
  ///
  /// The arrays must not overlap, and outlive only the call. They need not be aligned.
  void closest_hits(const RayArrays<float>& rays, const HitArrays<float>& hits, int threads = 0) const;
  void closest_hits(const RayArrays<double>& rays, const HitArrays<double>& hits, int threads = 0) const;

  /// Writes 1 for every ray that hits anything, and 0 for the others. It is faster than closest_hits. Throws the same,
  /// also if `occluded` is null although there are rays.
  void occluded(const RayArrays<float>& rays, uint8_t* occluded, int threads = 0) const;
  void occluded(const RayArrays<double>& rays, uint8_t* occluded, int threads = 0) const;

  /// A box that contains all surfaces at all times. If there are none, its low is infinity and its high -infinity.
  const Box& bounds() const;

  /// Of the scene reader and of building.
  const std::vector<Warning>& warnings() const;

 private:
  std::shared_ptr<const impl::QueryScene> scene_;
};

}  // namespace ALHAZEN_NAMESPACE
