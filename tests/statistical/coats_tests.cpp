// The coated materials of pbrt against a random walk between interface and base, as in pbrt-v4's LayeredBxDF.

#include "core/materials/conductor.h"
#include "support/density_check.h"
#include "support/layered_checks.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

struct Coat {
  MaterialKind kind = MaterialKind::coated_diffuse;
  double alpha = 0, metal_alpha = 0;
  double reflectance = 0.5, thickness = 0;
  int bounces = 0;  ///< 0: no limit
  CoatModel model = CoatModel::pbrt;

  template <class Real>
  FlatMaterial<Real> material() const {
    Scene scene;
    scene.coats = model;
    Material m;
    m.kind = kind;
    m.remap_roughness = false;
    m.reflectance = constant_in(scene, reflectance);
    const uint32_t roughness = constant_in(scene, kind == MaterialKind::coated_diffuse ? alpha : metal_alpha);
    m.roughness_u = m.roughness_v = roughness;
    m.coat_roughness = constant_in(scene, alpha);
    m.thickness = thickness;
    m.coat_bounces = bounces;
    return {scene, m};
  }

  std::string name(double cosine) const {
    return "alpha " + std::to_string(alpha) + ", of the metal " + std::to_string(metal_alpha) + ", reflectance " +
           std::to_string(reflectance) + ", thickness " + std::to_string(thickness) + ", cosine " +
           std::to_string(cosine) + " ";
  }
};

/// Scatters light from `direction` at the base; returns the fraction that goes up again.
double scatter_at_base(const Coat& coat, Vec3d& direction, Random& random) {
  const Vec3d up{-direction.x, -direction.y, -direction.z};
  if (coat.kind == MaterialKind::coated_diffuse) {
    direction = sample_cosine_hemisphere(random.uniform_2d<double>());
    return coat.reflectance;
  }
  const double k = absorption_for_reflectance(coat.reflectance) / 1.5;
  const BsdfSample<double> s =
      ConductorBsdf<double>{splat(1 / 1.5), splat(k), coat.metal_alpha}.sample(up, 0, random.uniform_2d<double>());
  direction = s.direction;
  return s.pdf > 0 ? s.weight.y : 0;
}

/// The weight of one walk that starts outside.
double walk(const Coat& coat, double cosine, Random& random) {
  const DielectricBsdf<double> interface { 1.5, coat.alpha };
  const auto cross = [&](const Vec3d& wo, Vec3d& direction) {
    const double u = random.uniform<double>();
    const DielectricBranches<double> both = dielectric_branches(interface, wo, random.uniform_2d<double>());
    const BsdfSample<double>& s = u < both.reflected_rate ? both.reflected : both.refracted;
    direction = s.direction;
    return s.pdf > 0 ? s.weight.y * s.eta * s.eta : 0;
  };
  Vec3d direction{};
  double weight = cross({std::sqrt(1 - cosine * cosine), 0, cosine}, direction);
  if (weight == 0 || direction.z > 0) return weight;
  for (int bounce = 0; bounce < (coat.bounces > 0 ? coat.bounces : 200); ++bounce) {
    weight *= std::exp(coat.thickness / direction.z) * scatter_at_base(coat, direction, random);
    if (!(weight > 0) || !(direction.z > 0)) return 0;
    weight *= std::exp(-coat.thickness / direction.z);
    const Vec3d below{-direction.x, -direction.y, -direction.z};
    weight *= cross(below, direction);
    if (weight == 0 || direction.z > 0) return weight;
  }
  return 0;
}

void expect_albedo_of_walk(const Coat& coat, double tolerance, Random& random) {
  const FlatMaterial<double> material = coat.material<double>();
  for (const double cosine : {1.0, 0.5, 0.2}) {
    const Bsdf<double> bsdf = material.bsdf(cosine);
    const int samples = static_cast<int>(effort(40'000));
    const Energy ours = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), samples, random);
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
      const double w = walk(coat, cosine, random);
      sum += w, squares += w * w;
    }
    const double walked = sum / samples, error = std::sqrt((squares / samples - walked * walked) / samples);
    EXPECT_NEAR(ours.mean, walked, tolerance * walked + 4 * (ours.error + error)) << coat.name(cosine);
    EXPECT_LT(ours.mean - 4 * ours.error, 1.01) << coat.name(cosine);
  }
}

TEST(CoatedDiffuse, SmoothHasTheAlbedoOfARandomWalk) {
  Random random(7);
  for (const CoatModel model : {CoatModel::lossless, CoatModel::pbrt})
    for (const double reflectance : {0.2, 0.6, 0.95})
      for (const double thickness : {0.0, 0.01, 0.1}) {
        Coat coat;
        coat.reflectance = reflectance, coat.thickness = thickness, coat.model = model;
        expect_albedo_of_walk(coat, 0.01, random);
      }
}

TEST(CoatedDiffuse, RoughLosesAsMuchAsARandomWalkWherePbrtIsAskedFor) {
  Random random(8);
  for (const double alpha : {0.05, 0.1, 0.3, 0.7})
    for (const double reflectance : {0.2, 0.8, 1.0})
      for (const int bounces : {0, 5}) {
        Coat coat;
        coat.alpha = alpha, coat.reflectance = reflectance, coat.thickness = 0.01, coat.bounces = bounces;
        expect_albedo_of_walk(coat, 0.012, random);
      }
}

TEST(CoatedDiffuse, LosslessOnesSendAllLightBack) {
  Random random(9);
  for (const double alpha : {0.0, 0.1, 0.3, 1.0}) {
    Coat coat;
    coat.alpha = alpha, coat.reflectance = 1, coat.model = CoatModel::lossless;
    const FlatMaterial<float> material = coat.material<float>();
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const Bsdf<float> bsdf = material.bsdf(cosine);
      const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), 20'000, random);
      EXPECT_NEAR(e.mean, 1, 0.01 + 4 * e.error) << coat.name(cosine);
    }
  }
}

TEST(CoatedConductor, HasAboutTheAlbedoOfARandomWalk) {
  Random random(10);
  for (const double alpha : {0.0, 0.1, 0.3})
    for (const double metal_alpha : {0.0, 0.1, 0.3, 0.6})
      for (const double reflectance : {0.6, 0.95}) {
        Coat coat;
        coat.kind = MaterialKind::coated_conductor;
        coat.alpha = alpha, coat.metal_alpha = metal_alpha, coat.reflectance = reflectance;
        coat.thickness = 0.01, coat.bounces = 5;
        // One lobe represents all, and its Fresnel term is that of a smooth coat.
        expect_albedo_of_walk(coat, alpha > 0.2 && metal_alpha < 0.2 ? 0.1 : 0.04, random);
      }
}

std::vector<Coat> rough_coats() {
  std::vector<Coat> coats(3);
  coats[0].alpha = 0.3, coats[0].thickness = 0.1;
  coats[1].kind = coats[2].kind = MaterialKind::coated_conductor;
  coats[1].alpha = 0.4, coats[1].metal_alpha = 0.3;
  coats[2].alpha = 0.1, coats[2].metal_alpha = 0.5, coats[2].model = CoatModel::lossless;
  return coats;
}

template <class Real>
class Coats : public ::testing::Test {};
TYPED_TEST_SUITE(Coats, Reals);

TYPED_TEST(Coats, SamplesFollowTheirDensity) {
  using Real = TypeParam;
  Random random(11);
  for (const Coat& coat : rough_coats()) {
    const FlatMaterial<Real> material = coat.material<Real>();
    for (const double cosine : {0.95, 0.3, -0.6}) {
      const Bsdf<Real> bsdf = material.bsdf(cosine);
      check_density(bsdf, direction_at(bsdf.frame, cosine, 0.7), random, 2 * 3 * 3, coat.name(cosine));
    }
  }
}

TYPED_TEST(Coats, Reciprocity) {
  using Real = TypeParam;
  Random random(12);
  for (const Coat& coat : rough_coats()) {
    const Bsdf<Real> bsdf = coat.material<Real>().bsdf(1);
    const Vec3<Real> n = bsdf.frame.normal;
    for (int i = 0; i < 1000; ++i) {
      const Vec3<Real> a = convert<Real>(random.on_sphere()), b = convert<Real>(random.on_sphere());
      if (abs_dot(a, n) < Real(0.02) || dot(a, n) * dot(b, n) <= 0 || abs_dot(b, n) < Real(0.02)) continue;
      const double forth = static_cast<double>(evaluate_bsdf(bsdf, a, b).value.y / abs_dot(b, n));
      const double back = static_cast<double>(evaluate_bsdf(bsdf, b, a).value.y / abs_dot(a, n));
      ASSERT_NEAR(forth / back, 1, by_precision<Real>(1e-3, 1e-9)) << coat.name(0);
    }
  }
}

/// For varying roughness the tables are a grid over it, whose values at and between the nodes match those of constants.
TEST(CoatedConductor, TexturedRoughnessLooksLikeConstantOnes) {
  Random random(13);
  for (const double alpha : {0.0816, 0.25}) {
    Coat coat;
    coat.kind = MaterialKind::coated_conductor;
    coat.alpha = 0.1, coat.metal_alpha = alpha, coat.reflectance = 0.9;
    Scene scene;
    Material m;
    m.kind = coat.kind;
    m.remap_roughness = false;
    m.reflectance = constant_in(scene, coat.reflectance);
    Texture product;
    product.kind = TextureKind::scale;
    product.inputs = {constant_in(scene, alpha), constant_in(scene, 1), no_index};
    scene.textures.push_back(product);
    m.roughness_u = m.roughness_v = static_cast<uint32_t>(scene.textures.size() - 1);
    m.coat_roughness = constant_in(scene, coat.alpha);
    const FlatMaterial<double> varying(scene, m), constant = coat.material<double>();
    for (const double cosine : {0.9, 0.4}) {
      const Bsdf<double> a = varying.bsdf(cosine), b = constant.bsdf(cosine);
      const Energy ours = energy_of(a, direction_at(a.frame, cosine, 0.3), 40'000, random);
      const Energy other = energy_of(b, direction_at(b.frame, cosine, 0.3), 40'000, random);
      EXPECT_NEAR(ours.mean, other.mean, 0.03 * other.mean + 4 * (ours.error + other.error)) << coat.name(cosine);
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test
