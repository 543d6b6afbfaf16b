// Transforms: inverses, look_at, similarities.

#include <gtest/gtest.h>

#include <stdexcept>

#include "scene/transform.h"
#include "support/random.h"

namespace alhazen::impl::test {
namespace {

void expect_close(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  EXPECT_NEAR(length(a - b), 0, tolerance) << a.x << " " << a.y << " " << a.z;
}

Transform random_transform(Random& random) {
  return Transform::translate(random.in_box(-5, 5)) * Transform::rotate(random.between(0, 360), random.on_sphere()) *
         Transform::scale({random.between(0.2, 3), random.between(-3, -0.2), random.between(0.2, 3)}) *
         Transform::rotate(random.between(0, 360), random.on_sphere());
}

TEST(Transform, InverseUndoes) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Transform t = random_transform(random), computed(t.matrix());
    const Vec3d p = random.in_box(-10, 10), d = random.on_sphere();
    expect_close(t.inverse().point(t.point(p)), p);
    expect_close(t.inverse().direction(t.direction(d)), d);
    expect_close(computed.inverse().point(p), t.inverse().point(p), 1e-10);
    // Normals stay perpendicular: n . d = 0 before and after.
    const Vec3d n = normalize(cross(d, random.on_sphere()));
    EXPECT_NEAR(dot(t.normal(n), t.direction(d)), 0, 1e-12);
  }
  EXPECT_THROW(Transform::scale({1, 0, 1}), std::domain_error);
}

TEST(Transform, ProductAppliesTheRightOneFirst) {
  const Transform t = Transform::translate({1, 0, 0}) * Transform::scale({2, 2, 2});
  expect_close(t.point({1, 1, 1}), {3, 2, 2});
  expect_close(t.direction({1, 1, 1}), {2, 2, 2});
}

TEST(Transform, RotationIsRightHandedAboutItsAxis) {
  expect_close(Transform::rotate(90, {0, 0, 1}).point({1, 0, 0}), {0, 1, 0});
  expect_close(Transform::rotate(90, {1, 0, 0}).point({0, 1, 0}), {0, 0, 1});
  expect_close(Transform::rotate(90, {0, 2, 0}).point({0, 0, 1}), {1, 0, 0});
  EXPECT_THROW(Transform::rotate(30, {0, 0, 0}), std::domain_error);
}

TEST(Transform, LookAt) {
  const Vec3d eye{1, 2, 3}, target{4, -2, 5}, up{0, 1, 0.2};
  const Transform camera_from_world = Transform::look_at(eye, target, up);
  expect_close(camera_from_world.point(eye), {0, 0, 0});
  expect_close(camera_from_world.point(target), {0, 0, length(target - eye)});
  const Vec3d above = camera_from_world.direction(up);
  EXPECT_NEAR(above.x, 0, 1e-12);
  EXPECT_GT(above.y, 0);
  double scale = 0;
  EXPECT_TRUE(camera_from_world.is_similarity(scale));
  EXPECT_NEAR(scale, 1, 1e-12);
  EXPECT_FALSE(camera_from_world.swaps_handedness());
  EXPECT_THROW(Transform::look_at(eye, eye, up), std::domain_error);
  EXPECT_THROW(Transform::look_at(eye, target, target - eye), std::domain_error);
}

TEST(Transform, Similarity) {
  double scale = 0;
  const Transform turned = Transform::rotate(33, {1, 2, 3});
  EXPECT_TRUE((turned * Transform::scale({3, 3, 3}) * Transform::translate({1, 2, 3})).is_similarity(scale));
  EXPECT_NEAR(scale, 3, 1e-12);
  EXPECT_TRUE((turned * Transform::scale({-2, 2, 2})).is_similarity(scale));
  EXPECT_NEAR(scale, 2, 1e-12);
  EXPECT_FALSE((turned * Transform::scale({2, 2, 2.1})).is_similarity(scale));
  EXPECT_FALSE(Transform(Matrix4{{{1, 0.1, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}).is_similarity(scale));
}

TEST(Transform, Handedness) {
  EXPECT_TRUE(Transform::scale({-1, 1, 1}).swaps_handedness());
  EXPECT_FALSE(Transform::scale({-1, -1, 1}).swaps_handedness());
  EXPECT_TRUE(Transform().is_identity());
  EXPECT_FALSE(Transform::translate({0, 0, 1e-9}).is_identity());
}

}  // namespace
}  // namespace alhazen::impl::test
