// Scenes far from the origin are translated to it, with everything that has a position. Others remain unchanged.

#include "compile/render_space.h"

#include "support/compiled_scenes.h"

namespace alhazen::impl::test {
namespace {

/// One thing of every kind that has a position, about the world's origin moved by `to`, seen by a camera 5 away.
Scene scene_at(const Vec3d& to) {
  const std::string place = std::to_string(to.x) + " " + std::to_string(to.y) + " " + std::to_string(to.z);
  return described_scene("LookAt 0 -5 0  0 0 0  0 0 1\nTranslate " + std::to_string(-to.x) + " " +
                         std::to_string(-to.y) + " " + std::to_string(-to.z) + R"(
Camera "perspective"
WorldBegin
ObjectBegin "object"
Shape "trianglemesh" "point3 P" [ -1 0 0  1 0 0  0 0 1 ] "integer indices" [ 0 1 2 ]
ObjectEnd
Translate )" + place + R"(
LightSource "point" "point3 from" [ 1 2 3 ]
LightSource "spot" "point3 from" [ 3 2 1 ] "point3 to" [ 0 0 0 ]
LightSource "distant" "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ]
Texture "veins" "spectrum" "marble"
Material "diffuse" "texture reflectance" "veins"
Shape "sphere"
Shape "trianglemesh" "point3 P" [ -1 0 0  1 0 0  0 0 1 ] "integer indices" [ 0 1 2 ]
ObjectInstance "object"
)");
}

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.z, b.z, 1e-6);
}

/// The positions of everything relative to the camera.
std::vector<Vec3d> places(const Scene& scene) {
  const Vec3d camera = scene.camera.world_from_camera.start.point({});
  std::vector<Vec3d> all;
  for (const Shape& shape : scene.groups[0].shapes) all.push_back(shape.world_from_object.start.point({}) - camera);
  for (const Instance& instance : scene.instances) all.push_back(instance.world_from_group.end.point({}) - camera);
  for (const Light& light : scene.lights)
    if (light.kind != LightKind::distant) all.push_back(light.position - camera);
  for (const Texture& texture : scene.textures)
    if (texture.kind == TextureKind::marble) all.push_back(texture.texture_from_world.point(camera));
  return all;
}

TEST(RenderSpace, EverythingThatHasAPositionMovesWithTheCamera) {
  Scene far = scene_at({3e6, -2e6, 1e6});
  move_to_render_space(far);
  expect_near(far.camera.world_from_camera.start.point({}), {});
  const std::vector<Vec3d> moved = places(far), near = places(scene_at({}));
  ASSERT_EQ(moved.size(), near.size());
  ASSERT_EQ(near.size(), 6u);
  for (size_t i = 0; i < near.size(); ++i) expect_near(moved[i], near[i]);
  expect_near(far.lights.back().direction, scene_at({}).lights.back().direction);
}

TEST(RenderSpace, ScenesNearTheOriginStay) {
  for (const Vec3d& to : {Vec3d{}, Vec3d{20, 10, 0}}) {
    Scene scene = scene_at(to);
    move_to_render_space(scene);
    const Scene before = scene_at(to);
    EXPECT_TRUE(scene.camera.world_from_camera.start == before.camera.world_from_camera.start);
    EXPECT_TRUE(scene.groups[0].shapes[0].world_from_object.start ==
                before.groups[0].shapes[0].world_from_object.start);
    EXPECT_TRUE(scene.lights[0].position == before.lights[0].position);
  }
}

TEST(RenderSpace, ASceneSeenFromFarAwayIsMovedByItsCentre) {
  Scene scene = scene_at({3e6, 0, 0});
  // As far from the scene as the scene is from the origin.
  scene.camera.world_from_camera.start = scene.camera.world_from_camera.end = Transform::translate({6e6, 0, 0});
  move_to_render_space(scene);
  EXPECT_LT(length(scene.groups[0].shapes[0].world_from_object.start.point({})), 10);
  expect_near(scene.camera.world_from_camera.start.point({}) - scene.lights[0].position, {3e6 - 1, -2, -3});
  Scene at_the_origin = scene_at({});
  at_the_origin.camera.world_from_camera.start = Transform::translate({6e6, 0, 0});
  move_to_render_space(at_the_origin);
  expect_near(at_the_origin.groups[0].shapes[0].world_from_object.start.point({}), {});
}

/// In float the vertices of a triangle of one metre survive 3,000 km from the origin.
TEST(RenderSpace, CompilingKeepsDetail) {
  Diagnostics diagnostics;
  const CompiledScene<float> flat = compile_scene<float>(scene_at({3e6, -2e6, 1e6}), {}, diagnostics);
  ASSERT_EQ(flat.view.positions_count, 6u);
  expect_near(convert<double>(flat.view.positions[1] - flat.view.positions[0]), {2, 0, 0});
}

}  // namespace
}  // namespace alhazen::impl::test
