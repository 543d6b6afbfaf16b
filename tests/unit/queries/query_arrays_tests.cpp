// The arrays of ray queries: strides, optional ones, wrong ones, and results that depend on nothing but the ray.

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <thread>

#include "queries/query_scene.h"
#include "support/instanced_scenes.h"
#include "support/query_rays.h"
#include "support/reals.h"

namespace alhazen::impl::test {

namespace {

/// The square [-1, 1]^2 in the plane z = 0, facing +z.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Half of the rays are random; the others are those of a camera, which are traced in packets.
template <class Number>
QueryRays<Number> mixed_rays(size_t count) {
  QueryRays<Number> rays = random_rays<Number>(count / 2, 4, 21);
  for (size_t i = rays.count(); i < count; ++i) {
    const double x = static_cast<double>(i % 64) / 64 - 0.5, y = static_cast<double>(i / 64 % 64) / 64 - 0.5;
    rays.add({0.1, 0.2, 7}, {x, y, -1.5}, infinity<double>, static_cast<double>(i % 7) / 6);
  }
  return rays;
}

}  // namespace

template <class Number>
class QueryArrays : public testing::Test {};
TYPED_TEST_SUITE(QueryArrays, Reals);

TYPED_TEST(QueryArrays, ResultsDependOnNeitherThreadsNorInstructionSet) {
  constexpr size_t count = 20'000;
  const QueryRays<TypeParam> rays = mixed_rays<TypeParam>(count);
  for (const Scene& description :
       {scene_of(cube()), scene_of(icosphere(2)), scene_of(icosphere(6)), instanced_scene(4, 9, 4, true)})
    for (const Precision precision : {Precision::single, Precision::double_}) {
      const QueryScene scene = query_scene(description, precision);
      QueryHits<TypeParam> expected(count);
      std::vector<uint8_t> expected_occluded(count, 7);
      scene.closest_hits(rays.arrays(), expected.arrays(), 1, InstructionSet::baseline);
      scene.occluded(rays.arrays(), expected_occluded.data(), 1, InstructionSet::baseline);
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(expected.is_miss(i), expected_occluded[i] == 0);
      for (const InstructionSet set : instruction_sets())
        for (const int threads : {0, 1, 3, 64}) {
          QueryHits<TypeParam> hits(count);
          std::vector<uint8_t> occluded(count, 7);
          scene.closest_hits(rays.arrays(), hits.arrays(), threads, set);
          scene.occluded(rays.arrays(), occluded.data(), threads, set);
          EXPECT_TRUE(hits == expected) << to_string(set) << ", " << threads << " threads";
          EXPECT_TRUE(occluded == expected_occluded) << to_string(set) << ", " << threads << " threads";
        }
    }
}

TYPED_TEST(QueryArrays, ResultsDoNotDependOnOtherRays) {
  constexpr size_t count = 3000;
  const QueryRays<TypeParam> rays = mixed_rays<TypeParam>(count);
  const QueryScene scene = query_scene(scene_of(icosphere(6)));
  QueryHits<TypeParam> all(count), singly(count);
  scene.closest_hits(rays.arrays(), all.arrays(), 1);
  for (size_t i = 0; i < count; ++i) {
    RayArrays<TypeParam> one = rays.arrays();
    one.origins += 3 * i;
    one.directions += 3 * i;
    one.t_max += i;
    one.times += i;
    one.count = 1;
    HitArrays<TypeParam> hits = singly.arrays();
    hits.t += i;
    hits.positions += 3 * i;
    hits.normals += 3 * i;
    hits.shading_normals += 3 * i;
    hits.offsets += i;
    hits.uvs += 2 * i;
    hits.barycentrics += 2 * i;
    hits.primitives += i;
    hits.shapes += i;
    hits.instances += i;
    scene.closest_hits(one, hits, 0);
  }
  EXPECT_TRUE(all == singly);
}

TYPED_TEST(QueryArrays, MayHaveStridesAndBeUnaligned) {
  constexpr size_t count = 500;
  const QueryRays<TypeParam> rays = random_rays<TypeParam>(count, 2, 5);
  const QueryScene scene = query_scene(instanced_scene(4, 9, 4, true));
  QueryHits<TypeParam> expected(count);
  scene.closest_hits(rays.arrays(), expected.arrays(), 1);

  // Records of 9 numbers, the last ray first, at an odd address.
  std::vector<char> bytes(9 * count * sizeof(TypeParam) + 1);
  const auto put = [&](size_t place, TypeParam number) {
    std::memcpy(bytes.data() + 1 + place * sizeof(TypeParam), &number, sizeof(number));
  };
  for (size_t i = 0; i < count; ++i) {
    const size_t record = 9 * (count - 1 - i);
    for (size_t k = 0; k < 3; ++k) {
      put(record + k, rays.origins[3 * i + k]);
      put(record + 4 + k, rays.directions[3 * i + k]);
    }
    put(record + 3, rays.t_max[i]);
    put(record + 7, rays.times[i]);
  }
  const auto at = [&](size_t place) {
    return reinterpret_cast<const TypeParam*>(bytes.data() + 1 + (9 * (count - 1) + place) * sizeof(TypeParam));
  };
  RayArrays<TypeParam> strided{at(0), at(4), count, at(3), at(7)};
  strided.origin_stride = strided.direction_stride = strided.t_max_stride = strided.time_stride = -9;
  QueryHits<TypeParam> hits(count);
  scene.closest_hits(strided, hits.arrays(), 1);
  EXPECT_TRUE(hits == expected);

  std::vector<char> unaligned(3 * count * sizeof(TypeParam) + 1);
  HitArrays<TypeParam> only;
  only.normals = reinterpret_cast<TypeParam*>(unaligned.data() + 1);
  scene.closest_hits(strided, only, 1);
  EXPECT_EQ(0, std::memcmp(unaligned.data() + 1, expected.normals.data(), 3 * count * sizeof(TypeParam)));
}

TYPED_TEST(QueryArrays, AStrideOf0GivesAllRaysTheSame) {
  constexpr size_t count = 100;
  QueryRays<TypeParam> rays, same;
  Random random(3);
  for (size_t i = 0; i < count; ++i) rays.add({0.1, 0.2, 4}, random.on_sphere(), 4.5, 0.5);
  same.add({0.1, 0.2, 4}, {}, 4.5, 0.5);
  RayArrays<TypeParam> shared{same.origins.data(), rays.directions.data(), count, same.t_max.data(), same.times.data()};
  shared.origin_stride = shared.t_max_stride = shared.time_stride = 0;
  const QueryScene scene = query_scene(instanced_scene(4, 9, 4, true));
  QueryHits<TypeParam> expected(count), hits(count);
  scene.closest_hits(rays.arrays(), expected.arrays(), 1);
  scene.closest_hits(shared, hits.arrays(), 1);
  EXPECT_TRUE(hits == expected);
}

TYPED_TEST(QueryArrays, EachOutputIsOptional) {
  constexpr size_t count = 300;
  const QueryRays<TypeParam> rays = random_rays<TypeParam>(count, 2, 5);
  const QueryScene scene = query_scene(scene_of(icosphere(3)));
  QueryHits<TypeParam> expected(count), hits(count);
  scene.closest_hits(rays.arrays(), expected.arrays(), 1);
  scene.closest_hits(rays.arrays(), {}, 1);
  const auto only = [&](auto member) {
    HitArrays<TypeParam> arrays;
    arrays.*member = hits.arrays().*member;
    scene.closest_hits(rays.arrays(), arrays, 1);
  };
  using Arrays = HitArrays<TypeParam>;
  for (const auto member : {&Arrays::t, &Arrays::positions, &Arrays::normals, &Arrays::shading_normals,
                            &Arrays::offsets, &Arrays::uvs, &Arrays::barycentrics})
    only(member);
  for (const auto member : {&Arrays::primitives, &Arrays::shapes, &Arrays::instances}) only(member);
  EXPECT_TRUE(hits == expected);
}

TYPED_TEST(QueryArrays, NoRaysNeedNoArrays) {
  const QueryScene scene = query_scene(scene_of(cube()));
  EXPECT_NO_THROW(scene.closest_hits(RayArrays<TypeParam>{}, {}, 0));
  EXPECT_NO_THROW(scene.occluded(RayArrays<TypeParam>{}, nullptr, 0));
}

TYPED_TEST(QueryArrays, EmptyScenesAreMissed) {
  const Scene nothing;
  const QueryScene scene = query_scene(nothing);
  const QueryRays<TypeParam> rays = mixed_rays<TypeParam>(100);
  QueryHits<TypeParam> hits(100);
  std::vector<uint8_t> occluded(100, 7);
  scene.closest_hits(rays.arrays(), hits.arrays(), 0);
  scene.occluded(rays.arrays(), occluded.data(), 0);
  for (size_t i = 0; i < 100; ++i) EXPECT_TRUE(hits.is_miss(i) && occluded[i] == 0) << i;
  EXPECT_TRUE(scene.bounds().is_empty());
}

TYPED_TEST(QueryArrays, MissingArraysAreErrorsThatNameThem) {
  const QueryScene scene = query_scene(scene_of(cube()));
  const QueryRays<TypeParam> rays = random_rays<TypeParam>(5, 2, 5);
  QueryHits<TypeParam> hits(5);
  const QueryHits<TypeParam> before = hits;
  const auto expect_error = [&](const auto& query, const std::string& part) {
    try {
      query();
      ADD_FAILURE() << "no error about " << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find(part)) << error.what();
    }
  };
  RayArrays<TypeParam> lacking = rays.arrays();
  lacking.origins = nullptr;
  expect_error([&] { scene.closest_hits(lacking, hits.arrays(), 0); }, "origins");
  lacking = rays.arrays();
  lacking.directions = nullptr;
  expect_error([&] { scene.closest_hits(lacking, hits.arrays(), 0); }, "directions");
  expect_error([&] { scene.occluded(rays.arrays(), nullptr, 0); }, "occluded");
  expect_error([&] { scene.closest_hits(rays.arrays(), hits.arrays(), -1); }, "threads");
  EXPECT_TRUE(hits == before);
}

TYPED_TEST(QueryArrays, RaysThatAreNoneHitNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = infinity<double>;
  QueryRays<TypeParam> rays;
  for (const double bad : {nan, inf, -inf})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d origin{0.1, 0.2, 3}, direction{0, 0, -1};
      origin[axis] = bad;
      rays.add(origin, direction);
      rays.add({0.1, 0.2, 3}, origin - Vec3d{0.1, 0.2, 4});
    }
  rays.add({0.1, 0.2, 3}, {0, 0, 0});
  rays.add({0.1, 0.2, 3}, {-0.0, 0, -0.0});
  for (const double t_max : {nan, 0.0, -0.0, -1.0, -inf}) rays.add({0.1, 0.2, 3}, {0, 0, -1}, t_max);
  for (const double time : {nan, inf, -inf}) rays.add({0.1, 0.2, 3}, {0, 0, -1}, inf, time);
  const size_t bad = rays.count();
  rays.add({0.1, 0.2, 3}, {0, 0, -1});
  for (const Scene& description : {scene_of(cube()), scene_of(icosphere(5)), instanced_scene(4, 9, 4, true)})
    for (const Precision precision : {Precision::single, Precision::double_}) {
      const QueryScene scene = query_scene(description, precision);
      QueryHits<TypeParam> hits(rays.count());
      std::vector<uint8_t> occluded(rays.count(), 7);
      scene.closest_hits(rays.arrays(), hits.arrays(), 1);
      scene.occluded(rays.arrays(), occluded.data(), 1);
      for (size_t i = 0; i < bad; ++i) {
        EXPECT_TRUE(hits.is_miss(i)) << i;
        EXPECT_EQ(0, occluded[i]) << i;
      }
      EXPECT_FALSE(hits.is_miss(bad));
      EXPECT_EQ(1, occluded[bad]);
    }
}

TYPED_TEST(QueryArrays, DirectionsHaveAnyLength) {
  using Limits = std::numeric_limits<TypeParam>;
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const QueryScene scene = query_scene(scene_of(square()), precision);
    for (const TypeParam length :
         {TypeParam(4), TypeParam(0.125), Limits::max(), Limits::min(), Limits::denorm_min()}) {
      QueryRays<TypeParam> rays;
      rays.add({0.25, 0.5, 1}, {0, 0, -static_cast<double>(length)});
      QueryHits<TypeParam> hits(1);
      scene.closest_hits(rays.arrays(), hits.arrays(), 1);
      EXPECT_EQ(0u, hits.shapes[0]) << length;
      const TypeParam expected = 1 / length;
      EXPECT_EQ(expected > Limits::max() ? Limits::max() : expected, hits.t[0]) << length;
      EXPECT_NEAR(0.5, static_cast<double>(hits.positions[1]), 1e-6) << length;
    }
  }
}

TYPED_TEST(QueryArrays, IntervalsAreOpen) {
  const QueryScene scene = query_scene(scene_of(square()));
  const auto is_hit = [&](double from, double direction, TypeParam t_max) {
    QueryRays<TypeParam> rays;
    rays.add({0.25, 0.5, from}, {0, 0, direction}, static_cast<double>(t_max));
    QueryHits<TypeParam> hits(1);
    uint8_t occluded = 7;
    scene.closest_hits(rays.arrays(), hits.arrays(), 1);
    scene.occluded(rays.arrays(), &occluded, 1);
    EXPECT_EQ(hits.is_miss(0), occluded == 0);
    EXPECT_TRUE(hits.is_miss(0) || (hits.t[0] > 0 && hits.t[0] < t_max));
    return !hits.is_miss(0);
  };
  constexpr TypeParam inf = std::numeric_limits<TypeParam>::infinity();
  EXPECT_FALSE(is_hit(1, -1, 1));
  EXPECT_FALSE(is_hit(1, -4, TypeParam(0.25)));
  EXPECT_TRUE(is_hit(1, -1, TypeParam(1.00001)));
  EXPECT_TRUE(is_hit(1, -4, TypeParam(0.250001)));
  EXPECT_TRUE(is_hit(1, -1, inf));
  EXPECT_FALSE(is_hit(0, -1, inf));  // t = 0
  EXPECT_FALSE(is_hit(-1, -1, inf));

  // Whatever rounding does to t_max and to t, t is below t_max.
  QueryRays<TypeParam> rays = random_rays<TypeParam>(20'000, 2, 31);
  const QueryScene sphere = query_scene(scene_of(icosphere(3)));
  QueryHits<TypeParam> hits(rays.count()), again(rays.count());
  sphere.closest_hits(rays.arrays(), hits.arrays(), 1);
  for (size_t i = 0; i < rays.count(); ++i)
    if (!hits.is_miss(i)) rays.t_max[i] = i % 2 ? hits.t[i] : std::nextafter(hits.t[i], inf);
  sphere.closest_hits(rays.arrays(), again.arrays(), 1);
  for (size_t i = 0; i < rays.count(); ++i) {
    const bool is_below = again.t[i] < rays.t_max[i];
    EXPECT_TRUE(again.is_miss(i) || is_below) << i;
  }
}

TYPED_TEST(QueryArrays, TimesAreClampedAndMayBeAbsent) {
  Scene description = scene_of(square());
  description.groups[0].shapes[0].world_from_object.end = Transform::translate({0, 0, 2});
  const QueryScene scene = query_scene(description);
  QueryRays<TypeParam> rays;
  for (const double time : {-3.0, 0.0, 0.5, 1.0, 7.0}) rays.add({0.25, 0.5, 5}, {0, 0, -1}, 10, time);
  QueryHits<TypeParam> hits(5);
  scene.closest_hits(rays.arrays(), hits.arrays(), 1);
  const double expected[] = {5, 5, 4, 3, 3};
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(expected[i], static_cast<double>(hits.t[i]), 1e-5) << i;
  RayArrays<TypeParam> timeless = rays.arrays();
  timeless.times = nullptr;
  scene.closest_hits(timeless, hits.arrays(), 1);
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(5, static_cast<double>(hits.t[i]), 1e-5) << i;
}

TYPED_TEST(QueryArrays, SeveralThreadsMayQueryAtOnce) {
  constexpr size_t count = 10'000;
  const QueryRays<TypeParam> rays = mixed_rays<TypeParam>(count);
  const QueryScene scene = query_scene(scene_of(icosphere(5)));
  QueryHits<TypeParam> expected(count);
  scene.closest_hits(rays.arrays(), expected.arrays(), 1);
  std::vector<QueryHits<TypeParam>> results(4, QueryHits<TypeParam>(count));
  std::vector<std::thread> threads;
  for (QueryHits<TypeParam>& hits : results)
    threads.emplace_back([&] {
      for (int i = 0; i < 5; ++i) scene.closest_hits(rays.arrays(), hits.arrays(), 2);
    });
  for (std::thread& thread : threads) thread.join();
  for (const QueryHits<TypeParam>& hits : results) EXPECT_TRUE(hits == expected);
}

}  // namespace alhazen::impl::test
