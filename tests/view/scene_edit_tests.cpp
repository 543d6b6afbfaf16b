#include "view/scene_edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace alhazen::impl {

namespace {

using ::alhazen::Transform;

/// A ball in front of a wall, and another ball as an instance beside it.
struct Room {
  explicit Room(double alpha = 1) {
    ::alhazen::Material glassy = ::alhazen::Principled{.roughness = 0.25};
    glassy.name = "clay";
    glassy.alpha = alpha;
    clay = scene.add(glassy);
    ball = scene.add(::alhazen::Shape{.geometry = ::alhazen::Sphere{1}, .material = clay, .name = "ball"});
    const std::vector<float> positions{-9, -9, -3, 9, -9, -3, 9, 9, -3, -9, 9, -3};
    const std::vector<uint32_t> indices{0, 1, 2, 0, 2, 3};
    wall = scene.add(::alhazen::Shape{.geometry = scene.add(MeshArrays{.positions = positions, .indices = indices}),
                                      .name = "wall"});
    const GroupId group = scene.add_group("trees");
    tree = scene.add(::alhazen::Shape{.geometry = ::alhazen::Sphere{0.5}, .name = "leaf"}, group);
    copy = scene.add(::alhazen::Instance{.group = group, .transform = Transform::translate({3, 0, 0}), .name = "oak"});
    scene.look_at({0, 0, 5}, {0, 0, 0});
    ::alhazen::Camera camera = scene.camera();
    camera.fov = 60;
    scene.set_camera(camera);
  }

  ::alhazen::Scene scene;
  MaterialId clay;
  ShapeId ball, wall, tree;
  InstanceId copy;
};

/// The pixel of a 301 by 201 image that shows a point of the plane z = 0.
int column_of(double x) { return static_cast<int>(150.5 + 100.5 / std::tan(std::acos(-1.0) / 6) * x / 5); }

TEST(Picker, FindsShapesInstancesAndMaterials) {
  Room room;
  Picker picker;
  const auto ball = picker.pick(room.scene, 301, 201, 150, 100);
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->shape, room.ball);
  EXPECT_EQ(ball->object, "ball");
  EXPECT_EQ(ball->material, room.clay);
  EXPECT_FALSE(ball->instance);
  EXPECT_NEAR(ball->distance, 4, 1e-6);
  EXPECT_NEAR(ball->position.z, 1, 1e-6);
  EXPECT_NEAR(ball->normal.z, 1, 1e-6);
  const auto leaf = picker.pick(room.scene, 301, 201, column_of(3), 100);
  ASSERT_TRUE(leaf);
  EXPECT_EQ(leaf->instance, room.copy);
  EXPECT_EQ(leaf->instance_name, "oak");
  EXPECT_EQ(leaf->shape, room.tree);
  EXPECT_FALSE(leaf->material);
  const auto wall = picker.pick(room.scene, 301, 201, 0, 0);
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->shape, room.wall);
  EXPECT_NEAR(wall->distance, 8, 1e-6);  // along the viewing direction
}

TEST(Picker, PassesThroughWhatIsCutOut) {
  Room room(0);
  Picker picker;
  const auto wall = picker.pick(room.scene, 301, 201, 150, 100);
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->shape, room.wall);
  EXPECT_NEAR(wall->distance, 8, 1e-6);
}

TEST(Picker, SeesChangesAndMisses) {
  Room room;
  Picker picker;
  ASSERT_EQ(picker.pick(room.scene, 301, 201, 150, 100)->shape, room.ball);
  room.scene.remove(room.ball);
  ASSERT_EQ(picker.pick(room.scene, 301, 201, 150, 100)->shape, room.wall);
  room.scene.look_at({0, 0, 5}, {0, 0, 10});
  EXPECT_FALSE(picker.pick(room.scene, 301, 201, 150, 100));
  EXPECT_THROW(picker.pick(room.scene, 301, 201, 301, 100), ::alhazen::InputError);
  EXPECT_THROW(picker.pick(room.scene, 301, 201, 0, -1), ::alhazen::InputError);
}

TEST(MaterialFields, AllOfEveryKindCanBeSet) {
  const std::vector<::alhazen::Material> kinds{
      Diffuse{},       Conductor{},       Dielectric{},          ThinDielectric{},
      CoatedDiffuse{}, CoatedConductor{}, DiffuseTransmission{}, ::alhazen::Principled{}};
  for (const ::alhazen::Material& kind : kinds) {
    ::alhazen::Scene scene;
    const MaterialId id = scene.add(kind);
    for (const MaterialField& field : material_fields(scene.material(id))) {
      SCOPED_TRACE(material_kind(kind) + " " + field.name);
      FieldValue value = 0.75;
      if (std::holds_alternative<bool>(field.value)) value = !std::get<bool>(field.value);
      if (std::holds_alternative<std::array<double, 3>>(field.value)) value = std::array<double, 3>{0.125, 0.25, 0.75};
      set_material_fields(scene, id, {{field.name, value}});
      const std::vector<MaterialField> now = material_fields(scene.material(id));
      const auto found = std::find_if(now.begin(), now.end(), [&](const auto& f) { return f.name == field.name; });
      ASSERT_NE(found, now.end());
      EXPECT_EQ(found->value, value);
    }
  }
}

TEST(MaterialFields, BadValuesLeaveTheSceneAlone) {
  Room room;
  const auto before = material_fields(room.scene.material(room.clay));
  const std::vector<std::map<std::string, FieldValue>> bad{
      {{"roughness", -1.0}},       {{"roughness", true}},
      {{"base_colour", 0.5}},      {{"base_colour", std::array<double, 3>{2, 0, 0}}},
      {{"no_such_field", 0.5}},    {{"metallic", 0.5}, {"ior", 0.0}},
      {{"metallic", std::nan("")}}};
  for (const auto& values : bad) {
    EXPECT_THROW(set_material_fields(room.scene, room.clay, values), ::alhazen::InputError);
    const auto after = material_fields(room.scene.material(room.clay));
    for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].value, after[i].value) << before[i].name;
  }
}

TEST(MaterialChanges, AreToldAndRepeated) {
  Room room;
  MaterialChanges changes;
  changes.remember(room.scene, room.clay);
  EXPECT_TRUE(changes.lines(room.scene).empty());
  set_material_fields(room.scene, room.clay, {{"roughness", 0.5}, {"thin", true}});
  const std::vector<std::string> lines{"material 'clay': roughness 0.25 -> 0.5", "material 'clay': thin false -> true"};
  EXPECT_EQ(changes.lines(room.scene), lines);
  Room again;
  EXPECT_TRUE(changes.repeat(room.scene, again.scene).empty());
  EXPECT_EQ(changes.lines(again.scene), lines);
  ::alhazen::Scene empty;
  EXPECT_EQ(changes.repeat(again.scene, empty).size(), 1u);
}

}  // namespace

}  // namespace alhazen::impl
