// Rough glass of pbrt and glTF: it keeps all light, is reciprocal, is sampled by its density, and becomes smooth glass
// as its roughness approaches 0, and clear as its index approaches 1.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "compile/tables/albedo_grids.h"
#include "support/density_check.h"
#include "support/layered.h"
#include "support/layered_checks.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

enum class Format { pbrt, gltf };

struct Glass {
  Format format;
  double ior;
  double alpha_u, alpha_v;  ///< gltf: alpha_u >= alpha_v
};

std::string name_of(const Glass& g) {
  return std::string(g.format == Format::pbrt ? "pbrt" : "glTF") + ", index " + std::to_string(g.ior) + ", alpha " +
         std::to_string(g.alpha_u) + " " + std::to_string(g.alpha_v);
}

template <class Real>
FlatMaterial<Real> material_of(const Glass& g) {
  Scene scene;
  if (g.format == Format::gltf) {
    PrincipledValues v;
    v.transmission = 1, v.thin = false, v.ior = g.ior, v.roughness = std::sqrt(g.alpha_v);
    if (g.alpha_u > g.alpha_v) v.anisotropy = std::sqrt((g.alpha_u - g.alpha_v) / (1 - g.alpha_v));
    const Material material = principled_material(scene, v);
    return {scene, material};
  }
  Material material;
  material.kind = MaterialKind::dielectric, material.ior = g.ior, material.remap_roughness = false;
  material.roughness_u = constant_in(scene, g.alpha_u);
  material.roughness_v = g.alpha_u == g.alpha_v ? material.roughness_u : constant_in(scene, g.alpha_v);
  return {scene, material};
}

constexpr Format formats[] = {Format::pbrt, Format::gltf};
constexpr double iors[] = {1.05, 1.33, 1.5, 2.42, 4};
constexpr double alphas[] = {0.02, 0.1, 0.3, 0.6, 1};

template <class Real>
Bsdf<Real> with_normal(Bsdf<Real> bsdf, const Vec3<Real>& normal) {
  bsdf.frame = frame_about(normal);
  return bsdf;
}

/// Returns the light that leaves a ball of glass for one path that hits it, without the change of radiance by
/// refraction, which cancels.
template <class Real>
double light_from_ball(const FlatMaterial<Real>& glass, Random& random) {
  const double r = std::sqrt(random.uniform<double>());
  Vec3<Real> position = convert<Real>(Vec3d{r, 0, safe_sqrt(1 - r * r)}), direction{0, 0, -1};
  double weight = 1;
  for (int hits = 0; hits < 10'000; ++hits) {
    const Bsdf<Real> bsdf = with_normal(glass.bsdf(static_cast<double>(-dot(direction, position))), position);
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, -direction, u_lobe, random.uniform_2d<Real>());
    if (!(s.pdf > 0)) return 0;
    weight *= static_cast<double>(s.weight.x * s.eta * s.eta);
    const Real inwards = -dot(s.direction, position);
    if (inwards <= 0) return weight;
    position = normalize(position + s.direction * (2 * inwards)), direction = s.direction;
  }
  return 0;
}

template <class Real>
class RoughGlass : public ::testing::Test {};
TYPED_TEST_SUITE(RoughGlass, Reals);

TYPED_TEST(RoughGlass, BallsKeepTheLightOfAFurnace) {
  Random random(51);
  for (const Format format : formats)
    for (const double ior : iors)
      for (const double alpha : alphas) {
        const Glass glass{format, ior, alpha, alpha};
        const FlatMaterial<TypeParam> material = material_of<TypeParam>(glass);
        const size_t paths = effort(10'000);
        double sum = 0, squares = 0;
        for (size_t i = 0; i < paths; ++i) {
          const double light = light_from_ball(material, random);
          sum += light, squares += light * light;
        }
        const double count = static_cast<double>(paths), mean = sum / count;
        const double error = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
        EXPECT_NEAR(mean, 1, widened(1e-3)) << name_of(glass);
        EXPECT_LT(error, widened(1e-3)) << name_of(glass);
      }
}

/// Weights above 1 would multiply along paths within a body, whose mean then converges slowly.
TYPED_TEST(RoughGlass, WeightsAreOne) {
  using Real = TypeParam;
  Random random(58);
  std::vector<Glass> all;
  for (const Format format : formats) {
    for (const double ior : iors)
      for (const double alpha : alphas) all.push_back({format, ior, alpha, alpha});
    all.push_back({format, 1.5, 0.5, 0.1});
    all.push_back({format, 2.42, 1, 0.3});
  }
  double largest = 0, largest_if_anisotropic = 0;
  for (const Glass& glass : all) {
    const FlatMaterial<Real> material = material_of<Real>(glass);
    double least = 1, most = 0;
    for (size_t i = 0; i < effort(20'000); ++i) {
      const double cosine = 2 * random.uniform<double>() - 1;
      const Bsdf<Real> bsdf = material.bsdf(cosine);
      const Real u_lobe = random.uniform<Real>();
      const BsdfSample<Real> s = sample_bsdf(bsdf, direction_at(bsdf.frame, cosine, 6 * random.uniform<double>()),
                                             u_lobe, random.uniform_2d<Real>());
      if (!(s.pdf > 0)) continue;
      const double weight = static_cast<double>(s.weight.x * s.eta * s.eta);
      least = std::min(least, weight), most = std::max(most, weight);
    }
    const bool is_anisotropic = glass.alpha_u != glass.alpha_v;
    (is_anisotropic ? largest_if_anisotropic : largest) =
        std::max(is_anisotropic ? largest_if_anisotropic : largest, most);
    EXPECT_GT(least, is_anisotropic ? 0.5 : 0.999) << name_of(glass);
    EXPECT_LT(most, is_anisotropic ? 1.6 : 1.001) << name_of(glass);
  }
  std::printf("largest weight %.6f, of anisotropic glass %.3f\n", largest, largest_if_anisotropic);
}

/// Seen from outside and from within, at every angle.
TYPED_TEST(RoughGlass, EachDirectionKeepsItsLight) {
  using Real = TypeParam;
  Random random(52);
  std::vector<Glass> all;
  for (const Format format : formats) {
    for (const double ior : {1.01, 1.1, 1.5, 2.42, 4.0})
      for (const double alpha : alphas) all.push_back({format, ior, alpha, alpha});
    all.push_back({format, 1.5, 0.5, 0.1});
    all.push_back({format, 2.42, 1, 0.3});
  }
  all.push_back({Format::pbrt, 0.7, 0.3, 0.3});
  all.push_back({Format::pbrt, 0.7, 1, 1});
  all.push_back({Format::pbrt, 1e6, 1, 1});
  for (const Glass& glass : all) {
    const FlatMaterial<Real> material = material_of<Real>(glass);
    for (const double cosine : {1.0, 0.8, 0.5, 0.2, -0.2, -0.45, -0.7, -0.9, -1.0}) {
      const Bsdf<Real> bsdf = material.bsdf(cosine);
      const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.6), static_cast<int>(effort(16384)), random);
      EXPECT_LT(e.mean, 1.003 + widened(4) * e.error) << name_of(glass) << ", cosine " << cosine;
      EXPECT_GT(e.mean, 0.99 - widened(4) * e.error) << name_of(glass) << ", cosine " << cosine;
    }
  }
}

/// A random walk among microfacets (Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model") of
/// uniformly distributed heights, independent of the BSDF. Directions are in the frame of the side on which light is.
class MicrofacetWalk {
 public:
  MicrofacetWalk(double ior, double alpha, Random& random) : ior_(ior), alpha_(alpha), random_(random) {}

  /// Returns whether light from outside that arrives at this cosine is transmitted.
  bool transmits(double cosine) {
    Vec3d w{-safe_sqrt(1 - cosine * cosine), 0, -cosine};
    double level = 1;  // fraction of the surface that is below the light
    bool outside = true;
    while (hits(w, level)) {
      const double eta = outside ? ior_ : 1 / ior_;
      const Vec3d o = -w, m = visible_normal(o);
      const double cos_o = std::max(dot(o, m), 1e-9);
      double cos_t;
      if (random_.uniform<double>() < fresnel_dielectric(cos_o, eta, cos_t)) {
        w = m * (2 * cos_o) - o;
      } else {
        const Vec3d t = normalize(m * (cos_o / eta - cos_t) - o * (1 / eta));
        w = {t.x, t.y, -t.z}, level = 1 - level, outside = !outside;
      }
    }
    return !outside;
  }

 private:
  /// Moves to the next microfacet; returns false if there is none.
  bool hits(const Vec3d& w, double& level) {
    const double u = random_.uniform<double>();
    if (w.z > 0.99999) return false;
    if (std::abs(w.z) < 1e-5) return true;
    const double lambda = w.z > 0 ? ggx_lambda(w, alpha_) : -1 - ggx_lambda(w, alpha_);
    if (w.z > 0 && u > 1 - std::pow(level, lambda)) return false;
    level = std::clamp(level * std::pow(1 - u, -1 / lambda), 1e-12, 1.0);
    return true;
  }

  /// Also for directions below the horizon, as from microfacets that face it.
  Vec3d visible_normal(const Vec3d& o) {
    const Vec3d stretched = normalize(stretch(o, alpha_));
    const double z = 1 - random_.uniform<double>() * (1 + stretched.z), r = safe_sqrt(1 - z * z);
    const double turn = 2 * pi<double> * random_.uniform<double>();
    const Vec3d n{r * std::cos(turn) + stretched.x, r * std::sin(turn) + stretched.y, std::max(z + stretched.z, 1e-12)};
    return normalize(stretch(n, alpha_));
  }

  double ior_, alpha_;
  Random& random_;
};

TYPED_TEST(RoughGlass, TransmitsAsARandomWalkAmongMicrofacets) {
  using Real = TypeParam;
  Random random(59);
  for (const double ior : {1.1, 1.5, 2.42, 4.0})
    for (const double alpha : {0.1, 0.3, 1.0}) {
      const Glass glass{Format::pbrt, ior, alpha, alpha};
      const FlatMaterial<Real> material = material_of<Real>(glass);
      MicrofacetWalk walk(ior, alpha, random);
      for (const double cosine : {1.0, 0.6, 0.3, 0.1}) {
        const Bsdf<Real> bsdf = material.bsdf(cosine);
        const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.6);
        const size_t samples = effort(40'000);
        double transmitted = 0, expected = 0;
        for (size_t i = 0; i < samples; ++i) {
          const Real u_lobe = random.uniform<Real>();
          const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
          if (s.eta != 1) transmitted += 1;
          if (walk.transmits(cosine)) expected += 1;
        }
        EXPECT_NEAR(transmitted / static_cast<double>(samples), expected / static_cast<double>(samples), widened(0.028))
            << name_of(glass) << ", cosine " << cosine;
      }
    }
}

/// f(wo, wi) / eta_i^2 = f(wi, wo) / eta_o^2 for radiance.
TYPED_TEST(RoughGlass, IsReciprocal) {
  using Real = TypeParam;
  Random random(53);
  size_t crossings = 0;
  for (const Format format : formats)
    for (const Glass& glass : {Glass{format, 1.1, 1, 1}, Glass{format, 1.5, 0.1, 0.1}, Glass{format, 1.5, 0.6, 0.6},
                               Glass{format, 2.42, 1, 1}, Glass{format, 1.5, 0.6, 0.2}}) {
      const FlatMaterial<Real> material = material_of<Real>(glass);
      for (int i = 0; i < 1000; ++i) {
        const Vec3<Real> a = convert<Real>(random.on_sphere()), b = convert<Real>(random.on_sphere());
        const Vec3<Real> n = tilted_frame<Real>().normal;
        // In float cosines below this are mostly rounding errors.
        if (abs_dot(a, n) < Real(0.02) || abs_dot(b, n) < Real(0.02)) continue;
        const auto value = [&](const Vec3<Real>& wo, const Vec3<Real>& wi) {
          const Bsdf<Real> bsdf = material.bsdf(static_cast<double>(dot(wo, n)));
          const double index = dot(wo, n) < 0 ? glass.ior : 1;
          return static_cast<double>(evaluate_bsdf(bsdf, wo, wi).value.y / abs_dot(wi, n)) / sqr(index);
        };
        const double forth = value(a, b), back = value(b, a);
        if (forth < 1e-5) continue;
        if (dot(a, n) * dot(b, n) < 0) ++crossings;
        ASSERT_NEAR(forth / back, 1, by_precision<Real>(1e-3, 1e-9)) << name_of(glass);
      }
    }
  EXPECT_GT(crossings, 2000u);
}

TYPED_TEST(RoughGlass, IsSampledByItsDensity) {
  using Real = TypeParam;
  Random random(54);
  constexpr size_t cases = 2 * 2 * 5 * 5;
  for (const Format format : formats)
    for (const Glass& glass : {Glass{format, 1.1, 0.6, 0.6}, Glass{format, 1.5, 0.3, 0.3}, Glass{format, 1.5, 1, 1},
                               Glass{format, 2.42, 1, 1}, Glass{format, 1.5, 0.6, 0.2}}) {
      const FlatMaterial<Real> material = material_of<Real>(glass);
      for (const double cosine : {0.9, 0.3, -0.2, -0.6, -0.95}) {
        const Bsdf<Real> bsdf = material.bsdf(cosine);
        check_density(bsdf, direction_at(bsdf.frame, cosine, 0.7), random, cases,
                      name_of(glass) + ", cosine " + std::to_string(cosine));
      }
    }
}

/// Returns the fraction of the light that is sent further than `angle` from `straight`.
template <class Real>
double deflected(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, const Vec3<Real>& straight, double angle,
                 Random& random) {
  constexpr int samples = 4096;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    if (s.pdf > 0 && static_cast<double>(dot(s.direction, straight)) < std::cos(angle))
      sum += static_cast<double>(s.weight.x * s.eta * s.eta);
  }
  return sum / samples;
}

TYPED_TEST(RoughGlass, BecomesClearAsTheIndexApproachesOne) {
  using Real = TypeParam;
  Random random(55);
  for (const Format format : formats)
    for (const double alpha : {0.3, 1.0})
      for (const double cosine : {0.9, 0.4, -0.4, -0.9}) {
        double last = 1;
        for (const double ior : {1.3, 1.1, 1.03, 1.01, 1.002}) {
          const Bsdf<Real> bsdf = material_of<Real>({format, ior, alpha, alpha}).bsdf(cosine);
          const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.3);
          const double part = deflected(bsdf, wo, -wo, 0.1, random);
          EXPECT_LT(part, last + 0.03) << "index " << ior << ", alpha " << alpha << ", cosine " << cosine;
          last = part;
        }
        EXPECT_LT(last, 0.02) << "alpha " << alpha << ", cosine " << cosine;
      }
}

TYPED_TEST(RoughGlass, BecomesSmoothAsTheRoughnessApproachesZero) {
  using Real = TypeParam;
  Random random(56);
  for (const Format format : formats)
    for (const double ior : {1.1, 1.5, 2.42})
      for (const double cosine : {0.9, 0.4, -0.95}) {
        const Bsdf<Real> bsdf = material_of<Real>({format, ior, 0.002, 0.002}).bsdf(cosine);
        const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.3);
        const Bsdf<Real> smooth = material_of<Real>({Format::pbrt, ior, 0, 0}).bsdf(cosine);
        const BsdfSample<Real> through = sample_bsdf(smooth, wo, one_minus_epsilon<Real>, Vec2<Real>{});
        ASSERT_TRUE(through.specular);
        double cos_t;
        const double reflectance = fresnel_dielectric(std::abs(cosine), cosine < 0 ? 1 / ior : ior, cos_t);
        EXPECT_NEAR(deflected(bsdf, wo, through.direction, 0.05, random), reflectance, 0.02)
            << "index " << ior << ", cosine " << cosine;
      }
}

/// A roughness that varies is looked up between the tabulated alphas.
TYPED_TEST(RoughGlass, KeepsItsLightWhereTheRoughnessVaries) {
  using Real = TypeParam;
  Random random(57);
  for (const double ior : {1.2, 1.5, 2.42}) {
    const AlbedoGrid grid{.kind = AlbedoGrid::Kind::glass, .ior = static_cast<double>(static_cast<Real>(ior))};
    const Table values = values_of(grid);
    std::vector<Real> table;
    for (const double value : *values) table.push_back(static_cast<Real>(value));
    for (const double alpha : {0.015, 0.07, 0.2, 0.43, 0.9})
      for (const double cosine : {0.9, 0.3, -0.3, -0.9}) {
        NamedBsdf<Real> named = glass_bsdf<Real>(alpha, ior);
        named.bsdf.dielectric.grid =
            grid_place(table.data(), record_of(grid), Vec2<Real>{static_cast<Real>(alpha), static_cast<Real>(alpha)});
        const Energy e =
            energy_of(named.bsdf, direction_at(named.bsdf.frame, cosine, 0.6), static_cast<int>(effort(16384)), random);
        EXPECT_NEAR(e.mean, 1, 0.006 + widened(4) * e.error) << named.name << ", index " << ior << ", " << cosine;
      }
  }
}

}  // namespace
}  // namespace alhazen::impl::test
