// Names of parts, given and made.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "scene_support.h"

namespace alhazen::test {

namespace {

alhazen::Shape ball(const std::string& name = {}, MaterialId material = {}) {
  alhazen::Shape shape{Sphere{1}, material};
  shape.name = name;
  return shape;
}

TEST(PartNames, NumbersLeaveOutGivenNames) {
  Scene scene;
  const ShapeId first = scene.add(ball()), given = scene.add(ball("sphere.2")), second = scene.add(ball());
  EXPECT_EQ(scene.name(first), "sphere.1");
  EXPECT_EQ(scene.name(given), "sphere.2");
  EXPECT_EQ(scene.name(second), "sphere.3");
  EXPECT_EQ(scene.find_shapes("sphere.2"), std::vector{given});
  EXPECT_EQ(scene.find_shapes("sphere.3"), std::vector{second});
}

TEST(PartNames, NumbersLeaveOutGivenNamesOfOtherParts) {
  Scene scene;
  const GroupId tree = scene.add_group("tree");
  scene.add(ball(), tree);
  scene.add(ball("tree.1"));
  scene.add(ball("point.1"));
  const InstanceId instance = scene.add(Instance{.group = tree});
  EXPECT_EQ(scene.name(instance), "tree.2");
  const LightId light = scene.add(PointLight{10, {0, 3, 0}});
  EXPECT_EQ(scene.name(light), "point.2");
  EXPECT_EQ(scene.find_lights("point.2"), std::vector{light});
  EXPECT_TRUE(scene.find_lights("point.1").empty());
}

TEST(PartNames, GroupsOfOneNameShareNumbers) {
  Scene scene;
  const GroupId a = scene.add_group("tree"), b = scene.add_group("tree");
  const InstanceId of_a = scene.add(Instance{.group = a}), of_b = scene.add(Instance{.group = b});
  EXPECT_EQ(scene.name(of_a), "tree.1");
  EXPECT_EQ(scene.name(of_b), "tree.2");
}

TEST(PartNames, NumbersOfMaterialsLeaveOutGivenNames) {
  Scene scene;
  const MaterialId unnamed = scene.add(Diffuse{}), other = scene.add(Diffuse{});
  Material material{Diffuse{}};
  material.name = "material.1";
  const MaterialId given = scene.add(material);
  EXPECT_EQ(scene.name(given), "material.1");
  EXPECT_EQ(scene.name(other), "material.2");
  EXPECT_EQ(scene.name(unnamed), "material.4");
  EXPECT_EQ(scene.find_material("material.1"), given);
  EXPECT_EQ(scene.find_material("material.4"), unnamed);
  EXPECT_FALSE(scene.find_material("material.3"));
}

TEST(PartNames, FollowChanges) {
  Scene scene;
  const ShapeId shape = scene.add(ball());
  EXPECT_EQ(scene.name(shape), "sphere.1");
  scene.set(shape, ball("moon"));
  EXPECT_EQ(scene.name(shape), "moon");
  EXPECT_TRUE(scene.find_shapes("sphere.1").empty());
  const LightId light = scene.add(PointLight{10, {0, 3, 0}});
  EXPECT_EQ(scene.name(light), "point.1");
  scene.remove(shape);
  EXPECT_TRUE(scene.find_shapes("moon").empty());
  EXPECT_EQ(Scene(scene).name(light), "point.1");
}

/// The numbers in the layer tell objects apart whose names would collide, and lead to their handles.
TEST(PartNames, OfTheLayerAreThoseOfTheScene) {
  Scene scene;
  std::vector<ShapeId> shapes;
  for (const char* name : {"", "sphere.2", ""}) {
    alhazen::Shape shape = ball(name);
    shape.transform = Transform::translate({3.0 * static_cast<double>(shapes.size()), 0, 0});
    shapes.push_back(scene.add(shape));
  }
  Settings settings = quick_settings();
  settings.width = 60;
  settings.height = 20;
  settings.aovs = {"object"};
  const RenderedImage image = render(scene, settings);
  const float* object = image.plane("object.Y");
  ASSERT_NE(object, nullptr);
  const std::set<float> ids(object, object + 60 * 20);
  EXPECT_EQ(ids, (std::set<float>{0, 1, 2, 3}));
  const std::string& names = image.metadata.at("object");
  for (const ShapeId shape : shapes) {
    EXPECT_NE(names.find("\"" + scene.name(shape) + "\""), std::string::npos) << names;
    EXPECT_EQ(scene.find_shapes(scene.name(shape)), std::vector{shape});
  }
}

/// Meshes that move, and stretched spheres, are described in other ways once they are compiled.
TEST(PartNames, OfTheLayerAreThoseOfTheSceneAfterShapesBecomeOthers) {
  Scene scene;
  const std::vector<float> positions{-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const std::vector<uint32_t> indices{0, 1, 2};
  const MeshId mesh = scene.add(MeshArrays{.positions = positions, .indices = indices});
  std::vector<ShapeId> shapes;
  shapes.push_back(scene.add(alhazen::Shape{mesh, {}, {Transform(), Transform::translate({0.5, 0, 0})}}));
  shapes.push_back(scene.add(alhazen::Shape{mesh, {}, Transform::translate({3, 0, 0})}));
  shapes.push_back(
      scene.add(alhazen::Shape{Sphere{1}, {}, Transform::translate({6, 0, 0}) * Transform::scale({0.5, 1, 1})}));
  Settings settings = quick_settings();
  settings.width = 90;
  settings.aovs = {"object"};
  Camera camera;
  camera.transform = Transform::look_at({3, 0, -8}, {3, 0, 0}, {0, 1, 0}, Handedness::left);
  scene.set_camera(camera);
  const RenderedImage image = render(scene, settings);
  // From left to right.
  std::vector<float> numbers;
  const float* row = image.plane("object.Y") + 90 * (image.height / 2);
  for (int x = 0; x < 90; ++x)
    if (row[x] > 0 && (numbers.empty() || numbers.back() != row[x])) numbers.push_back(row[x]);
  ASSERT_EQ(numbers.size(), 3u);
  const std::string& names = image.metadata.at("object");
  for (size_t i = 0; i < 3; ++i) {
    const std::string entry = "\"" + scene.name(shapes[i]) + "\":" + std::to_string(static_cast<int>(numbers[i]));
    EXPECT_NE(names.find(entry), std::string::npos) << entry << " in " << names;
  }
}

/// docs/library.md: where a point of the world is in the image.
TEST(PartNames, AreFoundWhereTheCameraShowsThem) {
  Scene scene;
  const Vec3 point{0.7, 0.4, -0.5};
  scene.add(alhazen::Shape{Sphere{0.1}, {}, Transform::translate(point)});
  scene.set_camera(view_of_pbrt());
  Settings settings = quick_settings();
  settings.width = 90;
  settings.height = 60;
  settings.aovs = {"object"};
  const RenderedImage image = render(scene, settings);
  const Vec3 p = view_of_pbrt().transform.start.inverse().point(point);
  const double s = 60 / 2.0 / std::tan(view_of_pbrt().fov / 2 * 3.141592653589793 / 180);
  const double x = 90 / 2.0 + s * p.x / p.z, y = 60 / 2.0 - s * p.y / p.z;
  double sum_x = 0, sum_y = 0, count = 0;
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 90; ++column)
      if (image.plane("object.Y")[row * 90 + column] == 1) sum_x += column + 0.5, sum_y += row + 0.5, ++count;
  ASSERT_GT(count, 4);
  EXPECT_NEAR(sum_x / count, x, 0.4);
  EXPECT_NEAR(sum_y / count, y, 0.4);
}

TEST(PartNames, OfManyPartsTakeNoTime) {
  Scene scene;
  for (int i = 0; i < 8000; ++i) scene.add(ball());
  const std::vector<ShapeId> shapes = scene.shapes();
  const auto start = std::chrono::steady_clock::now();
  for (const ShapeId shape : shapes) ASSERT_EQ(scene.find_shapes(scene.name(shape)), std::vector{shape});
  // Without a cache they take minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace

}  // namespace alhazen::test
