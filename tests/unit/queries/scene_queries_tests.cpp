// Ray queries of scenes in memory: the same as of their files, and hits that lead back to the handles of the scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "alhazen/rays.h"
#include "alhazen/scene.h"
#include "support/query_rays.h"

namespace alhazen::impl::test {

namespace {

QueryHits<double> hits_of(const RayQueries& queries, const QueryRays<double>& rays) {
  QueryHits<double> hits(rays.count());
  queries.closest_hits(rays.arrays(), hits.arrays(), 1);
  return hits;
}

/// The shape at (x, y), looked for from z = 10 downwards.
ShapeId shape_below(const alhazen::Scene& scene, double x, double y) {
  QueryRays<double> rays;
  rays.add({x, y, 10}, {0, 0, -1});
  const QueryHits<double> hits = hits_of(RayQueries(scene), rays);
  if (hits.is_miss(0)) return {};
  const uint32_t instance = hits.instances[0];
  const GroupId group = instance == invalid_id ? GroupId() : scene.instance(scene.instances().at(instance)).group;
  return scene.shapes(group).at(hits.shapes[0]);
}

alhazen::Shape ball_at(double x, double y, MaterialId material = {}) {
  return {alhazen::Sphere{0.4}, material, alhazen::Transform::translate({x, y, 0})};
}

}  // namespace

TEST(SceneQueries, AreThoseOfTheFile) {
  const char* const file = ALHAZEN_SOURCE_DIR "/scenes/weekend.pbrt";
  const QueryRays<double> rays = random_rays<double>(2000, 12, 3);
  for (const char* const precision : {"float", "double"}) {
    Settings settings;
    settings.precision = precision;
    const RayQueries of_file = RayQueries::from_file(file, settings);
    const RayQueries of_scene(alhazen::Scene::load(file), settings);
    const QueryHits<double> hits = hits_of(of_scene, rays);
    EXPECT_TRUE(hits == hits_of(of_file, rays)) << precision;
    EXPECT_FALSE(std::all_of(hits.t.begin(), hits.t.end(), [](double t) { return std::isinf(t); }));
    EXPECT_EQ(of_scene.bounds().low, of_file.bounds().low);
    EXPECT_EQ(of_scene.bounds().high, of_file.bounds().high);
  }
}

TEST(SceneQueries, LeadToTheHandlesOfShapesAndInstances) {
  alhazen::Scene scene;
  const std::vector<double> positions{-1, -1, -1, 1, -1, -1, 0, 1, -1};
  const std::vector<uint32_t> indices{0, 1, 2};
  const MeshId mesh = scene.add(MeshArrays{.positions = positions, .indices = indices});
  const MaterialId red = scene.add(alhazen::Diffuse{.reflectance = {0.8, 0.1, 0.1}});
  const ShapeId removed = scene.add(ball_at(-5, 5));
  const ShapeId first = scene.add(ball_at(5, 0));
  const GroupId pair = scene.add_group();
  const ShapeId left = scene.add(ball_at(-0.5, 0), pair);
  const ShapeId triangle = scene.add(alhazen::Shape{mesh, red});
  const ShapeId right = scene.add(ball_at(0.5, 0, red), pair);
  const InstanceId gone =
      scene.add(alhazen::Instance{.group = pair, .transform = alhazen::Transform::translate({0, -20, 0})});
  const InstanceId placed =
      scene.add(alhazen::Instance{.group = pair, .transform = alhazen::Transform::translate({0, 8, 0})});
  EXPECT_EQ(shape_below(scene, -5, 5), removed);
  scene.remove(removed);
  scene.remove(gone);
  EXPECT_EQ(shape_below(scene, -5, 5), ShapeId());
  EXPECT_EQ(shape_below(scene, 5, 0), first);
  EXPECT_EQ(shape_below(scene, 0, 0), triangle);
  EXPECT_EQ(std::get<MeshId>(scene.shape(shape_below(scene, 0, 0)).geometry), mesh);
  EXPECT_EQ(shape_below(scene, -0.5, 8), left);
  EXPECT_EQ(shape_below(scene, 0.5, 8), right);
  EXPECT_EQ(scene.instances(), std::vector<InstanceId>{placed});
  EXPECT_EQ(scene.shapes(pair), (std::vector<ShapeId>{left, right}));
  EXPECT_EQ(scene.shapes(GroupId()), (std::vector<ShapeId>{first, triangle}));
}

TEST(SceneQueries, AreOfTheSceneAsItWas) {
  alhazen::Scene scene;
  const ShapeId ball = scene.add(ball_at(0, 0));
  const RayQueries before(scene);
  scene.set_transform(ball, alhazen::Transform::translate({3, 0, 0}));
  QueryRays<double> rays;
  rays.add({0, 0, 10}, {0, 0, -1});
  EXPECT_FALSE(hits_of(before, rays).is_miss(0));
  EXPECT_TRUE(hits_of(RayQueries(scene), rays).is_miss(0));
}

TEST(SceneQueries, OfNothingHitNothing) {
  const RayQueries queries{alhazen::Scene()};
  EXPECT_TRUE(queries.bounds().is_empty());
  const QueryRays<double> rays = random_rays<double>(100, 2, 5);
  for (const double t : hits_of(queries, rays).t) EXPECT_TRUE(std::isinf(t));
}

TEST(SceneQueries, RefuseSettingsOutOfRange) {
  const alhazen::Scene scene;
  Settings settings;
  settings.precision = "half";
  EXPECT_THROW(RayQueries(scene, settings), alhazen::InputError);
  settings.precision = "double";
  settings.threads = -1;
  EXPECT_THROW(RayQueries(scene, settings), alhazen::InputError);
}

}  // namespace alhazen::impl::test
