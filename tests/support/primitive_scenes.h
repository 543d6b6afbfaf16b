#pragma once

// Scenes of loose primitives with default materials and lights, as targets for rays.

#include <utility>
#include <vector>

#include "support/compiled_scenes.h"
#include "support/random.h"

namespace alhazen::test {

class PrimitiveScene {
 public:
  PrimitiveScene() { scene_.meshes.emplace_back(); }

  void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    Mesh& mesh = scene_.meshes[0];
    for (const Vec3d& p : {a, b, c}) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(p);
    }
  }

  void add_mesh(const Mesh& mesh) {
    Shape shape;
    shape.mesh = static_cast<uint32_t>(scene_.meshes.size());
    scene_.meshes.push_back(mesh);
    scene_.groups[0].shapes.push_back(shape);
  }

  /// `motion` is the displacement from shutter open to shutter close.
  void add_sphere(const Vec3d& centre, double radius, const Vec3d& motion = {}) {
    Shape shape;
    shape.type = ShapeType::sphere;
    shape.radius = radius;
    shape.world_from_object = {Transform::translate(centre), Transform::translate(centre + motion)};
    scene_.groups[0].shapes.push_back(shape);
  }

  template <class Real>
  CompiledScene<Real> flat(int threads = 1) const {
    Scene copy = scene_;
    if (!copy.meshes[0].indices.empty()) {
      Shape loose;
      loose.mesh = 0;
      copy.groups[0].shapes.push_back(loose);
    }
    return compiled_scene<Real>(std::move(copy), threads);
  }

 private:
  Scene scene_;
};

/// Triangles, spheres and moving spheres of many sizes about the origin.
inline PrimitiveScene mixed_primitives(uint64_t seed, int of_each_kind) {
  Random random(seed);
  PrimitiveScene scene;
  for (int i = 0; i < of_each_kind; ++i) {
    const Vec3d p = random.in_box(-10, 10);
    const double size = random.magnitude_between(0.05, 4);
    scene.add_triangle(p, p + random.on_sphere() * size, p + random.on_sphere() * size);
    scene.add_sphere(random.in_box(-10, 10), random.magnitude_between(0.01, 1));
    scene.add_sphere(random.in_box(-10, 10), random.magnitude_between(0.01, 1), random.in_box(-2, 2));
  }
  return scene;
}

}  // namespace alhazen::test
