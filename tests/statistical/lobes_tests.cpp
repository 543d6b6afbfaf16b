// Materials of several lobes select the lobe by the light that it carries: the weights of their samples vary little.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "support/effort.h"
#include "support/layered.h"
#include "support/random.h"

namespace alhazen::impl::test {
namespace {

/// Mean and variance of the weights for one outgoing direction.
struct Weights {
  double albedo = 0;    ///< mean over samples and channels
  double variance = 0;  ///< of the weight relative to the albedo: that of one sample in a white furnace
};

template <class Real>
Weights weights_of(const Bsdf<Real>& bsdf, double cosine, size_t samples, Random& random) {
  const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.6);
  double squares = 0;
  Weights w;
  for (size_t i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    const Vec3d e = s.pdf > 0 ? convert<double>(s.weight) * static_cast<double>(s.eta * s.eta) : Vec3d{};
    const double mean = (e.x + e.y + e.z) / 3;
    w.albedo += mean, squares += mean * mean;
  }
  w.albedo /= static_cast<double>(samples);
  if (!(w.albedo > 0)) return w;
  w.variance = squares / static_cast<double>(samples) / (w.albedo * w.albedo) - 1;
  return w;
}

struct NamedMaterial {
  std::string name;
  Material material;
  double max_variance;  ///< bound for directions outside
};

std::string join(const std::string& name, std::initializer_list<double> values) {
  std::string all = name;
  for (const double value : values) {
    char text[16];
    std::snprintf(text, sizeof text, " %g", value);
    all += text;
  }
  return all;
}

/// Numbers in names are colour, roughness of the base, and roughness of what is above it.
std::vector<NamedMaterial> materials_in(Scene& scene) {
  std::vector<NamedMaterial> all;
  const auto principled = [&](const std::string& name, double max_variance, const PrincipledValues& v) {
    all.push_back({name, principled_material(scene, v), max_variance});
  };
  for (const double colour : {0.1, 0.8}) {
    for (const double roughness : {0.05, 0.4, 1.0}) {
      principled(join("plastic", {colour, roughness}), 0.5, {.roughness = roughness, .colour = colour});
      principled(join("metal", {colour, roughness}), colour < 0.5 ? 1.1 : 0.3,
                 {.metallic = 1, .roughness = roughness, .colour = colour});
    }
    for (const double roughness : {0.0, 0.4})
      principled(join("coated metal", {colour, 0.6, roughness}), roughness > 0 ? 0.6 : 0.2,
                 {.metallic = 1, .roughness = 0.6, .clearcoat = 1, .clearcoat_roughness = roughness, .colour = colour});
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
      principled(join("cloth", {colour, 0.9, roughness}), 1.3,
                 {.roughness = 0.9, .sheen = 0.8, .sheen_roughness = roughness, .colour = colour});
    for (const double roughness : {0.1, 0.5})
      principled(join("thin glass", {colour, roughness}), 0.8,
                 {.roughness = roughness, .transmission = 1, .colour = colour});
    principled(join("leaf", {colour, 0.5}), 0.3, {.roughness = 0.5, .colour = colour, .diffuse_transmission = 0.5});
  }
  for (const double colour : {0.0, 0.1, 0.8})
    for (const double roughness : {0.1, 0.5}) {
      principled(join("glass", {colour, roughness}), 1,
                 {.roughness = roughness, .transmission = 1, .thin = false, .colour = colour});
      principled(join("half glass", {colour, roughness}), 1,
                 {.roughness = roughness, .transmission = 0.5, .thin = false, .colour = colour});
    }
  Material m;
  m.remap_roughness = false;
  for (const double colour : {0.1, 0.9})
    for (const double alpha : {0.0, 0.3}) {
      m.reflectance = constant_in(scene, colour), m.roughness_u = m.roughness_v = constant_in(scene, alpha);
      m.kind = MaterialKind::coated_diffuse;
      all.push_back({join("coated diffuse", {colour, alpha}), m, 0.7});
      m.kind = MaterialKind::coated_conductor;
      for (const double coat : {0.0, 0.3}) {
        m.coat_roughness = constant_in(scene, coat);
        all.push_back({join("coated conductor", {colour, alpha, coat}), m, coat > 0 ? 0.7 : 0.25});
      }
    }
  for (const double roughness : {0.2, 1.0}) {
    m.kind = MaterialKind::oren_nayar, m.roughness_u = constant_in(scene, roughness);
    all.push_back({join("Oren-Nayar", {0.9, roughness}), m, 0.1});
  }
  return all;
}

/// Prints the tables of docs/results/quality.md.
TEST(Lobes, WeightsVaryLittle) {
  Scene scene;
  Random random(71);
  constexpr double views[] = {1, 0.7, 0.4, 0.15, 0.03};
  std::printf("variance of the weight relative to the albedo, by cosine\n| material | 1 | 0.7 | 0.4 | 0.15 | 0.03 |\n");
  for (const NamedMaterial& m : materials_in(scene)) {
    Scene own = scene;
    const FlatMaterial<double> flat(own, m.material);
    std::printf("| %s |", m.name.c_str());
    for (const double cosine : views) {
      const Weights w = weights_of(flat.bsdf(cosine), cosine, effort(20'000), random);
      std::printf(" %.3f |", w.variance);
      EXPECT_LT(w.variance, widened(1) * m.max_variance) << m.name << ", cosine " << cosine;
    }
    std::printf("\n");
  }
}

PrincipledBsdf<double> without_base(PrincipledBsdf<double> b) {
  b.dielectric = b.metal = b.glass = 0;
  b.diffuse = b.diffuse_through = b.through = {};
  return b;
}

/// Returns the fractions of the light that the lobes carry, in the order of probabilities_of; the reflection of metal
/// is not divided into single and multiple scattering, since the diffuse lobe helps to sample both.
std::array<double, 4> fractions_of(Bsdf<double> bsdf, double cosine, Random& random) {
  const PrincipledBsdf<double> b = bsdf.principled;
  const auto energy = [&](const PrincipledBsdf<double>& changed) {
    bsdf.principled = changed;
    return weights_of(bsdf, cosine, effort(40'000), random).albedo;
  };
  const double all = energy(b);
  PrincipledBsdf<double> coat = without_base(b), fuzz = coat, below = b;
  coat.sheen = {}, below.through = {}, below.diffuse_through = {};
  const double of_coat = energy(coat);
  return {of_coat / all, (energy(fuzz) - of_coat) / all, 1 - energy(below) / all, all};
}

/// Of coat, sheen and transmission, as far as they are estimated from tables.
TEST(Lobes, ProbabilitiesAreFractionsOfTheAlbedo) {
  Scene scene;
  Random random(72);
  std::printf("| material | cosine | coat | probability | sheen | probability | transmission | probability |\n");
  for (const NamedMaterial& m : materials_in(scene)) {
    if (m.material.kind != MaterialKind::principled || !m.material.principled.thin) continue;
    Scene own = scene;
    const FlatMaterial<double> flat(own, m.material);
    for (const double cosine : {0.9, 0.15}) {
      const Bsdf<double> bsdf = flat.bsdf(cosine);
      const double sine = std::sqrt(1 - cosine * cosine);
      const PrincipledLobes<double> lobes =
          lobes_of(bsdf.principled, Vec3d{sine * std::cos(0.6), sine * std::sin(0.6), cosine});
      const std::array<double, 4> fractions = fractions_of(bsdf, cosine, random);
      const double probabilities[] = {lobes.coat, lobes.fuzz, lobes.through + lobes.diffuse_through};
      if (probabilities[0] + probabilities[1] + probabilities[2] == 0) continue;
      std::printf("| %s | %.2f |", m.name.c_str(), cosine);
      for (int lobe = 0; lobe < 3; ++lobe) {
        std::printf(" %.3f | %.3f |", std::max(0.0, fractions[lobe]), probabilities[lobe]);
        EXPECT_NEAR(fractions[lobe], probabilities[lobe], widened(0.05))
            << m.name << ", cosine " << cosine << ", lobe " << lobe;
      }
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test
