// Furnaces at a point: the fraction of uniform light that the layered materials scatter, over the ranges of their
// parameters. Without absorption it is 1.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "support/density_check.h"
#include "support/layered.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

/// Fraction of the light that is scattered in each channel, without the change of radiance by refraction, and its
/// error.
struct Albedo {
  Vec3d mean{}, error{};
};

template <class Real>
Albedo albedo_of(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, size_t samples, Random& random) {
  Vec3d sum{}, squares{};
  for (size_t i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    if (!(s.pdf > 0)) continue;
    const Vec3d e = convert<double>(s.weight * (s.eta * s.eta));
    EXPECT_TRUE(is_finite(e));
    sum += e, squares += e * e;
  }
  Albedo albedo;
  const double count = static_cast<double>(samples);
  for (int c = 0; c < 3; ++c) {
    albedo.mean[c] = sum[c] / count;
    albedo.error[c] = std::sqrt(std::max(0.0, squares[c] / count - sqr(albedo.mean[c])) / count);
  }
  return albedo;
}

std::string name_of(const PrincipledValues& v) {
  std::string name;
  for (const auto& [what, value] : {std::pair{"metallic", v.metallic},
                                    {"roughness", v.roughness},
                                    {"transmission", v.transmission},
                                    {"thin", v.thin ? 1.0 : 0.0},
                                    {"clearcoat", v.clearcoat},
                                    {"clearcoat roughness", v.clearcoat_roughness},
                                    {"sheen", v.sheen},
                                    {"sheen roughness", v.sheen_roughness},
                                    {"anisotropy", v.anisotropy},
                                    {"iridescence", v.iridescence},
                                    {"specular", v.specular},
                                    {"ior", v.ior},
                                    {"diffuse transmission", v.diffuse_transmission}})
    name += std::string(what) + " " + std::to_string(value) + ", ";
  return name;
}

/// All light is scattered, within a hundredth, in each channel and from either side.
void expect_all_light(const PrincipledValues& v, Random& random, double slack = 0.01, size_t samples = 2048) {
  const FlatMaterial<float> material = principled_of<float>(v);
  for (const double cosine : {0.95, 0.5, 0.15, -0.3, -0.8}) {
    const Bsdf<float> bsdf = material.bsdf(cosine);
    const Albedo a = albedo_of(bsdf, direction_at(bsdf.frame, cosine, 0.4), effort(samples), random);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(a.mean[c], 1, slack + widened(5) * a.error[c]) << name_of(v) << "cosine " << cosine;
  }
}

constexpr double roughnesses[] = {0, 0.1, 0.35, 0.666, 1};

TEST(PrincipledFurnace, GlassOfAnyRoughnessAndIndexLosesNothing) {
  Random random(21);
  for (const double roughness : roughnesses)
    for (const double ior : {1.0, 1.1, 1.5, 2.4, 1e6})
      for (const double transmission : {0.5, 1.0})
        for (const bool thin : {false, true}) {
          PrincipledValues v;
          v.roughness = roughness, v.ior = ior, v.transmission = transmission, v.thin = thin;
          expect_all_light(v, random);
        }
}

TEST(PrincipledFurnace, AnisotropicMetalLosesNothing) {
  Random random(22);
  for (const double roughness : roughnesses)
    for (const double anisotropy : {0.0, 0.3, 0.7, 1.0}) {
      PrincipledValues v;
      v.metallic = 1, v.roughness = roughness, v.anisotropy = anisotropy;
      expect_all_light(v, random);
    }
}

TEST(PrincipledFurnace, FilmsLoseNothing) {
  Random random(23);
  for (const double roughness : {0.2, 0.7})
    for (const double metallic : {0.0, 1.0})
      for (const double transmission : {0.0, 1.0})
        for (const bool thin : {true, false}) {
          PrincipledValues v;
          v.roughness = roughness, v.metallic = metallic, v.transmission = transmission, v.thin = thin;
          v.iridescence = 0.8;
          expect_all_light(v, random, 0.015);
        }
}

/// What a film does not reflect, since the interface reflects nothing, reaches the layers below.
TEST(PrincipledFurnace, FilmsOfWeakInterfacesLoseNothing) {
  Random random(26);
  for (const double specular : {0.0, 0.02, 0.3})
    for (const double film_ior : {1.3, 2.0})
      for (const double transmission : {0.0, 1.0}) {
        PrincipledValues v;
        v.roughness = 0.45, v.specular = specular, v.transmission = transmission, v.thin = true;
        v.iridescence = 1, v.iridescence_ior = film_ior;
        expect_all_light(v, random, 0.015);
      }
}

/// Any mixture of lobes; few samples find sheen at the horizon, so its roughness is not minimal.
TEST(PrincipledFurnace, MixturesOfAllLobesLoseNothing) {
  Random random(24);
  const auto any = [&] { return random.uniform<double>(); };
  const auto some = [&](double chance) { return any() < chance ? any() : 0; };
  for (size_t i = 0; i < effort(64); ++i) {
    PrincipledValues v;
    v.roughness = any(), v.metallic = some(0.4), v.transmission = some(0.6), v.thin = any() < 0.4;
    v.clearcoat = some(0.4), v.clearcoat_roughness = any();
    v.sheen = some(0.4), v.sheen_roughness = 0.3 + 0.7 * any();
    v.anisotropy = some(0.15), v.iridescence = some(0.3), v.specular = any() < 0.5 ? 1 : any();
    v.ior = 1 + 2 * any(), v.diffuse_transmission = some(0.3);
    expect_all_light(v, random, 0.015);
  }
}

/// A body that transmits light by refraction and diffusely: radiance inside is scaled alike for both.
TEST(PrincipledFurnace, BodiesScaleDiffuseLightAsTheyRefract) {
  PrincipledValues v;
  v.transmission = 0.5, v.diffuse_transmission = 1, v.thin = false, v.roughness = 0.5;
  const FlatMaterial<double> material = principled_of<double>(v);
  Random random(25);
  for (const double cosine : {0.7, -0.7}) {
    const Bsdf<double> bsdf = material.bsdf(cosine);
    const double eta = cosine > 0 ? v.ior : 1 / v.ior;
    size_t crossings = 0;
    for (int i = 0; i < 1000; ++i) {
      const double u = random.uniform<double>();
      const BsdfSample<double> s =
          sample_bsdf(bsdf, direction_at(bsdf.frame, cosine, 0.4), u, random.uniform_2d<double>());
      if (!(s.pdf > 0) || dot(s.direction, bsdf.frame.normal) * cosine > 0) continue;
      EXPECT_NEAR(s.eta, eta, 1e-12);
      ++crossings;
    }
    EXPECT_GT(crossings, 100u);
  }
}

/// A sheet blurs by refraction at its microfacets: not at all if its index is 1, and like glTF's default from 1.5 on.
TEST(ThinTransmission, IsSharpWhereTheIndexIsOne) {
  Random random(26);
  for (const bool thin : {true, false})
    for (const double roughness : {0.2, 1.0}) {
      PrincipledValues v;
      v.roughness = roughness, v.ior = 1, v.transmission = 1, v.thin = thin;
      const Bsdf<float> bsdf = principled_of<float>(v).bsdf(0.6);
      const Vec3<float> wo = direction_at(bsdf.frame, 0.6, 0.3);
      size_t through = 0, sharp = 0;
      for (int i = 0; i < 2000; ++i) {
        const float u_lobe = random.uniform<float>();
        const BsdfSample<float> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<float>());
        if (!(s.pdf > 0) || dot(s.direction, bsdf.frame.normal) > 0) continue;
        ++through;
        sharp += length(s.direction + wo) < 0.05f ? 1 : 0;
      }
      EXPECT_GT(through, 1800u);
      EXPECT_GT(static_cast<double>(sharp), 0.99 * static_cast<double>(through)) << "roughness " << roughness;
    }
}

TEST(ThinTransmission, BlursByTheIndex) {
  const Vec2d alpha{0.5, 0.2};
  for (const auto& [ior, scale] : {std::pair{1.5, 1.0}, {1.25, 0.5}, {1.0, 0.0}, {2.4, 1.0}}) {
    const Vec2d blurred = thin_alpha(alpha, ior);
    EXPECT_NEAR(blurred.x, layered_alpha(alpha.x * scale), 1e-12) << ior;
    EXPECT_NEAR(blurred.y, layered_alpha(alpha.y * scale), 1e-12) << ior;
  }
}

Material coat(Scene& scene, MaterialKind kind, double ior, double alpha_u, double alpha_v, double reflectance) {
  Material m;
  m.kind = kind, m.ior = m.coat_ior = ior, m.remap_roughness = false;
  m.reflectance = constant_in(scene, reflectance);
  m.roughness_u = constant_in(scene, alpha_u);
  m.roughness_v = alpha_u == alpha_v ? m.roughness_u : constant_in(scene, alpha_v);
  m.coat_roughness = constant_in(scene, alpha_u);
  return m;
}

TEST(CoatFurnace, WhiteDiffuseBelowAnyIndexLosesNothing) {
  Random random(27);
  for (const double ior : {1e-6, 0.1, 0.5, 0.9, 0.9999, 1.0, 1.00001, 1.0001, 1.5, 3.0, 100.0, 1e6, 1e30})
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {0.1, 0.1}, {0.3, 0.3}, {1.0, 1.0}, {0.1, 0.5}}) {
      Scene scene;
      const FlatMaterial<float> material(scene, coat(scene, MaterialKind::coated_diffuse, ior, u, v, 1));
      for (const double cosine : {1.0, 0.7, 0.3, -0.5}) {
        const Bsdf<float> bsdf = material.bsdf(cosine);
        const Albedo a = albedo_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), effort(2048), random);
        EXPECT_NEAR(a.mean.x, 1, 0.01 + widened(5) * a.error.x)
            << "ior " << ior << ", alpha " << u << " " << v << ", cosine " << cosine;
      }
    }
}

TEST(CoatFurnace, MetalBelowAnyIndexGainsNothing) {
  Random random(28);
  for (const double ior : {0.1, 0.5, 1.0, 1.5, 1e30})
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {0.1, 0.1}, {0.1, 0.6}}) {
      Scene scene;
      const FlatMaterial<float> material(scene, coat(scene, MaterialKind::coated_conductor, ior, u, v, 1));
      for (const double cosine : {1.0, 0.7, 0.3, 0.05, 0.02, -0.5}) {
        const Bsdf<float> bsdf = material.bsdf(cosine);
        const Albedo a = albedo_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), effort(2048), random);
        EXPECT_LT(a.mean.x - widened(5) * a.error.x, 1.003)
            << "ior " << ior << ", alpha " << u << " " << v << ", cosine " << cosine;
      }
    }
}

/// Values that a file may contain although nobody intends them: the results are still finite.
TEST(CoatFurnace, NoParameterMakesNumbersThatAreNone) {
  Random random(29);
  for (const MaterialKind kind : {MaterialKind::coated_diffuse, MaterialKind::coated_conductor, MaterialKind::conductor,
                                  MaterialKind::dielectric, MaterialKind::thin_dielectric})
    for (const double ior : {1e-30, 1.0, 1e30})
      for (const double index : {-1e30, 0.0, 1e30})
        for (const double roughness : {-1.0, 10.0}) {
          Scene scene;
          Material m = coat(scene, kind, ior, roughness, roughness, 2);
          m.thickness = ior;
          if (kind != MaterialKind::coated_diffuse)
            m.reflectance = no_index, m.eta = constant_in(scene, index), m.k = constant_in(scene, 1e30);
          const FlatMaterial<float> material(scene, m);
          for (const double cosine : {1.0, 0.3, 1e-6, -0.4}) {
            const Bsdf<float> bsdf = material.bsdf(cosine);
            albedo_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), 16, random);
            const BsdfValue<float> v = evaluate_bsdf(bsdf, direction_at(bsdf.frame, cosine, 0.3),
                                                     direction_at(bsdf.frame, 0.5, random.uniform<double>()));
            EXPECT_TRUE(is_finite(v.value) && std::isfinite(v.pdf)) << static_cast<int>(kind) << " " << ior;
          }
        }
}

/// The densities added by diffuse transmission, films, and cones for an index below 1.
TEST(LayeredEnergy, SamplesFollowTheirDensity) {
  Random random(30);
  std::vector<std::pair<std::string, FlatMaterial<float>>> all;
  all.reserve(4);  // their views point into the elements
  PrincipledValues v;
  v.transmission = 0.5, v.thin = false, v.roughness = 0.6;
  all.emplace_back("part glass", principled_of<float>(v));
  v.diffuse_transmission = 0.5, v.iridescence = 1, v.specular = 0.5, v.metallic = 0.3;
  all.emplace_back("film on glass", principled_of<float>(v));
  v = {}, v.transmission = 1, v.ior = 1.2, v.roughness = 0.8, v.anisotropy = 0.3;
  all.emplace_back("sheet", principled_of<float>(v));
  Scene scene;
  all.emplace_back("coat of index 0.5",
                   FlatMaterial<float>(scene, coat(scene, MaterialKind::coated_diffuse, 0.5, 0.3, 0.3, 0.8)));
  for (const auto& [name, material] : all)
    for (const double cosine : {0.9, 0.4, -0.7}) {
      const Bsdf<float> bsdf = material.bsdf(cosine);
      check_density(bsdf, direction_at(bsdf.frame, cosine, 0.7), random, 4 * 3, name + std::to_string(cosine));
    }
}

}  // namespace
}  // namespace alhazen::impl::test
