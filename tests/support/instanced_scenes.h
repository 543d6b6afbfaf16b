#pragma once

// Scenes with instances that are rotated, stretched and mirrored.

#include <utility>

#include "support/closed_meshes.h"
#include "support/compiled_scenes.h"
#include "support/random.h"

namespace alhazen::impl::test {

/// A random well-conditioned affine transform about a point of the box [-reach, reach]^3.
inline Transform random_placement(Random& random, double reach) {
  const auto factor = [&] { return random.magnitude_between(0.3, 2) * (random.below(2) == 0 ? -1 : 1); };
  return Transform::translate(random.in_box(-reach, reach)) *
         Transform::rotate(360 * random.uniform<double>(), random.on_sphere()) *
         Transform::scale({factor(), factor(), factor()}) *
         Transform::rotate(360 * random.uniform<double>(), random.on_sphere());
}

/// A group of a dented ball and a ball without shading normals, `instances` of it, and a ball in the world among them.
/// With `moving`, one instance in three moves and rotates while the shutter is open.
inline Scene instanced_scene(uint64_t seed, int instances, double reach, bool moving = false) {
  Random random(seed);
  Scene scene;
  for (const int level : {2, 1}) {
    Mesh mesh = icosphere(level);
    // The jitter is so small that stretching flips no face against its shading normals.
    jitter_radii(mesh, 0.02, random);
    if (level == 2)
      for (const Vec3d& p : mesh.positions) mesh.normals.push_back(convert<float>(normalize(p)));
    scene.meshes.push_back(std::move(mesh));
  }
  scene.groups.resize(2);
  const auto add = [&](size_t group, uint32_t mesh, const Transform& transform, bool reverse) {
    Shape shape;
    shape.mesh = mesh;
    shape.world_from_object = {transform, transform};
    shape.reverse_orientation = reverse;
    scene.groups[group].shapes.push_back(shape);
  };
  add(0, 1, Transform::scale({2, 2, 2}), false);
  add(1, 0, Transform(), false);
  add(1, 1, Transform::translate({1.5, 0, 0}) * Transform::scale({1, -1, 1}), true);
  for (int i = 0; i < instances; ++i) {
    Instance instance;
    instance.group = 1;
    const Transform placement = random_placement(random, reach);
    instance.world_from_group = {placement, placement};
    if (moving && i % 3 == 0)
      instance.world_from_group.end =
          Transform::translate(random.in_box(-2, 2)) * placement * Transform::rotate(30, random.on_sphere());
    instance.reverse_orientation = random.below(2) == 0;
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Compiles the scene with instances, or with all of them copied into the world.
template <class Real>
CompiledScene<Real> flat_instanced_scene(const Scene& scene, bool as_copies) {
  Diagnostics diagnostics;
  CompileOptions options;
  options.threads = 1;
  options.layouts = {BvhLayout::bvh2, BvhLayout::bvh8, BvhLayout::cwbvh};
  options.in_render_space = false;
  options.max_copied_triangles = as_copies ? ~uint64_t{0} : 0;
  CompiledScene<Real> flat = compile_scene<Real>(Scene(scene), options, diagnostics);
  expect_no_warnings(diagnostics);
  return flat;
}

}  // namespace alhazen::impl::test
