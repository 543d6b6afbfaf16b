// Textures at points with known values.

#include <gtest/gtest.h>

#include "compile/materials.h"
#include "compile/scene_arrays.h"
#include "core/textures/texture.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

/// Textures of a description, compiled: texture i of `textures` is the reflectance of material i.
template <class Real>
class Textures {
 public:
  explicit Textures(std::vector<Texture> textures, std::vector<ImageTexels> images = {}) {
    Scene scene;
    scene.images = std::move(images);
    for (uint32_t i = 0; i < textures.size(); ++i) {
      Material material;
      material.reflectance = i;
      scene.materials.push_back(material);
    }
    scene.textures = std::move(textures);
    SceneArrays<Real> arrays;
    compile_materials(scene, arrays);
    arrays.move_into(flat_);
  }

  Vec3d at(uint32_t texture, const Vec3d& position, const Vec2d& uv = {}) const {
    return convert<double>(evaluate_texture(
        flat_.view, flat_.view.materials[texture].diffuse.reflectance,
        TexturePoint<Real>{convert<Real>(position), {static_cast<Real>(uv.x), static_cast<Real>(uv.y)}}));
  }
  Vec3d with_normal(uint32_t texture, const Vec3d& normal) const {
    return convert<double>(evaluate_texture(flat_.view, flat_.view.materials[texture].diffuse.reflectance,
                                            TexturePoint<Real>{{}, {}, convert<Real>(normal)}));
  }
  double at_uv(uint32_t texture, double u, double v) const { return at(texture, {}, {u, v}).x; }
  const uint8_t* noise_permutation() const { return flat_.view.noise_permutation; }

 private:
  CompiledScene<Real> flat_;
};

Texture constant(double value) {
  Texture texture;
  texture.value = splat(value);
  return texture;
}

Texture over(TextureKind kind, const std::array<uint32_t, 3>& inputs) {
  Texture texture;
  texture.kind = kind;
  texture.inputs = inputs;
  return texture;
}

Texture of_kind(TextureKind kind) { return over(kind, {no_index, no_index, no_index}); }

template <class Real>
class TextureEvaluation : public ::testing::Test {};
TYPED_TEST_SUITE(TextureEvaluation, Reals);

TYPED_TEST(TextureEvaluation, CheckerboardOverUv) {
  Texture checks = over(TextureKind::checkerboard, {0, 1, no_index});
  Texture scaled = checks;
  scaled.uv_scale = {4, 2};
  scaled.uv_offset = {0.5, 0};
  const Textures<TypeParam> t({constant(0.25), constant(0.75), checks, scaled});
  EXPECT_EQ(t.at_uv(2, 0.5, 0.5), 0.25);
  EXPECT_EQ(t.at_uv(2, 1.5, 0.5), 0.75);
  EXPECT_EQ(t.at_uv(2, 1.5, 1.5), 0.25);
  EXPECT_EQ(t.at_uv(2, -0.5, 0.5), 0.75);
  EXPECT_EQ(t.at_uv(2, -0.5, -0.5), 0.25);
  EXPECT_EQ(t.at_uv(2, -1.5, -0.5), 0.75);
  EXPECT_EQ(t.at_uv(3, 0.1, 0.25), 0.25);  // (0.9, 0.5)
  EXPECT_EQ(t.at_uv(3, 0.2, 0.25), 0.75);  // (1.3, 0.5)
  EXPECT_EQ(t.at_uv(3, 0.2, 0.75), 0.25);  // (1.3, 1.5)
}

TYPED_TEST(TextureEvaluation, CheckerboardInSpace) {
  Texture checks = over(TextureKind::checkerboard, {0, 1, no_index});
  checks.solid_checks = true;
  Texture moved = checks;
  moved.texture_from_world = Transform::scale({2, 2, 2});
  const Textures<TypeParam> t({constant(0.25), constant(0.75), checks, moved});
  for (int x = -3; x < 3; ++x)
    for (int y = -3; y < 3; ++y)
      for (int z = -3; z < 3; ++z) {
        const double expected = ((x + y + z) & 1) == 0 ? 0.25 : 0.75;
        EXPECT_EQ(t.at(2, {x + 0.5, y + 0.25, z + 0.75}).x, expected) << x << y << z;
        EXPECT_EQ(t.at(3, {(x + 0.5) / 2, (y + 0.25) / 2, (z + 0.75) / 2}).x, expected) << x << y << z;
      }
}

/// Two by two texels: 0 and 1 above, 2 and 3 below, as bytes a of 255.
ImageTexels two_by_two(bool srgb) {
  ImageTexels image;
  image.width = image.height = 2;
  image.srgb = srgb;
  for (const int value : {0, 51, 102, 204}) image.bytes.insert(image.bytes.end(), 3, static_cast<uint8_t>(value));
  return image;
}

Texture image_texture(WrapMode wrap, bool nearest) {
  Texture texture = of_kind(TextureKind::image);
  texture.image = 0;
  texture.wrap = wrap;
  texture.nearest = nearest;
  return texture;
}

template <class Real>
constexpr double rounding = by_precision<Real>(1e-6, 1e-12);

TYPED_TEST(TextureEvaluation, NearestTexelWithVUpwards) {
  const Textures<TypeParam> t({image_texture(WrapMode::repeat, true), image_texture(WrapMode::black, true),
                               image_texture(WrapMode::clamp, true)},
                              {two_by_two(false)});
  const double tolerance = rounding<TypeParam>;
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(t.at_uv(i, 0.2, 0.9), 0.0, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.8, 0.9), 0.2, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.2, 0.1), 0.4, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.8, 0.1), 0.8, tolerance);
  }
  // To the left of the image, in its lower half.
  EXPECT_NEAR(t.at_uv(0, -0.2, 0.1), 0.8, tolerance);
  EXPECT_NEAR(t.at_uv(0, -7.2, 4.1), 0.8, tolerance);
  EXPECT_EQ(t.at_uv(1, -0.2, 0.1), 0);
  EXPECT_NEAR(t.at_uv(2, -0.2, 0.1), 0.4, tolerance);
  // Above it.
  EXPECT_NEAR(t.at_uv(0, 0.8, 1.1), 0.8, tolerance);
  EXPECT_EQ(t.at_uv(1, 0.8, 1.1), 0);
  EXPECT_NEAR(t.at_uv(2, 0.8, 1.1), 0.2, tolerance);
}

TYPED_TEST(TextureEvaluation, BilinearTexels) {
  const Textures<TypeParam> t({image_texture(WrapMode::repeat, false), image_texture(WrapMode::black, false),
                               image_texture(WrapMode::clamp, false)},
                              {two_by_two(false)});
  const double tolerance = rounding<TypeParam>;
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(t.at_uv(i, 0.25, 0.75), 0.0, tolerance);  // centres of texels
    EXPECT_NEAR(t.at_uv(i, 0.75, 0.25), 0.8, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.5, 0.75), 0.1, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.25, 0.5), 0.2, tolerance);
    EXPECT_NEAR(t.at_uv(i, 0.5, 0.5), 0.35, tolerance);
  }
  // Halfway to the texel beyond the right edge.
  EXPECT_NEAR(t.at_uv(0, 1, 0.25), 0.6, tolerance);
  EXPECT_NEAR(t.at_uv(1, 1, 0.25), 0.4, tolerance);
  EXPECT_NEAR(t.at_uv(2, 1, 0.25), 0.8, tolerance);
  // Infinity and NaN give some value.
  EXPECT_TRUE(std::isfinite(t.at_uv(0, 1e30, 0)));
  EXPECT_TRUE(std::isfinite(t.at_uv(0, std::numeric_limits<double>::quiet_NaN(), 0)));
}

TYPED_TEST(TextureEvaluation, SrgbFactorAndInversion) {
  Texture inverted = image_texture(WrapMode::repeat, true);
  inverted.invert = true;
  inverted.image_scale = 0.5;
  const Textures<TypeParam> t({image_texture(WrapMode::repeat, true), inverted}, {two_by_two(true)});
  const double decoded = std::pow((0.8 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(t.at_uv(0, 0.8, 0.1), decoded, rounding<TypeParam>);
  EXPECT_NEAR(t.at_uv(1, 0.8, 0.1), 1 - 0.5 * decoded, rounding<TypeParam>);
}

TYPED_TEST(TextureEvaluation, FloatTexelsAreLinear) {
  ImageTexels image;
  image.width = 2;
  image.height = 1;
  image.floats = {0.5f, 1.5f, 7.25f, 100, 200, 300};
  const Textures<TypeParam> t({image_texture(WrapMode::repeat, true)}, {image});
  EXPECT_EQ(t.at(0, {}, {0.25, 0.5}), (Vec3d{0.5, 1.5, 7.25}));
  EXPECT_EQ(t.at(0, {}, {0.75, 0.5}), (Vec3d{100, 200, 300}));
}

/// (s, t) = (2 u, v) rotated counter-clockwise by 90 degrees, then translated: (-v + 0.25, 2 u + 0.5).
TYPED_TEST(TextureEvaluation, UvAreScaledThenTurnedThenMoved) {
  Texture turned = of_kind(TextureKind::coordinates);
  turned.uv_scale = {2, 1};
  turned.uv_offset = {0.25, 0.5};
  turned.uv_rotation = 90;
  Texture slanted = of_kind(TextureKind::coordinates);
  slanted.uv_rotation = 30;
  const Textures<TypeParam> t({turned, slanted});
  const Vec3d st = t.at(0, {}, {0.3, 0.1});
  EXPECT_NEAR(st.x, 0.15, rounding<TypeParam>);
  EXPECT_NEAR(st.y, 1.1, rounding<TypeParam>);
  EXPECT_NEAR(t.at(1, {}, {1, 0}).x, std::sqrt(0.75), rounding<TypeParam>);
  EXPECT_NEAR(t.at(1, {}, {1, 0}).y, 0.5, rounding<TypeParam>);
  EXPECT_NEAR(t.at(1, {}, {0, 1}).x, -0.5, rounding<TypeParam>);
}

/// s is mirrored, t clamped.
TYPED_TEST(TextureEvaluation, WrapModesOfTheTwoAxes) {
  Texture texture = image_texture(WrapMode::mirror, true);
  texture.wrap_t = WrapMode::clamp;
  const Textures<TypeParam> t({texture, image_texture(WrapMode::mirror, true)}, {two_by_two(false)});
  const double tolerance = rounding<TypeParam>;
  EXPECT_NEAR(t.at_uv(0, 0.8, 0.1), 0.8, tolerance);
  EXPECT_NEAR(t.at_uv(0, 1.2, 0.1), 0.8, tolerance);
  EXPECT_NEAR(t.at_uv(0, 1.8, 0.1), 0.4, tolerance);
  EXPECT_NEAR(t.at_uv(0, -0.2, 0.1), 0.4, tolerance);
  EXPECT_NEAR(t.at_uv(0, -0.8, 0.1), 0.8, tolerance);
  EXPECT_NEAR(t.at_uv(0, 0.8, 7.1), 0.2, tolerance);
  EXPECT_NEAR(t.at_uv(1, 0.8, 1.1), 0.2, tolerance);
  EXPECT_NEAR(t.at_uv(1, 0.8, 1.9), 0.8, tolerance);
}

TYPED_TEST(TextureEvaluation, OneChannelAndChannelsOfThree) {
  ImageTexels image;
  image.width = image.height = 1;
  image.floats = {0.25f, 0.5f, 0.75f};
  ImageTexels grey = image;
  grey.channels = 1;
  grey.floats = {0.625f};
  Texture second = image_texture(WrapMode::repeat, false);
  second.image = 1;
  Texture blue = over(TextureKind::channel, {0, no_index, no_index});
  blue.channel = 2;
  const Textures<TypeParam> t({image_texture(WrapMode::repeat, false), second, blue}, {image, grey});
  EXPECT_EQ(t.at(1, {}), splat(0.625));
  EXPECT_EQ(t.at(2, {}), splat(0.75));
  ImageTexels wrong = image;
  wrong.channels = 2;
  EXPECT_THROW(Textures<TypeParam>({image_texture(WrapMode::repeat, false)}, {wrong}), InputError);
}

TYPED_TEST(TextureEvaluation, MappingsThatLookAtThePosition) {
  Texture spherical = of_kind(TextureKind::coordinates);
  spherical.mapping = TextureMappingKind::spherical;
  spherical.texture_from_world = Transform::translate({-1, 0, 0});
  Texture cylindrical = spherical, planar = spherical;
  cylindrical.mapping = TextureMappingKind::cylindrical;
  planar.mapping = TextureMappingKind::planar;
  const Textures<TypeParam> t({spherical, cylindrical, planar});
  const double tolerance = rounding<TypeParam>;
  EXPECT_NEAR(length(t.at(0, {1, 0, 3}) - Vec3d{0, 0, 0}), 0, tolerance);       // the north pole
  EXPECT_NEAR(length(t.at(0, {1, 2, 0}) - Vec3d{0.5, 0.25, 0}), 0, tolerance);  // +y
  EXPECT_NEAR(length(t.at(0, {1, -2, 0}) - Vec3d{0.5, 0.75, 0}), 0, tolerance);
  EXPECT_NEAR(length(t.at(1, {1, 2, 7}) - Vec3d{0.75, 7, 0}), 0, tolerance);
  EXPECT_NEAR(length(t.at(1, {3, 0, 7}) - Vec3d{0.5, 7, 0}), 0, tolerance);
  EXPECT_NEAR(length(t.at(2, {3, 5, 7}) - Vec3d{2, 5, 0}), 0, tolerance);
}

TYPED_TEST(TextureEvaluation, DirectionMixFollowsTheNormal) {
  Texture mix = over(TextureKind::direction_mix, {0, 1, no_index});
  mix.direction = {0, 2, 0};
  const Textures<TypeParam> t({constant(1), constant(0.25), mix});
  const auto facing = [&](const Vec3d& normal) { return t.with_normal(2, normal).x; };
  EXPECT_NEAR(facing({0, 1, 0}), 1, rounding<TypeParam>);
  EXPECT_NEAR(facing({0, -1, 0}), 1, rounding<TypeParam>);
  EXPECT_NEAR(facing({1, 0, 0}), 0.25, rounding<TypeParam>);
  EXPECT_NEAR(facing({0.8, 0.6, 0}), 0.6 + 0.4 * 0.25, rounding<TypeParam>);
}

/// By definition a cell has a dot if the noise at its centre is positive, near that centre.
TYPED_TEST(TextureEvaluation, DotsLieInTheCellsThatNoiseChooses) {
  const Textures<TypeParam> t({constant(1), constant(0), over(TextureKind::dots, {0, 1, no_index})});
  int dots = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const bool has_dot = perlin_noise(t.noise_permutation(), Vec3<double>{i + 0.5, j + 0.5, 0.5}) > 0;
      dots += has_dot;
      // The dot's centre is at most 0.15 from that of the cell; its radius is 0.35.
      EXPECT_EQ(t.at_uv(2, i + 0.01, j + 0.01), has_dot ? 1 : 0) << i << " " << j;
      EXPECT_EQ(t.at_uv(2, i + 0.499, j + 0.499), 0);
    }
  EXPECT_GT(dots, 100);
  EXPECT_LT(dots, 300);
}

TYPED_TEST(TextureEvaluation, WindyIsTheProductOfTwoNoises) {
  const Textures<TypeParam> t({of_kind(TextureKind::windy)});
  for (const Vec3d& p : {Vec3d{1.3, 2.7, 0.4}, Vec3d{-7.1, 3.3, 9.8}}) {
    const double strength = octave_noise(t.noise_permutation(), p * 0.1, 0.5, 3u, false);
    const double waves = octave_noise(t.noise_permutation(), p, 0.5, 6u, false);
    EXPECT_NEAR(t.at(0, p).x, std::abs(strength) * waves, by_precision<TypeParam>(1e-5, 1e-12));
  }
}

Texture cellular(double jitter, bool is_cell) {
  Texture texture = of_kind(TextureKind::cellular);
  texture.value = {jitter, is_cell ? 1.0 : 0.0, 0};
  return texture;
}

/// Without jitter the points are the centres of the cells.
TYPED_TEST(TextureEvaluation, CellularNoiseWithoutJitterIsALattice) {
  const Textures<TypeParam> t({cellular(0, false), cellular(0, true)});
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p = random.in_box(-20, 20);
    const Vec3d from_centre{p.x - std::floor(p.x) - 0.5, p.y - std::floor(p.y) - 0.5, p.z - std::floor(p.z) - 0.5};
    EXPECT_NEAR(t.at(0, p).x, length(from_centre), by_precision<TypeParam>(2e-5, 1e-12));
    const Vec3d corner{std::floor(p.x) + 0.25, std::floor(p.y) + 0.75, std::floor(p.z) + 0.5};
    EXPECT_EQ(t.at(1, p).x, t.at(1, corner).x) << "one number for the whole cell";
  }
}

/// The closest point among those of all cells around, and the number of its cell.
TYPED_TEST(TextureEvaluation, CellularNoiseFindsTheClosestPoint) {
  using Real = TypeParam;
  const Textures<Real> t({cellular(1, false), cellular(1, true)});
  Random random(2);
  double farthest = 0, sum = 0;
  constexpr int points = 20000;
  for (int n = 0; n < points; ++n) {
    const Vec3<Real> p = convert<Real>(random.in_box(-8, 8));
    const auto cell = [](Real x) { return static_cast<int>(std::floor(x)); };
    double closest = 100, number = -1;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = -3; k <= 3; ++k) {
          const int x = cell(p.x) + i, y = cell(p.y) + j, z = cell(p.z) + k;
          const uint32_t hash = cellular_hash(x, y, z);
          const Vec3d at = convert<double>(cellular_point(hash, Real(1))) + Vec3d{x + 0.0, y + 0.0, z + 0.0};
          const double distance = length(at - convert<double>(p));
          if (distance >= closest) continue;
          closest = distance;
          number = static_cast<double>(unit_interval<Real>(combine32(hash, 3)));
        }
    ASSERT_NEAR(t.at(0, convert<double>(p)).x, closest, by_precision<Real>(5e-6, 1e-12));
    ASSERT_EQ(t.at(1, convert<double>(p)).x, number);
    farthest = std::max(farthest, closest);
    sum += number;
  }
  EXPECT_GT(farthest, 1) << "the second ring of cells is tested";
  EXPECT_LT(farthest, std::sqrt(3.0));
  EXPECT_NEAR(sum / points, 0.5, 0.02);
}

TYPED_TEST(TextureEvaluation, CellularNoiseRepeatsAndEndsAtInfinity) {
  const Textures<TypeParam> t({cellular(1, false)});
  const Vec3d p{0.25, 0.5, 0.75};
  EXPECT_EQ(t.at(0, p).x, t.at(0, p + Vec3d{65536, 0, 0}).x);
  EXPECT_EQ(t.at(0, p).x, t.at(0, p - Vec3d{0, 65536, 131072}).x);
  for (const double far : {1e30, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(std::isfinite(t.at(0, {far, 0, -far}).x)) << far;
}

TYPED_TEST(TextureEvaluation, ScaleAndMixNest) {
  const Textures<TypeParam> t({constant(0.5), constant(0.25), constant(0.75),
                               over(TextureKind::scale, {0, 1, no_index}),    // 0.125
                               over(TextureKind::mix, {1, 2, 0}),             // 0.5
                               over(TextureKind::mix, {3, 4, 1}),             // 0.125 * 0.75 + 0.5 * 0.25
                               over(TextureKind::scale, {5, 5, no_index}),    //
                               over(TextureKind::mix, {6, 5, 4}),             //
                               over(TextureKind::scale, {4, 7, no_index})});  //
  const double mixed = 0.125 * 0.75 + 0.5 * 0.25;
  EXPECT_NEAR(t.at(3, {}).x, 0.125, rounding<TypeParam>);
  EXPECT_NEAR(t.at(4, {}).x, 0.5, rounding<TypeParam>);
  EXPECT_NEAR(t.at(5, {}).x, mixed, rounding<TypeParam>);
  EXPECT_NEAR(t.at(6, {}).x, mixed * mixed, rounding<TypeParam>);
  EXPECT_NEAR(t.at(7, {}).x, 0.5 * (mixed * mixed + mixed), rounding<TypeParam>);
  EXPECT_NEAR(t.at(8, {}).x, 0.25 * (mixed * mixed + mixed), rounding<TypeParam>);
}

TEST(TextureNesting, TooDeepIsAnError) {
  std::vector<Texture> textures{constant(0.5)};
  for (uint32_t i = 0; i < 20; ++i) textures.push_back(over(TextureKind::mix, {0, 0, i}));
  EXPECT_THROW(Textures<float>{textures}, InputError);
  EXPECT_THROW(Textures<float>({over(TextureKind::scale, {0, 0, no_index})}), InputError) << "a texture of itself";
}

TYPED_TEST(TextureEvaluation, NoiseIsZeroOnTheLattice) {
  using Real = TypeParam;
  const Textures<Real> t({of_kind(TextureKind::fbm)});
  Random random(1);
  double largest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d cell{random.below(2000) - 1000.0, random.below(2000) - 1000.0, random.below(2000) - 1000.0};
    ASSERT_EQ(perlin_noise(t.noise_permutation(), convert<Real>(cell)), Real(0));
    const double value =
        static_cast<double>(perlin_noise(t.noise_permutation(), convert<Real>(random.in_box(-1000, 1000))));
    largest = std::max(largest, std::abs(value));
  }
  EXPECT_LE(largest, 1.1);
  EXPECT_GT(largest, 0.7);
}

TYPED_TEST(TextureEvaluation, NoiseIsContinuous) {
  using Real = TypeParam;
  const Textures<Real> t({of_kind(TextureKind::fbm)});
  Random random(2);
  // Steps across the planes of the lattice, also where it repeats.
  for (int i = 0; i < 20'000; ++i) {
    Vec3d p = random.in_box(-300, 300), q = p;
    const int axis = static_cast<int>(random.below(3));
    const double plane = i % 4 == 0 ? 256 : std::floor(p[axis]);
    p[axis] = plane - 1e-3;
    q[axis] = plane + 1e-3;
    ASSERT_NEAR(static_cast<double>(perlin_noise(t.noise_permutation(), convert<Real>(p))),
                static_cast<double>(perlin_noise(t.noise_permutation(), convert<Real>(q))), 0.01);
  }
}

TYPED_TEST(TextureEvaluation, OctavesSum) {
  Texture one = of_kind(TextureKind::fbm), two = one, wrinkled = of_kind(TextureKind::wrinkled);
  one.octaves = 1;
  two.octaves = 2;
  two.roughness = wrinkled.roughness = 0.3;
  wrinkled.octaves = 3;
  const Textures<TypeParam> t({one, two, wrinkled});
  const auto noise = [&](const Vec3d& p) { return perlin_noise(t.noise_permutation(), p); };
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p = random.in_box(-10, 10);
    const double first = noise(p), second = noise(p * 1.99), third = noise(p * (1.99 * 1.99));
    EXPECT_NEAR(t.at(0, p).x, first, 20 * rounding<TypeParam>);
    EXPECT_NEAR(t.at(1, p).x, first + 0.3 * second, 40 * rounding<TypeParam>);
    EXPECT_NEAR(t.at(2, p).x, std::abs(first) + 0.3 * std::abs(second) + 0.09 * std::abs(third),
                60 * rounding<TypeParam>);
  }
}

/// Between the darkest and the brightest colour of its spline, times 1.5.
TYPED_TEST(TextureEvaluation, MarbleStaysWithinItsColours) {
  const Textures<TypeParam> t({of_kind(TextureKind::marble)});
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d colour = t.at(0, random.in_box(-100, 100));
    ASSERT_TRUE(colour.x >= 0.3 - 1e-6 && colour.x <= 0.9 + 1e-6 && colour.y >= 0.3 - 1e-6 &&
                colour.y <= 0.885 + 1e-6 && colour.z >= 0.495 - 1e-6 && colour.z <= 0.9 + 1e-6)
        << colour.x << " " << colour.y << " " << colour.z;
  }
}

}  // namespace
}  // namespace alhazen::impl::test
