#pragma once

// Scenes of loose primitives with default materials and lights, as targets for rays.

#include <utility>
#include <vector>

#include "support/compiled_scenes.h"
#include "support/random.h"

namespace alhazen::impl::test {

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

  /// `world` places the cylinder of radius 1 about the z axis, with z from -1 to 1 and azimuths up to `phi_max`
  /// degrees.
  void add_cylinder(const Transform& world, double phi_max = 360) {
    Shape shape;
    shape.type = ShapeType::cylinder;
    shape.phi_max = phi_max;
    shape.world_from_object = {world, world};
    scene_.groups[0].shapes.push_back(shape);
  }

  /// `world` places the disk of radius 1 about the z axis, at this height, with azimuths up to `phi_max` degrees.
  void add_disk(const Transform& world, double inner_radius = 0, double phi_max = 360, double height = 0) {
    Shape shape;
    shape.type = ShapeType::disk;
    shape.inner_radius = inner_radius;
    shape.z_min = shape.z_max = height;
    shape.phi_max = phi_max;
    shape.world_from_object = {world, world};
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

/// A rotation, and a scale by factors of 1/3 to 3 along the axes; one in two is mirrored.
inline Transform random_stretch(Random& random) {
  const auto factor = [&] { return random.magnitude_between(1.0 / 3, 3) * (random.below(2) == 0 ? 1 : -1); };
  const double x = factor(), y = factor();
  return Transform::rotate(random.between(0, 360), random.on_sphere()) * Transform::scale({x, y, factor()});
}

/// The cylinder of radius 1 and height 2, scaled to about `size` along three directions that are not perpendicular.
inline Transform random_cylinder(const Vec3d& centre, double size, Random& random) {
  const Transform stretch = Transform::scale(splat(size)) * random_stretch(random);
  return Transform::translate(centre) * stretch * random_stretch(random);
}

/// Triangles, spheres, moving spheres, cylinders and disks of many sizes about the origin.
inline PrimitiveScene mixed_primitives(uint64_t seed, int of_each_kind) {
  Random random(seed), random_of_cylinders(seed + 1), random_of_disks(seed + 2);
  PrimitiveScene scene;
  for (int i = 0; i < of_each_kind; ++i) {
    const Vec3d p = random.in_box(-10, 10);
    const double size = random.magnitude_between(0.05, 4);
    scene.add_triangle(p, p + random.on_sphere() * size, p + random.on_sphere() * size);
    scene.add_sphere(random.in_box(-10, 10), random.magnitude_between(0.01, 1));
    scene.add_sphere(random.in_box(-10, 10), random.magnitude_between(0.01, 1), random.in_box(-2, 2));
    const Vec3d centre = random_of_cylinders.in_box(-10, 10);
    const double radius = random_of_cylinders.magnitude_between(0.01, 1);
    scene.add_cylinder(random_cylinder(centre, radius, random_of_cylinders),
                       i % 2 == 0 ? 360 : random_of_cylinders.between(1, 360));
    const Vec3d middle = random_of_disks.in_box(-10, 10);
    const double extent = random_of_disks.magnitude_between(0.01, 1);
    scene.add_disk(random_cylinder(middle, extent, random_of_disks), i % 3 == 0 ? 0.4 : 0,
                   i % 2 == 0 ? 360 : random_of_disks.between(1, 360));
  }
  return scene;
}

}  // namespace alhazen::impl::test
