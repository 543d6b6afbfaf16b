// The structure of the compressed wide BVH: every primitive is in one leaf, and every box contains everything below it.
// bvh_tests.cpp and watertight_tests.cpp test traversal.

#include <gtest/gtest.h>

#include "core/bvh/cwbvh/traversal.h"
#include "support/closed_meshes.h"
#include "support/primitive_scenes.h"

namespace alhazen::impl::test {
namespace {

Bounds3<float> box_of(const SceneView<float>& scene, const CwbvhPrimitive& p) {
  Bounds3<float> box;
  if (p.id.kind() == PrimitiveKind::cylinder) return bounds_of(scene, scene.cylinders[p.id.index()]);
  if (p.id.kind() == PrimitiveKind::disk) return bounds_of(scene, scene.disks[p.id.index()]);
  if (p.id.kind() == PrimitiveKind::triangle) {
    box.extend(p.a);
    box.extend(p.b);
    box.extend(p.c);
    return box;
  }
  const Vec3f radius = splat(p.b.x);
  box.extend({p.a - radius, p.a + radius});
  if (p.id.kind() == PrimitiveKind::moving_sphere) box.extend({p.a + p.c - radius, p.a + p.c + radius});
  return box;
}

class Walk {
 public:
  explicit Walk(const SceneView<float>& scene) : scene_(scene), seen_(scene.cwbvh_primitives_count) {}

  /// Checks everything below a node, and returns its box.
  Bounds3<float> below(uint32_t index, int depth) {
    deepest_ = std::max(deepest_, depth);
    ++nodes_;
    const CwbvhNode& node = scene_.cwbvh_nodes[index];
    Bounds3<float> all;
    uint32_t next_child = node.first_child, next_primitive = 0;
    for (uint32_t child = 0; child < CwbvhNode::children; ++child) {
      const uint32_t meta = byte_of(node.meta, child);
      const bool is_node = node.exponents_and_inner >> (24 + child) & 1;
      if (meta == 0) {
        EXPECT_FALSE(is_node);
        continue;
      }
      Bounds3<float> box;
      if (is_node) {
        EXPECT_EQ(meta, 1u << 5 | (24 + child));
        box = below(next_child++, depth + 1);
      } else {
        const uint32_t count = count_bits(meta >> 5);
        EXPECT_TRUE(meta >> 5 == 1 || meta >> 5 == 3 || meta >> 5 == 7);
        EXPECT_EQ(meta & 31, next_primitive);
        for (uint32_t i = 0; i < count; ++i) {
          const uint32_t place = node.first_primitive + next_primitive + i;
          ++seen_.at(place);
          box.extend(box_of(scene_, scene_.cwbvh_primitives[place]));
        }
        next_primitive += count;
      }
      expect_held(node, child, box);
      all.extend(box);
    }
    EXPECT_LE(next_primitive, 24u);
    return all;
  }

  void expect_all_seen() const {
    for (const int times : seen_) ASSERT_EQ(times, 1);
    EXPECT_EQ(nodes_, scene_.cwbvh_nodes_count);
    EXPECT_LE(deepest_, max_cwbvh_depth);
  }

 private:
  static void expect_held(const CwbvhNode& node, uint32_t child, const Bounds3<float>& box) {
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = power_of_two(node.exponents_and_inner >> (8 * axis) & 255u);
      ASSERT_LE(box_coordinate(node.origin[axis], scale, byte_of(node.low[axis], child)), box.low[axis]);
      ASSERT_GE(box_coordinate(node.origin[axis], scale, byte_of(node.high[axis], child)), box.high[axis]);
    }
  }

  const SceneView<float>& scene_;
  std::vector<int> seen_;
  uint32_t nodes_ = 0;
  int deepest_ = 0;
};

void check(const CompiledScene<float>& scene) {
  ASSERT_EQ(scene.view.cwbvh_primitives_count, scene.view.primitives_count);
  ASSERT_EQ(scene.view.cwbvh_nodes_count == 0, scene.view.primitives_count == 0);
  if (scene.view.cwbvh_nodes_count == 0) return;
  Walk walk(scene.view);
  walk.below(0, 1);
  walk.expect_all_seen();
}

TEST(Cwbvh, OfMixedPrimitives) {
  for (const int count : {1, 2, 3, 8, 50, 2000}) check(mixed_primitives(21, count).flat<float>());
}

TEST(Cwbvh, OfNothingAndOfOne) {
  check(PrimitiveScene().flat<float>());
  PrimitiveScene one;
  one.add_triangle({0, 0, 1}, {1, 0, 1}, {0, 1, 1});  // flat in z
  check(one.flat<float>());
}

TEST(Cwbvh, OfHugeRangesOfSizes) {
  Random random(22);
  PrimitiveScene scene;
  for (int i = 0; i < 500; ++i) {
    const double size = random.magnitude_between(1e-8, 1e9);
    const Vec3d p = random.on_sphere() * size;
    scene.add_triangle(p, p + random.on_sphere() * size, p + random.on_sphere() * size);
  }
  for (int i = 0; i < 20; ++i) scene.add_sphere(random.on_sphere() * 4e11, 4e11);
  check(scene.flat<float>());
}

/// The binary tree's leaves hold up to eight primitives that no plane separates.
TEST(Cwbvh, OfPrimitivesInOnePlace) {
  PrimitiveScene scene;
  for (int i = 0; i < 1000; ++i) scene.add_sphere({1, 2, 3}, 1);
  check(scene.flat<float>());
}

TEST(Cwbvh, IsSmallerThanTheBinaryOne) {
  const CompiledScene<float> scene = mixed_primitives(23, 3000).flat<float>();
  EXPECT_LT(scene.view.cwbvh_nodes_count * sizeof(CwbvhNode),
            scene.view.bvh2_nodes_count * sizeof(Bvh2Node<float>) / 2);
}

TEST(Cwbvh, IsMadeOnlyWhereItIsAskedFor) {
  Diagnostics diagnostics;
  const CompiledScene<float> scene = compile_scene<float>(
      described_scene("WorldBegin\nAreaLightSource \"diffuse\"\nShape \"sphere\"\n"), {}, diagnostics);
  EXPECT_EQ(scene.view.bvh2_nodes_count, 1u);
  EXPECT_EQ(scene.view.cwbvh_nodes_count, 0u);
}

}  // namespace
}  // namespace alhazen::impl::test
