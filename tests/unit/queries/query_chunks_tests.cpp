// Ray queries take rays in chunks, tiles and packets: numbers of rays at the borders of those, results in the arrays of
// the rays, and arrays at odd addresses.

#include <gtest/gtest.h>

#include <cstring>

#include "queries/query_scene.h"
#include "support/instanced_scenes.h"
#include "support/query_rays.h"
#include "support/reals.h"

namespace alhazen::impl::test {

namespace {

/// Rays of a camera, which are traced in packets, with random ones among them: some runs of either end within a packet.
template <class Number>
QueryRays<Number> rays_in_runs(size_t count) {
  Random random(17);
  QueryRays<Number> rays;
  while (rays.count() < count) {
    const size_t run = 1 + static_cast<size_t>(random.between(0, 60));
    const bool is_coherent = rays.count() % 2 == 0;
    for (size_t i = 0; i < run && rays.count() < count; ++i) {
      const double x = static_cast<double>(rays.count() % 64) / 64 - 0.5, time = static_cast<double>(i % 5) / 4;
      if (is_coherent)
        rays.add({0.1, 0.2, 7}, {x, 0.1, -1.5}, 100, time);
      else
        rays.add(random.in_box(-3, 3), random.on_sphere() * random.magnitude_between(0.01, 100), 100, time);
    }
  }
  return rays;
}

/// One for each way to trace: brute force, trees within and beyond the caches, and instances that move; the last is far
/// from the origin of its world.
std::vector<Scene> scenes_of_all_ways() {
  return {scene_of(cube()), scene_of(icosphere(2)), scene_of(icosphere(6)), instanced_scene(4, 9, 4, true),
          scene_of(icosphere(3), Transform::translate({1e4, 0, 0}))};
}

}  // namespace

template <class Number>
class QueryChunks : public testing::Test {};
TYPED_TEST_SUITE(QueryChunks, Reals);

TYPED_TEST(QueryChunks, AnyNumberOfRaysGivesTheSameResults) {
  constexpr size_t most = 1100;
  const QueryRays<TypeParam> rays = rays_in_runs<TypeParam>(most);
  for (const Scene& description : scenes_of_all_ways())
    for (const Precision precision : {Precision::single, Precision::double_}) {
      const QueryScene scene = query_scene(description, precision);
      QueryHits<TypeParam> all(most);
      scene.closest_hits(rays.arrays(), all.arrays(), 1);
      for (const size_t count : {1, 2, 3, 4, 7, 8, 9, 15, 16, 17, 63, 64, 65, 511, 512, 513, 575, 1024, 1025}) {
        RayArrays<TypeParam> some = rays.arrays();
        some.count = count;
        QueryHits<TypeParam> hits(most), expected(most);  // what is behind the results stays as it is
        std::vector<uint8_t> occluded(most, 7);
        scene.closest_hits(some, hits.arrays(), 1);
        scene.occluded(some, occluded.data(), 1);
        const auto take = [&](auto& to, const auto& from, size_t each) {
          std::copy_n(from.begin(), each * count, to.begin());
        };
        take(expected.t, all.t, 1);
        take(expected.positions, all.positions, 3);
        take(expected.normals, all.normals, 3);
        take(expected.shading_normals, all.shading_normals, 3);
        take(expected.offsets, all.offsets, 1);
        take(expected.uvs, all.uvs, 2);
        take(expected.barycentrics, all.barycentrics, 2);
        take(expected.primitives, all.primitives, 1);
        take(expected.shapes, all.shapes, 1);
        take(expected.instances, all.instances, 1);
        ASSERT_TRUE(hits == expected) << count;
        for (size_t i = 0; i < most; ++i) ASSERT_EQ(i >= count ? 7 : all.is_miss(i) ? 0 : 1, occluded[i]) << i;
      }
    }
}

TYPED_TEST(QueryChunks, HitsMayReplaceTheirRays) {
  constexpr size_t count = 5000;
  for (const Scene& description : scenes_of_all_ways())
    for (const int threads : {1, 2}) {
      QueryRays<TypeParam> rays = rays_in_runs<TypeParam>(count);
      const QueryScene scene = query_scene(description, Precision::single);
      QueryHits<TypeParam> expected(count);
      scene.closest_hits(rays.arrays(), expected.arrays(), 1);
      HitArrays<TypeParam> hits;
      hits.t = rays.t_max.data();
      hits.positions = rays.origins.data();
      hits.shading_normals = rays.directions.data();
      hits.offsets = rays.times.data();
      scene.closest_hits(rays.arrays(), hits, threads);
      EXPECT_TRUE(rays.t_max == expected.t);
      EXPECT_TRUE(rays.origins == expected.positions);
      EXPECT_TRUE(rays.directions == expected.shading_normals);
      EXPECT_TRUE(rays.times == expected.offsets);
    }
}

TYPED_TEST(QueryChunks, EveryOutputMayBeUnaligned) {
  constexpr size_t count = 700;
  const QueryRays<TypeParam> rays = rays_in_runs<TypeParam>(count);
  const QueryScene scene = query_scene(instanced_scene(4, 9, 4, true), Precision::single);
  QueryHits<TypeParam> expected(count);
  scene.closest_hits(rays.arrays(), expected.arrays(), 1);
  using Arrays = HitArrays<TypeParam>;
  const Arrays aligned = expected.arrays();
  const auto compare = [&](auto member, size_t each) {
    using Element = std::remove_pointer_t<std::remove_reference_t<decltype(aligned.*member)>>;
    std::vector<char> bytes(each * count * sizeof(Element) + 2, 'x');
    Arrays odd;
    odd.*member = reinterpret_cast<std::remove_const_t<Element>*>(bytes.data() + 1);
    scene.closest_hits(rays.arrays(), odd, 1);
    EXPECT_EQ(0, std::memcmp(bytes.data() + 1, aligned.*member, bytes.size() - 2));
    EXPECT_EQ('x', bytes.front());
    EXPECT_EQ('x', bytes.back());
  };
  for (const auto member : {&Arrays::t, &Arrays::offsets}) compare(member, 1);
  for (const auto member : {&Arrays::positions, &Arrays::normals, &Arrays::shading_normals}) compare(member, 3);
  for (const auto member : {&Arrays::uvs, &Arrays::barycentrics}) compare(member, 2);
  for (const auto member : {&Arrays::primitives, &Arrays::shapes, &Arrays::instances}) compare(member, 1);
}

}  // namespace alhazen::impl::test
