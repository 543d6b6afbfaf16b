#include "pipeline/far_scene.h"

#include <limits>

#include "core/math/bounds.h"
#include "scene/default_view.h"

namespace alhazen::impl {

void warn_of_far_scene(const Scene& scene, Diagnostics& diagnostics) {
  constexpr double far = 1e6;  // from here on the points of scenes are looked at
  const double distance = max_component(abs(scene.camera.world_from_camera.start.point({})));
  if (!(distance > far)) return;
  Bounds3<double> box;
  for_each_placed_shape(scene, [&](const Shape& shape, const Transform& world_from_object) {
    for_each_point(scene, shape, world_from_object, [&](const Vec3d& p) { box.extend(p); });
  });
  const Vec3d size = box.diagonal();
  const double spacing = std::numeric_limits<double>::epsilon() * distance;
  if (!(max_component(size) >= 0 && max_component(size) < 1000 * spacing)) return;
  diagnostics.warn({scene.name},
                   "the scene is so small, and so far from the origin, that double precision does not tell its points "
                   "apart: it may be distorted or black; move it nearer to the origin");
}

}  // namespace alhazen::impl
