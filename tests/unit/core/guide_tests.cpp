// Path guiding in the core: the octahedral map, trees of directions and of space, scattering by both, and learning.

#include "core/guiding/guide.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "core/integrators/guided.h"
#include "core/sampling/independent.h"
#include "support/chi_squared.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t leaf_cell = GuideView<float>::leaf_cell;

/// A tree of directions with random shares, of which a quarter is often the brightest by far.
class RandomGuide {
 public:
  RandomGuide(uint64_t seed, uint32_t depth) : random_(seed) {
    quads.resize(1);
    add(depth);
    light.resize(quads.size() * 4);
  }

  template <class Real>
  GuideView<Real> view() {
    GuideView<Real> view;
    view.cells = cells.data();
    view.regions = regions.data();
    view.quads = quads.data();
    view.light = light.data();
    view.tallies = tallies.data();
    view.scale = {1, 1, 1};
    view.to_fixed = 1;
    return view;
  }

  std::vector<uint32_t> cells{leaf_cell};
  std::vector<GuideRegion> regions{{1, 0.5f}};
  std::vector<GuideQuad> quads;
  std::vector<uint64_t> light;
  std::vector<GuideTally> tallies{1, GuideTally{}};

 private:
  uint32_t add(uint32_t depth) {
    const uint32_t node = static_cast<uint32_t>(quads.size());
    quads.push_back({});
    double values[4], sum = 0;
    for (double& value : values) sum += value = random_.magnitude_between(0.01, 1);
    for (uint32_t k = 0; k < 4; ++k) {
      quads[node].share[k] = static_cast<float>(values[k] / sum);
      if (depth > 1 && random_.uniform<double>() < 0.6) {
        const uint32_t child = add(depth - 1);
        quads[node].child[k] = child;
      }
    }
    return node;
  }

  Random random_;
};

template <class Real>
class Guides : public ::testing::Test {};
TYPED_TEST_SUITE(Guides, Reals);

TYPED_TEST(Guides, SquareThereAndBack) {
  using Real = TypeParam;
  Random random(1);
  constexpr double tolerance = by_precision<Real>(1e-6, 2e-15);
  for (int i = 0; i < 100'000; ++i) {
    const Vec3<Real> d = convert<Real>(random.on_sphere());
    const Vec2<Real> square = guide_square(d);
    ASSERT_TRUE(square.x >= 0 && square.x < 1 && square.y >= 0 && square.y < 1);
    const GuideDirection<Real> back = guide_direction(square);
    ASSERT_LT(static_cast<double>(length(back.direction - d)), tolerance);
    ASSERT_NEAR(static_cast<double>(back.density / guide_density(d)), 1, 10 * tolerance);
  }
  for (const Vec3<Real>& axis : {Vec3<Real>{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}})
    EXPECT_LT(static_cast<double>(length(guide_direction(guide_square(axis)).direction - axis)), tolerance);
}

TYPED_TEST(Guides, DensityOfTheSquare) {
  using Real = TypeParam;
  constexpr size_t side = 16, fine = 32;
  std::vector<double> counts(side * side);
  std::vector<double> expected(side * side);
  Random random(2);
  const size_t samples = effort(1'000'000);
  for (size_t i = 0; i < samples; ++i) {
    const Vec2<Real> s = guide_square(convert<Real>(random.on_sphere()));
    ++counts[static_cast<size_t>(s.y * side) * side + static_cast<size_t>(s.x * side)];
  }
  for (size_t y = 0; y < side * fine; ++y)
    for (size_t x = 0; x < side * fine; ++x) {
      const Vec2<double> s{(static_cast<double>(x) + 0.5) / (side * fine),
                           (static_cast<double>(y) + 0.5) / (side * fine)};
      expected[y / fine * side + x / fine] +=
          1 / (guide_direction(s).density * 4 * pi<double> * side * side * fine * fine);
    }
  EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1, 1e-4);
  for (double& e : expected) e *= static_cast<double>(samples);
  EXPECT_GT(chi_squared_test(counts, expected).p_value, 0.005);
}

TYPED_TEST(Guides, SamplesFollowThePdf) {
  using Real = TypeParam;
  constexpr uint32_t depth = 5, side = 1u << depth;
  RandomGuide guide(3, depth);
  const GuideView<Real> view = guide.view<Real>();
  const size_t samples = effort(1'000'000);
  std::vector<double> counts(side * side);
  std::vector<double> expected(side * side);
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const Vec2<Real> centre{(static_cast<Real>(x) + Real(0.5)) / side, (static_cast<Real>(y) + Real(0.5)) / side};
      expected[y * side + x] = static_cast<double>(guide_pdf(view, 1, centre)) / (side * side);
    }
  EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1, 1e-6);
  for (double& e : expected) e *= static_cast<double>(samples);
  Random random(4);
  for (size_t i = 0; i < samples; ++i) {
    const GuideSample<Real> s = sample_guide(view, 1, random.uniform_2d<Real>());
    ASSERT_TRUE(s.square.x >= 0 && s.square.x < 1 && s.square.y >= 0 && s.square.y < 1);
    ASSERT_NEAR(static_cast<double>(s.pdf / guide_pdf(view, 1, s.square)), 1, 1e-5);
    ++counts[static_cast<size_t>(s.square.y * side) * side + static_cast<size_t>(s.square.x * side)];
  }
  EXPECT_GT(chi_squared_test(counts, expected).p_value, 0.005);
}

TYPED_TEST(Guides, QuartersWithoutLightAreNotSampled) {
  using Real = TypeParam;
  RandomGuide guide(5, 1);
  guide.quads[1] = {{0, 0, 0, 1}, {0, 0, 0, 0}};
  Random random(6);
  for (const Real u : {Real(0), Real(0.5), one_minus_epsilon<Real>})
    for (const Real v : {Real(0), Real(0.5), one_minus_epsilon<Real>}) {
      const GuideSample<Real> s = sample_guide(guide.view<Real>(), 1, {u, v});
      EXPECT_EQ(s.pdf, 4);
      EXPECT_TRUE(s.square.x >= Real(0.5) && s.square.x < 1 && s.square.y >= Real(0.5) && s.square.y < 1);
    }
}

TYPED_TEST(Guides, RegionsHalveAxesInTurn) {
  using Real = TypeParam;
  RandomGuide guide(7, 1);
  // x, then y of the upper half, then z of the upper half of that.
  guide.cells = {1, leaf_cell | 0, 3, leaf_cell | 1, 5, leaf_cell | 2, leaf_cell | 3};
  const GuideView<Real> view = guide.view<Real>();
  const auto region = [&](Real x, Real y, Real z) {
    uint32_t depth;
    const uint32_t found = guide_region(view, guide_place(view, Vec3<Real>{x, y, z}), depth);
    EXPECT_EQ(depth, std::min(found + 1, 3u));
    return found;
  };
  EXPECT_EQ(region(Real(0.49), Real(0.9), Real(0.9)), 0u);
  EXPECT_EQ(region(Real(0.5), Real(0.49), Real(0.9)), 1u);
  EXPECT_EQ(region(Real(0.5), Real(0.5), Real(0.49)), 2u);
  EXPECT_EQ(region(Real(0.5), Real(0.5), Real(0.5)), 3u);
  EXPECT_EQ(region(-5, 2, 2), 0u);
  EXPECT_EQ(region(2, 2, 2), 3u);
  EXPECT_EQ(region(std::numeric_limits<Real>::quiet_NaN(), 0, 0), 0u);
}

template <class Real>
ShadingPoint<Real> white_point() {
  ShadingPoint<Real> point{};
  point.si.position = {Real(0.3), Real(0.6), Real(0.2)};
  point.si.normal = point.si.shading_normal = {0, 0, 1};
  point.bsdf.kind = MaterialKind::diffuse;
  point.bsdf.diffuse.reflectance = splat(Real(1));
  point.bsdf.frame = frame_about(Vec3<Real>{0, 0, 1});
  point.wo = normalize(Vec3<Real>{Real(0.2), Real(0.3), 1});
  return point;
}

/// The estimate of what a white surface reflects is 1, and that of the solid angle above it 2 pi, whatever the share.
TYPED_TEST(Guides, ScatteringIsUnbiased) {
  using Real = TypeParam;
  const ShadingPoint<Real> point = white_point<Real>();
  for (const float share : {1.0f, 0.5f, 0.1f}) {
    SCOPED_TRACE(share);
    RandomGuide guide(8, 5);
    guide.regions[0].bsdf_share = share;
    SceneView<Real> scene;
    scene.guide = guide.view<Real>();
    const GuidedDirections<Real> directions(scene, region_at(scene, point.si.position));
    Moments albedo, angle;
    for (uint32_t i = 0; i < effort(200'000); ++i) {
      const IndependentSampler sampler(9, i & 1023, i >> 10, 0);
      GuideVertex<Real> vertex{};
      vertex.throughput = 1;
      const BsdfSample<Real> s = scatter_guided(scene, point, directions, sampler, VertexDimensions(0), vertex);
      if (s.pdf > 0) {
        ASSERT_NEAR(static_cast<double>(s.pdf / directions.mixed(vertex.pdf_of_bsdf, vertex.pdf_of_guide)), 1, 1e-5);
        ASSERT_NEAR(static_cast<double>(vertex.pdf_of_guide /
                                        directions.pdf_of_guide(scene, s.direction, guide_square(s.direction))),
                    1, 1e-3);
      }
      albedo.add(s.pdf > 0 ? static_cast<double>(s.weight.x) : 0);
      angle.add(s.pdf > 0 ? 1 / static_cast<double>(s.pdf) : 0);
    }
    EXPECT_GT(mean_p_value(albedo, 1, 1e-5), 1e-3) << albedo.mean();
    if (share < 1) {
      EXPECT_GT(mean_p_value(angle, 2 * pi<double>, 1e-5), 1e-3) << angle.mean();
    }
  }
}

/// One vertex adds to one leaf, in fixed point, and moves between the regions around it.
TYPED_TEST(Guides, LearnsFromAVertex) {
  using Real = TypeParam;
  RandomGuide guide(10, 1);
  guide.quads[1].child[0] = guide.quads[1].child[1] = guide.quads[1].child[2] = guide.quads[1].child[3] = 0;
  GuideVertex<Real> vertex{};
  vertex.position = {Real(0.5), Real(0.5), Real(0.5)};
  vertex.region = 0;
  vertex.square = {Real(0.75), Real(0.25)};
  vertex.throughput = Real(0.5);
  vertex.pdf_of_bsdf = 2;
  vertex.pdf_of_guide = 1;
  vertex.share = Real(0.5);
  learn_from_vertex(guide.view<Real>(), vertex, Real(3), 1u);
  EXPECT_EQ(guide.tallies[0].vertices, 1u);
  EXPECT_EQ(guide.light[5], static_cast<uint64_t>(6 * guide_units));
  // The second moment is w^2 (pdf / tried pdf), so it falls by w^2 pdf (pdf of BSDF - pdf of guide) / (tried pdf)^2.
  for (uint32_t i = 0; i < tried_shares; ++i)
    EXPECT_NEAR(static_cast<double>(static_cast<int64_t>(guide.tallies[0].slopes[i])),
                36 * guide_units * 1.5 / sqr(1 + static_cast<double>(tried_share(i))), 32);
  guide.tallies[0] = {};
  std::swap(vertex.pdf_of_bsdf, vertex.pdf_of_guide);
  learn_from_vertex(guide.view<Real>(), vertex, Real(3), 1u);
  EXPECT_LT(static_cast<int64_t>(guide.tallies[0].slopes[0]), 0);
  // Nothing arrives, NaN, or more than the limit.
  const uint64_t before = guide.light[5];
  learn_from_vertex(guide.view<Real>(), vertex, Real(0), 1u);
  learn_from_vertex(guide.view<Real>(), vertex, std::numeric_limits<Real>::quiet_NaN(), 1u);
  learn_from_vertex(guide.view<Real>(), vertex, Real(-1), 1u);
  EXPECT_EQ(guide.light[5], before);
  learn_from_vertex(guide.view<Real>(), vertex, std::numeric_limits<Real>::infinity(), 1u);
  EXPECT_EQ(guide.light[5], before + static_cast<uint64_t>(guide_limit * guide_units));

  // Two regions with trees of their own.
  guide.cells = {1, leaf_cell | 0, leaf_cell | 1};
  guide.quads.push_back(guide.quads[1]);
  guide.regions.push_back({2, 0.5f});
  guide.tallies.assign(2, {});
  guide.light.assign(12, 0);
  for (uint32_t i = 0; i < 1000; ++i) learn_from_vertex(guide.view<Real>(), vertex, Real(1), i);
  EXPECT_EQ(guide.tallies[0].vertices, 1000u);
  EXPECT_NEAR(static_cast<double>(guide.light[5]) / static_cast<double>(guide.light[5] + guide.light[9]), 0.5, 0.06);
  vertex.position.x = Real(0.2);
  guide.light.assign(12, 0);
  for (uint32_t i = 0; i < 1000; ++i) learn_from_vertex(guide.view<Real>(), vertex, Real(1), i);
  EXPECT_GT(guide.light[5], 0u);
  EXPECT_NEAR(static_cast<double>(guide.light[9]) / static_cast<double>(guide.light[5] + guide.light[9]), 0, 0.06);
}

}  // namespace
}  // namespace alhazen::impl::test
