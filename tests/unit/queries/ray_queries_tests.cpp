// RayQueries of the public interface: from files, and what its results mean.

#include "alhazen/rays.h"

#include <gtest/gtest.h>

#include "queries/query_scene.h"
#include "support/closed_meshes.h"
#include "support/query_rays.h"

namespace alhazen::impl::test {

namespace {

RayQueries queries_of(Scene scene, Precision precision = Precision::single) {
  Diagnostics diagnostics;
  return RayQueries(std::make_shared<const QueryScene>(std::move(scene), precision, 1, diagnostics));
}

/// One triangle.
Mesh triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.indices = {0, 1, 2};
  return mesh;
}

template <class Number>
QueryHits<Number> hits_of(const RayQueries& queries, const QueryRays<Number>& rays) {
  QueryHits<Number> hits(rays.count());
  queries.closest_hits(rays.arrays(), hits.arrays(), 1);
  return hits;
}

QueryHits<double> hit_of(const RayQueries& queries, const Vec3d& origin, const Vec3d& direction) {
  QueryRays<double> rays;
  rays.add(origin, direction);
  return hits_of(queries, rays);
}

}  // namespace

TEST(RayQueries, ReadFilesOfScenes) {
  Settings settings;
  settings.precision = "double";
  const RayQueries queries = RayQueries::from_file(ALHAZEN_SOURCE_DIR "/scenes/cornell.pbrt", settings);
  EXPECT_TRUE(queries.warnings().empty());
  const Box& box = queries.bounds();
  QueryRays<double> rays;
  EXPECT_LT(box.low.x, box.high.x);
  EXPECT_LT(box.low.y, box.high.y);
  EXPECT_LT(box.low.z, box.high.z);
  const Vec3d middle{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2, (box.low.z + box.high.z) / 2};
  Random random(1);
  for (int i = 0; i < 100; ++i) rays.add(middle, random.on_sphere());
  const QueryHits<double> hits = hits_of(queries, rays);
  size_t found = 0;
  for (size_t i = 0; i < 100; ++i)
    if (!hits.is_miss(i)) {
      ++found;
      EXPECT_LT(length(middle + rays.direction(i) * hits.t[i] - hits.position(i)), 1e-9);
    }
  EXPECT_GT(found, 60u);  // the box is open at the front

  const RayQueries copy = queries;
  EXPECT_TRUE(hits_of(copy, rays) == hits);
}

TEST(RayQueries, ReportWhatIsWrongWithFilesAndSettings) {
  EXPECT_THROW(RayQueries::from_file("no-such-file.pbrt"), alhazen::InputError);
  Settings settings;
  settings.precision = "half";
  EXPECT_THROW(RayQueries::from_file(ALHAZEN_SOURCE_DIR "/scenes/cornell.pbrt", settings), alhazen::InputError);
  settings = {};
  settings.threads = -1;
  EXPECT_THROW(RayQueries::from_file(ALHAZEN_SOURCE_DIR "/scenes/cornell.pbrt", settings), alhazen::InputError);
}

TEST(RayQueries, NormalsPointToTheFront) {
  const Vec3d ahead{0, 0, -1}, back{0, 0, 1}, below{0.2, 0.2, -3}, above{0.2, 0.2, 3};
  Mesh mesh = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // counter-clockwise from +z
  EXPECT_EQ((Vec3d{0, 0, 1}), hit_of(queries_of(scene_of(mesh)), above, ahead).normal(0));
  EXPECT_EQ((Vec3d{0, 0, 1}), hit_of(queries_of(scene_of(mesh)), below, back).normal(0));
  Scene reversed = scene_of(mesh);
  reversed.groups[0].shapes[0].reverse_orientation = true;
  EXPECT_EQ((Vec3d{0, 0, -1}), hit_of(queries_of(std::move(reversed)), above, ahead).normal(0));
  mesh.normals = {{0, 0.6f, -0.8f}, {0, 0.6f, -0.8f}, {0, 0.6f, -0.8f}};
  const QueryHits<double> smooth = hit_of(queries_of(scene_of(mesh)), above, ahead);
  EXPECT_EQ((Vec3d{0, 0, -1}), smooth.normal(0));
  EXPECT_LT(length(smooth.shading_normal(0) - Vec3d{0, 0.6, -0.8}), 1e-6);
}

TEST(RayQueries, IgnoreMaterials) {
  Scene scene = scene_of(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  Texture nothing;
  nothing.value = {0, 0, 0};
  scene.textures.push_back(nothing);
  scene.materials.emplace_back();
  scene.materials[0].alpha = 0;
  scene.materials[0].double_sided = false;
  scene.groups[0].shapes[0].material = 0;
  scene.groups[0].shapes[0].emission = Emission{{1, 1, 1}};
  const RayQueries queries = queries_of(std::move(scene));
  EXPECT_NEAR(3, hit_of(queries, {0.2, 0.2, 3}, {0, 0, -1}).t[0], 1e-6);
  EXPECT_NEAR(3, hit_of(queries, {0.2, 0.2, -3}, {0, 0, 1}).t[0], 1e-6);
}

TEST(RayQueries, UvsAndBarycentricsAreInTheOrderOfTheVertices) {
  // Long triangles, whose vertices the compiler turns, in each order.
  const Vec3d corner[3] = {{0, 0, 0}, {200, 0, 0}, {0, 1, 0}};
  for (int first = 0; first < 3; ++first)
    for (const bool has_uvs : {false, true}) {
      Mesh mesh = triangle(corner[first], corner[(first + 1) % 3], corner[(first + 2) % 3]);
      if (has_uvs) mesh.uvs = {{0.5f, 0.25f}, {1, 3}, {2, -1}};
      const QueryHits<double> hit = hit_of(queries_of(scene_of(mesh), Precision::double_), {20, 0.25, 1}, {0, 0, -1});
      double weight[3];  // 0.65 of corner 0, 0.1 of corner 1, 0.25 of corner 2
      for (int i = 0; i < 3; ++i) weight[i] = std::array{0.65, 0.1, 0.25}[static_cast<size_t>(first + i) % 3];
      EXPECT_NEAR(weight[1], hit.barycentrics[0], 1e-12);
      EXPECT_NEAR(weight[2], hit.barycentrics[1], 1e-12);
      EXPECT_NEAR(has_uvs ? weight[0] * 0.5 + weight[1] + weight[2] * 2 : weight[1] + weight[2], hit.uvs[0], 1e-12);
      EXPECT_NEAR(has_uvs ? weight[0] * 0.25 + weight[1] * 3 - weight[2] : weight[2], hit.uvs[1], 1e-12);
    }
  Scene scene;
  Shape sphere;
  sphere.type = ShapeType::sphere;
  scene.groups[0].shapes.push_back(sphere);
  const QueryHits<double> hit = hit_of(queries_of(std::move(scene), Precision::double_), {0, 3, 0}, {0, -1, 0});
  EXPECT_NEAR(0.25, hit.uvs[0], 1e-12);
  EXPECT_NEAR(0.5, hit.uvs[1], 1e-12);
}

TEST(RayQueries, PositionsAreInWorldSpaceFarFromItsOrigin) {
  const Vec3d far{3e7, -2e7, 1e7};
  const RayQueries queries = queries_of(scene_of(icosphere(3), Transform::translate(far)));
  QueryRays<double> rays;
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d out = random.on_sphere();
    rays.add(far + out * 4, -out * 0.5);
  }
  const QueryHits<double> hits = hits_of(queries, rays);
  for (size_t i = 0; i < rays.count(); ++i) {
    EXPECT_NEAR(6, hits.t[i], 0.04);  // the faces are within the unit sphere
    EXPECT_LT(length(rays.origin(i) + rays.direction(i) * hits.t[i] - hits.position(i)), 1e-5);
  }
  const Box& box = queries.bounds();
  EXPECT_LT(length(Vec3d{box.low.x, box.low.y, box.low.z} - (far - splat(1.0))), 2e-2);
  EXPECT_LT(length(Vec3d{box.high.x, box.high.y, box.high.z} - (far + splat(1.0))), 2e-2);
}

/// Rays that start at positions of hits, moved by their offsets, to all directions on that side of a convex body, of
/// which they must not hit anything.
template <class Number>
void expect_escape(const Scene& scene, Precision precision, const Vec3d& middle, double radius) {
  const RayQueries queries = queries_of(Scene(scene), precision);
  Random random(6);
  QueryRays<Number> rays, leaving;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d out = random.on_sphere();
    rays.add(middle + out * (2 * radius), random.on_sphere() * (0.4 * radius) - out * radius);
  }
  const QueryHits<Number> hits = hits_of(queries, rays);
  for (size_t i = 0; i < rays.count(); ++i) {
    if (hits.is_miss(i)) continue;
    const Vec3d normal = hits.normal(i);
    const Number offset = hits.offsets[i];
    Vec3d origin;
    for (int axis = 0; axis < 3; ++axis)
      origin[axis] = static_cast<double>(hits.positions[3 * i + static_cast<size_t>(axis)] +
                                         offset * hits.normals[3 * i + static_cast<size_t>(axis)]);
    // Half of them graze the surface.
    const Vec3d side = normalize(cross(normal, random.on_sphere()));
    const double slope = i % 2 ? random.magnitude_between(1e-6, 1) : 1e-3;
    leaving.add(origin, i % 2 ? side + normal * slope : random.on_hemisphere(normal));
  }
  ASSERT_GT(leaving.count(), 4000u);
  const QueryHits<Number> again = hits_of(queries, leaving);
  size_t wrong = 0;
  for (size_t i = 0; i < leaving.count(); ++i) wrong += !again.is_miss(i);
  EXPECT_EQ(0u, wrong) << "of " << leaving.count();
}

TEST(RayQueries, OffsetsKeepRaysFromTheSurfaceThatTheyLeave) {
  Scene ball;
  Shape sphere;
  sphere.type = ShapeType::sphere;
  sphere.radius = 2;
  const Transform there = Transform::translate({50, -20, 30});
  sphere.world_from_object = {there, there};
  ball.groups[0].shapes.push_back(sphere);
  const Transform turned = Transform::translate({50, -20, 30}) * Transform::rotate(50, {1, 2, 3});
  Scene instanced = scene_of(cube());
  instanced.groups.push_back(std::move(instanced.groups[0]));
  instanced.groups[0] = {};
  Instance instance;
  instance.group = 1;
  instance.world_from_group = {turned, Transform::translate({1, 0, 0}) * turned};
  instanced.instances.push_back(instance);
  for (const Scene& scene : {scene_of(cube(), turned), scene_of(icosphere(3), turned), ball, instanced})
    for (const Precision precision : {Precision::single, Precision::double_}) {
      expect_escape<float>(scene, precision, {50, -20, 30}, 2);
      expect_escape<double>(scene, precision, {50, -20, 30}, 2);
    }
  const Vec3d far{1e6, 1e6, -1e6};
  const Transform away = Transform::translate(far) * Transform::rotate(50, {1, 2, 3});
  expect_escape<float>(scene_of(cube(), away), Precision::single, far, 2);
  expect_escape<double>(scene_of(cube(), away), Precision::single, far, 2);
}

}  // namespace alhazen::impl::test
