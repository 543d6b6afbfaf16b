// The layered materials: energy over the grid of their parameters, density and reciprocity.

#include <gtest/gtest.h>

#include "scene/mixes.h"
#include "support/density_check.h"
#include "support/effort.h"
#include "support/layered.h"
#include "support/layered_checks.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

std::string name_of(const PrincipledValues& v, double cosine, double azimuth) {
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
                                    {"ior", v.ior},
                                    {"diffuse transmission", v.diffuse_transmission},
                                    {"cosine", cosine},
                                    {"azimuth", azimuth}})
    name += std::string(what) + " " + std::to_string(value) + " ";
  return name;
}

template <class Real>
void check_energy(const PrincipledValues& values, Random& random, double& most) {
  const FlatMaterial<Real> material = principled_of<Real>(values);
  for (const double cosine : {1.0, 0.7, 0.4, 0.15, 0.03, -0.2, -0.8})
    for (const double azimuth : {0.0, 0.8, 1.5}) {
      if (azimuth > 0 && values.anisotropy == 0) continue;
      const Bsdf<Real> bsdf = material.bsdf(cosine);
      const Vec3<Real> wo = direction_at(bsdf.frame, cosine, azimuth);
      const Energy e = energy_of(bsdf, wo, static_cast<int>(effort(1024)), random);
      EXPECT_LT(e.mean - widened(4) * e.error, 1.01) << name_of(values, cosine, azimuth) << e.mean << " +- " << e.error;
      most = std::max(most, e.mean - widened(4) * e.error);
    }
}

template <class Real>
class Layered : public ::testing::Test {};
TYPED_TEST_SUITE(Layered, Reals);

TYPED_TEST(Layered, PrincipledFurnaceGainsNothing) {
  Random random(1);
  double most = 0;
  for (const double roughness : {0.0, 0.15, 0.4, 0.7, 1.0})
    for (const double metallic : {0.0, 0.5, 1.0})
      for (const double transmission : {0.0, 0.6, 1.0})
        for (const bool thin : {true, false})
          for (const int above : {0, 1, 2, 3}) {
            if (metallic == 1 && transmission > 0) continue;
            if (!thin && transmission == 0) continue;
            PrincipledValues v;
            v.roughness = roughness, v.metallic = metallic, v.transmission = transmission, v.thin = thin;
            v.clearcoat = above & 1 ? 1 : 0, v.clearcoat_roughness = roughness / 2;
            v.sheen = above & 2 ? 1 : 0, v.sheen_roughness = 0.1 + roughness * 0.8;
            check_energy<TypeParam>(v, random, most);
          }
  this->RecordProperty("most", std::to_string(most));
}

TYPED_TEST(Layered, AnisotropyIridescenceAndIndicesGainNothing) {
  Random random(2);
  double most = 0;
  for (const double roughness : {0.0, 0.3, 0.7})
    for (const double metallic : {0.0, 1.0})
      for (const double anisotropy : {0.0, 0.5, 1.0})
        for (const double ior : {1.0, 1.33, 2.4}) {
          PrincipledValues v;
          v.roughness = roughness, v.metallic = metallic, v.anisotropy = anisotropy, v.ior = ior;
          check_energy<TypeParam>(v, random, most);
          v.iridescence = 1;
          check_energy<TypeParam>(v, random, most);
          v.iridescence = 0, v.transmission = 1, v.thin = false;
          if (metallic == 0) check_energy<TypeParam>(v, random, most);
        }
}

/// A film on glass transmits what it does not reflect, in each channel.
TYPED_TEST(Layered, FilmsOnGlassGainNothing) {
  using Real = TypeParam;
  Random random(8);
  for (const double roughness : {0.0, 0.3, 0.7})
    for (const double ior : {1.33, 1.5, 2.4}) {
      PrincipledValues v;
      v.roughness = roughness, v.ior = ior, v.transmission = 1, v.thin = false, v.iridescence = 1;
      const FlatMaterial<Real> material = principled_of<Real>(v);
      for (const double cosine : {1.0, 0.7, 0.4, 0.15, -0.5}) {
        const Bsdf<Real> bsdf = material.bsdf(cosine);
        const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.4);
        Vec3d sum{};
        const int samples = static_cast<int>(effort(16384));
        for (int i = 0; i < samples; ++i) {
          const Real u_lobe = random.uniform<Real>();
          const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
          if (s.pdf > 0) sum += convert<double>(s.weight * (s.eta * s.eta));
        }
        EXPECT_LT(max_component(sum) / samples, 1.05) << name_of(v, cosine, 0.4);
        if (roughness == 0 && cosine > 0.3) {
          EXPECT_GT(max_component(sum) / samples, 0.9) << name_of(v, cosine, 0.4);
        }
      }
    }
}

TYPED_TEST(Layered, DiffuseTransmissionNeitherGainsNorLoses) {
  using Real = TypeParam;
  Random random(7);
  for (const double roughness : {0.1, 0.5, 1.0})
    for (const double fraction : {0.3, 1.0})
      for (const double cosine : {0.9, 0.3, -0.6}) {
        PrincipledValues v;
        v.roughness = roughness, v.diffuse_transmission = fraction;
        const Bsdf<Real> bsdf = principled_of<Real>(v).bsdf(cosine);
        const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.4), 16384, random);
        EXPECT_NEAR(e.mean, 1, 0.015 + 4 * e.error) << name_of(v, cosine, 0.4);
      }
}

/// White metal of any roughness, and white dielectric, reflect (nearly) all light.
TYPED_TEST(Layered, WhiteOpaqueLosesLittle) {
  using Real = TypeParam;
  Random random(3);
  for (const double roughness : {0.1, 0.4, 0.7, 1.0})
    for (const double metallic : {0.0, 1.0}) {
      PrincipledValues v;
      v.roughness = roughness, v.metallic = metallic;
      const FlatMaterial<Real> material = principled_of<Real>(v);
      for (const double cosine : {1.0, 0.6, 0.2}) {
        const Bsdf<Real> bsdf = material.bsdf(cosine);
        const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.4), 16384, random);
        EXPECT_NEAR(e.mean, 1, 0.015 + 4 * e.error) << name_of(v, cosine, 0.4);
      }
    }
}

template <class Real>
std::vector<PrincipledValues> mixtures() {
  std::vector<PrincipledValues> all(9);
  all[0].metallic = 0.4, all[0].roughness = 0.5;
  all[1].clearcoat = 0.8, all[1].clearcoat_roughness = 0.4, all[1].metallic = 0.2, all[1].roughness = 0.7;
  all[2].sheen = 0.7, all[2].sheen_roughness = 0.4;
  all[3].transmission = 0.6, all[3].roughness = 0.5;
  all[4].transmission = 0.7, all[4].roughness = 0.6, all[4].thin = false, all[4].clearcoat = 0.5,
  all[4].clearcoat_roughness = 0.6;
  all[5].anisotropy = 0.6, all[5].metallic = 0.7, all[5].roughness = 0.6;
  all[6].transmission = 1, all[6].roughness = 0.5, all[6].thin = false;
  all[7].diffuse_transmission = 0.6, all[7].roughness = 0.4, all[7].metallic = 0.1;
  all[8].diffuse_transmission = 0.8, all[8].transmission = 0.3, all[8].roughness = 0.5, all[8].sheen = 0.4;
  return all;
}

TYPED_TEST(Layered, SamplesFollowTheirDensity) {
  using Real = TypeParam;
  Random random(4);
  for (const PrincipledValues& v : mixtures<Real>()) {
    const FlatMaterial<Real> material = principled_of<Real>(v);
    for (const double cosine : {0.95, 0.3, -0.6}) {
      const Bsdf<Real> bsdf = material.bsdf(cosine);
      check_density(bsdf, direction_at(bsdf.frame, cosine, 0.7), random, 2 * 9 * 3, name_of(v, cosine, 0.7));
    }
  }
}

TYPED_TEST(Layered, SheetsAndAnisotropicOnesFollowTheirDensity) {
  using Real = TypeParam;
  Random random(5);
  const Frame<Real> frame = tilted_frame<Real>();
  const Vec2<Real> alpha{Real(0.5), Real(0.15)};
  Bsdf<Real> metal{MaterialKind::anisotropic_conductor, frame}, glass{MaterialKind::anisotropic_dielectric, frame};
  Bsdf<Real> sheet{MaterialKind::diffuse_transmission, frame};
  metal.anisotropic_conductor = {splat(Real(0.3)), splat(Real(0.6)), alpha};
  glass.anisotropic_dielectric = {Real(1.5), alpha};
  sheet.diffuse_transmission = {splat(Real(0.3)), splat(Real(0.6))};
  for (const auto& [name, bsdf] : {std::pair{"metal", metal}, {"glass", glass}, {"sheet", sheet}})
    for (const double cosine : {0.9, 0.3, -0.5})
      check_density(bsdf, direction_at(frame, cosine, 0.7), random, 2 * 9, name);
}

/// f(wo, wi) = f(wi, wo) for reflection without coat and sheen.
TYPED_TEST(Layered, Reciprocity) {
  using Real = TypeParam;
  Random random(6);
  size_t tested = 0;
  for (const PrincipledValues& v : mixtures<Real>()) {
    if (v.clearcoat > 0 || v.transmission > 0 || v.sheen > 0) continue;
    const Bsdf<Real> bsdf = principled_of<Real>(v).bsdf(1);
    const Vec3<Real> n = bsdf.frame.normal;
    for (int i = 0; i < 2000; ++i) {
      const Vec3<Real> a = convert<Real>(random.on_sphere()), b = convert<Real>(random.on_sphere());
      if (abs_dot(a, n) < Real(0.02) || dot(a, n) * dot(b, n) <= 0 || abs_dot(b, n) < Real(0.02)) continue;
      const double forth = static_cast<double>(evaluate_bsdf(bsdf, a, b).value.y / abs_dot(b, n));
      const double back = static_cast<double>(evaluate_bsdf(bsdf, b, a).value.y / abs_dot(a, n));
      ++tested;
      ASSERT_NEAR(forth / back, 1, by_precision<Real>(1e-3, 1e-9));
    }
  }
  EXPECT_GT(tested, 1000u);
}

TEST(Mix, OfItselfIsRefused) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[0].kind = scene.materials[1].kind = MaterialKind::mix;
  scene.materials[0].mixed = {1, 2};
  scene.materials[1].mixed = {2, 2};
  EXPECT_NO_THROW(check_mixes(scene));
  scene.materials[1].mixed = {2, 0};
  EXPECT_THROW(check_mixes(scene), InputError);
}

/// A pane transmits and reflects all light.
TEST(ThinDielectric, LosesNothing) {
  Random random(9);
  Bsdf<double> bsdf{MaterialKind::thin_dielectric, tilted_frame<double>()};
  bsdf.thin_dielectric.ior = 1.5;
  for (const double cosine : {1.0, 0.3, -0.05}) {
    const Vec3d wo = direction_at(bsdf.frame, cosine, 0.3);
    EXPECT_NEAR(energy_of(bsdf, wo, 1000, random).mean, 1, 1e-12);
    EXPECT_NEAR(length(sample_bsdf(bsdf, wo, 0.9999, Vec2d{}).direction + wo), 0, 1e-12);
  }
}

}  // namespace
}  // namespace alhazen::impl::test
