// Transforms, attribute blocks and object instances of pbrt scenes.

#include <cmath>
#include <numbers>

#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

const std::string sphere = "Shape \"sphere\"\n";

TEST(PbrtTransforms, ComposeFromTheRight) {
  const Parsed p = parse_world("Translate 1 2 3 Scale 2 2 2 Rotate 90 0 0 1 " + sphere);
  // Rotated first, then scaled, then translated.
  expect_near(shapes(p)[0].world_from_object.start.point({1, 0, 0}), {1, 4, 3});
  EXPECT_FALSE(shapes(p)[0].world_from_object.is_moving());
}

TEST(PbrtTransforms, MatricesAreGivenColumnByColumn) {
  const Parsed p =
      parse_world("Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] " + sphere +
                  "ConcatTransform [ 2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1 ] " + sphere + "Identity " + sphere);
  expect_near(shapes(p)[0].world_from_object.start.point({0, 0, 0}), {5, 6, 7});
  expect_near(shapes(p)[1].world_from_object.start.point({1, 1, 1}), {7, 8, 9});
  EXPECT_TRUE(shapes(p)[2].world_from_object.start.is_identity());
}

TEST(PbrtTransforms, LookAtPlacesTheCamera) {
  const Parsed p = parse("LookAt 0 -5 1  0 0 1  0 0 1 Camera \"perspective\" WorldBegin " + sphere);
  const Transform& world_from_camera = p.scene.camera.world_from_camera.start;
  expect_near(world_from_camera.point({0, 0, 0}), {0, -5, 1});
  expect_near(world_from_camera.direction({0, 0, 1}), {0, 1, 0});
  expect_near(world_from_camera.direction({0, 1, 0}), {0, 0, 1});
  // The format is left-handed: without a mirror, the world's x is on the left in this view.
  expect_near(world_from_camera.direction({1, 0, 0}), {-1, 0, 0});
}

TEST(PbrtTransforms, ScaleBeforeLookAtMirrorsTheCamera) {
  const Parsed p = parse("Scale -1 1 1 LookAt 0 -5 1  0 0 1  0 0 1 Camera \"perspective\" WorldBegin " + sphere);
  expect_near(p.scene.camera.world_from_camera.start.direction({1, 0, 0}), {1, 0, 0});
}

TEST(PbrtTransforms, WorldBeginResetsAndNamesCoordinateSystems) {
  const Parsed p = parse("Translate 0 0 4 Camera \"perspective\" WorldBegin " + sphere +
                         "CoordSysTransform \"camera\" " + sphere + "CoordSysTransform \"world\" " + sphere +
                         "Translate 1 0 0 CoordinateSystem \"mine\" Identity CoordSysTransform \"mine\" " + sphere);
  EXPECT_TRUE(shapes(p)[0].world_from_object.start.is_identity());
  expect_near(shapes(p)[1].world_from_object.start.point({0, 0, 0}), {0, 0, -4});
  EXPECT_TRUE(shapes(p)[2].world_from_object.start.is_identity());
  expect_near(shapes(p)[3].world_from_object.start.point({0, 0, 0}), {1, 0, 0});
}

TEST(PbrtTransforms, ActiveTransformMovesOneEndOfTheShutter) {
  const Parsed p = parse(
      "TransformTimes 0.25 0.75\nWorldBegin Translate 1 0 0 ActiveTransform EndTime Translate 0 1 0 "
      "ActiveTransform StartTime Translate 0 0 1 ActiveTransform All Translate 10 0 0 " +
      sphere);
  const MovingTransform& m = shapes(p)[0].world_from_object;
  EXPECT_TRUE(m.is_moving());
  expect_near(m.start.point({0, 0, 0}), {11, 0, 1});
  expect_near(m.end.point({0, 0, 0}), {11, 1, 0});
  EXPECT_EQ(p.scene.transform_start_time, 0.25);
  EXPECT_EQ(p.scene.transform_end_time, 0.75);
}

TEST(PbrtTransforms, AttributesSaveTheState) {
  const Parsed p =
      parse_world("AttributeBegin Translate 1 0 0 ReverseOrientation " + sphere + "AttributeEnd " + sphere);
  EXPECT_TRUE(shapes(p)[0].reverse_orientation);
  EXPECT_FALSE(shapes(p)[1].reverse_orientation);
  EXPECT_TRUE(shapes(p)[1].world_from_object.start.is_identity());
}

TEST(PbrtTransforms, TransformBeginIsDeprecated) {
  const Parsed p = parse_world("TransformBegin Translate 1 0 0 TransformEnd " + sphere);
  EXPECT_TRUE(p.warned("test.pbrt:2:1: TransformBegin and TransformEnd are deprecated"));
  EXPECT_TRUE(shapes(p)[0].world_from_object.start.is_identity());
}

TEST(PbrtObjects, InstancesApplyOnTopOfTheTransformAtDefinition) {
  const Parsed p =
      parse_world("Translate 0 1 0\nObjectBegin \"ball\" Translate 1 0 0 " + sphere +
                  "ObjectEnd\nAttributeBegin Identity Translate 0 0 5 ObjectInstance \"ball\" AttributeEnd\n"
                  "ActiveTransform EndTime Translate 2 0 0 ObjectInstance \"ball\"");
  ASSERT_EQ(p.scene.groups.size(), 2u);
  ASSERT_EQ(p.scene.instances.size(), 2u);
  EXPECT_TRUE(shapes(p).empty());
  EXPECT_EQ(p.scene.groups[1].name, "ball");
  const Shape& ball = p.scene.groups[1].shapes.at(0);
  expect_near(ball.world_from_object.start.point({0, 0, 0}), {1, 1, 0});
  const Instance& first = p.scene.instances[0];
  EXPECT_EQ(first.group, 1u);
  EXPECT_EQ(first.where.line, 5);
  expect_near(first.world_from_group.start.point(ball.world_from_object.start.point({0, 0, 0})), {1, 1, 5});
  EXPECT_TRUE(p.scene.instances[1].world_from_group.is_moving());
  EXPECT_FALSE(first.reverse_orientation);
}

TEST(PbrtObjects, InstanceMayStandBeforeTheDefinition) {
  const Parsed p = parse_world("ObjectInstance \"o\" ObjectBegin \"o\" " + sphere + " ObjectEnd " + sphere);
  EXPECT_EQ(p.scene.instances.at(0).group, 1u);
  EXPECT_EQ(p.scene.groups[1].shapes.size(), 1u);
  EXPECT_EQ(shapes(p).size(), 1u);
}

TEST(PbrtObjects, LightsInObjectsAreWarnedOf) {
  const Parsed p = parse_world("ObjectBegin \"o\" LightSource \"point\" AreaLightSource \"diffuse\" " + sphere +
                               "ObjectEnd ObjectInstance \"o\"");
  EXPECT_TRUE(p.warned("a light in an object is not part of it"));
  EXPECT_TRUE(p.warned("area lights of objects"));
  EXPECT_EQ(p.scene.lights.size(), 1u);
  EXPECT_FALSE(p.scene.groups[1].shapes[0].emission);
}

}  // namespace
}  // namespace alhazen::impl::test
