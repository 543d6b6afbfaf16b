#pragma once

// Layers over each other: a clearcoat over sheen over a base that mixes metal and dielectric, the dielectric over
// diffuse or transmitted light. What a layer sends back by its albedo (core/materials/albedo_table.h) is kept from what
// lies below, so no layering makes more light than arrives. The layers are those of appendix B of glTF 2.0 and of its
// KHR_materials extensions; pbrt's coats are the same with the dielectric's exact Fresnel term. Light that metal
// scatters several times is given back as Kulla and Conty 2017 do ("Revisiting Physically Based Shading at
// Imageworks"). There are no single directions: what is smooth has an alpha of `least_alpha`.

#include "core/materials/albedo_table.h"
#include "core/materials/coated_metal.h"
#include "core/materials/dielectric.h"
#include "core/materials/sheen.h"
#include "core/math/frame.h"

namespace ALHAZEN_CORE {

template <class Real>
inline constexpr Real least_layered_alpha = Real(1.5e-3);

/// The parameters with their textures evaluated. Not initialised where it is not used.
template <class Real>
struct LayeredBsdf {
  const Real* tables;  ///< SceneView::albedo_tables
  Vec2<Real> alpha;    ///< of the base
  // Dielectric
  Real dielectric;               ///< share of the base that is a dielectric whose back does not refract
  const Real* interface_albedo;  ///< exact Fresnel term by `ior`; null: that of f0 and f90
  Vec3<Real> f0;
  Real f90;
  Real ior;
  Vec3<Real> diffuse;          ///< colour below the interface, times the share of the base that has it
  Vec3<Real> diffuse_through;  ///< the same of light that leaves diffusely on the other side
  const Real*
      transmission;  ///< what a coat lets through to the diffuse base, and out again; null: what it does not reflect
  Real exit;         ///< of a coat: 1 / (share of light that leaves from below, times ior^2)
  // Light that goes through
  bool thin;
  Vec3<Real> through;           ///< colour, times the share of the base
  Real glass;                   ///< share of the base that refracts; its interface is the exact one
  Vec3<Real> glass_reflection;  ///< factor on what that reflects
  Vec3<Real> glass_entry;       ///< and on what it lets in
  // Metal
  Real metal;           ///< share of the base
  Vec3<Real> metal_f0;  ///< or, of coated conductors, eta
  Vec3<Real> metal_k;
  bool metal_is_exact;                  ///< by eta and k, relative to the coat above it
  CoatedMetalPlace<Real> coated_metal;  ///< of that
  // Layers above
  Real coat, coat_alpha, coat_ior;
  const Real* coat_albedo;
  Vec3<Real> coat_normal;  ///< local
  Vec3<Real> sheen;
  Real sheen_roughness;

  ALHAZEN_HD LayeredBsdf() {}
};

/// What of the layers depends on the outgoing direction alone: `o.z` > 0.
template <class Real>
struct LayeredLobes {
  Real coat = 0, specular = 0, diffuse = 0, through = 0;  ///< probabilities
  Real diffuse_through = 0;                               ///< another
  Real below_coat = 1;                                    ///< share that the coat lets through
  Real coat_albedo = 0;
  Real interface;  ///< albedo of the dielectric
  Real ggx;        ///< albedo of GGX that reflects everything
  Real entering;   ///< share that gets to the diffuse base
  CoatedMetalFactors<Real> coated_metal{1, 1};
  Real sheen = 0;  ///< albedo, of colour 1
};

/// One alpha that stands for both in the tables: the roughness along the direction.
template <class Real>
ALHAZEN_HD Real alpha_towards(const Vec2<Real>& alpha, const Vec3<Real>& w) {
  if (alpha.x == alpha.y) return alpha.x;
  const Real sin2 = w.x * w.x + w.y * w.y;
  const Real mean = std::sqrt(alpha.x * alpha.y);
  if (sin2 < Real(1e-6)) return mean;
  return smaller(mean, std::sqrt((sqr(alpha.x * w.x) + sqr(alpha.y * w.y)) / sin2));
}

/// The largest of a table's albedos over what may stand for a pair of alphas: so that the base below gets no more than
/// is left.
template <class Real, class Albedo>
ALHAZEN_HD Real most_albedo(const Vec2<Real>& alpha, const Vec3<Real>& w, const Albedo& albedo) {
  const Real towards = albedo(alpha_towards(alpha, w));
  if (alpha.x == alpha.y) return towards;
  return larger(larger(towards, albedo(std::sqrt(alpha.x * alpha.y))), larger(albedo(alpha.x), albedo(alpha.y)));
}

/// Share of light from `w` that gets below the coat.
template <class Real>
ALHAZEN_HD Real coat_transmission(const LayeredBsdf<Real>& b, const Vec3<Real>& w) {
  // The least for a pair of alphas, as it is the most for what is reflected.
  return 1 - most_albedo(b.alpha, w, [&](Real alpha) { return 1 - lookup_albedo(b.transmission, w.z, alpha); });
}

template <class Real>
ALHAZEN_HD Real ggx_albedo(const LayeredBsdf<Real>& b, Real cosine, Real alpha) {
  return lookup_albedo(b.tables + AlbedoTables::base, cosine, alpha) +
         lookup_albedo(b.tables + AlbedoTables::edge, cosine, alpha);
}

template <class Real>
ALHAZEN_HD Real interface_albedo(const LayeredBsdf<Real>& b, Real cosine, Real alpha) {
  if (b.interface_albedo) return lookup_albedo(b.interface_albedo, cosine, alpha);
  return max_component(b.f0) * lookup_albedo(b.tables + AlbedoTables::base, cosine, alpha) +
         b.f90 * lookup_albedo(b.tables + AlbedoTables::edge, cosine, alpha);
}

template <class Real>
ALHAZEN_HD Real ggx_albedo(const LayeredBsdf<Real>& b, const Vec3<Real>& w) {
  return most_albedo(b.alpha, w, [&](Real alpha) { return ggx_albedo(b, w.z, alpha); });
}

template <class Real>
ALHAZEN_HD Real interface_albedo(const LayeredBsdf<Real>& b, const Vec3<Real>& w) {
  return most_albedo(b.alpha, w, [&](Real alpha) { return interface_albedo(b, w.z, alpha); });
}

template <class Real>
ALHAZEN_HD Real mean_interface_albedo(const LayeredBsdf<Real>& b, Real alpha) {
  return max_component(b.f0) * mean_albedo(b.tables + AlbedoTables::base, alpha) +
         b.f90 * mean_albedo(b.tables + AlbedoTables::edge, alpha);
}

/// (1 - cos)^5 of Schlick 1994.
template <class Real>
ALHAZEN_HD Real schlick_share(Real cosine) {
  const Real x = clamp(1 - cosine, Real(0), Real(1));
  return x * x * x * x * x;
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_interface(const LayeredBsdf<Real>& b, Real cosine) {
  Real cos_t;
  if (b.interface_albedo) return splat(fresnel_dielectric(cosine, b.ior, cos_t));
  return lerp(b.f0, splat(b.f90), schlick_share(cosine));
}

/// Cosine within the coat of a direction outside.
template <class Real>
ALHAZEN_HD Real cosine_within(Real cosine, Real ior) {
  return safe_sqrt(1 - (1 - cosine * cosine) / (ior * ior));
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_metal(const LayeredBsdf<Real>& b, Real cosine) {
  if (b.metal_is_exact) return fresnel_conductor(cosine_within(cosine, b.coat_ior), b.metal_f0, b.metal_k);
  return lerp(b.metal_f0, splat(Real(1)), schlick_share(cosine));
}

/// Colour of light that metal scatters more than once, over that of one that reflects everything.
template <class Real>
ALHAZEN_HD Vec3<Real> metal_multiple(const LayeredBsdf<Real>& b, Real mean_ggx) {
  if (b.metal_is_exact) return {};
  const auto channel = [&](Real f0) {
    const Real mean = f0 + (1 - f0) * (Real(1) / 21);
    return mean * mean * mean_ggx / (1 - mean * (1 - mean_ggx));
  };
  return Vec3<Real>{channel(b.metal_f0.x), channel(b.metal_f0.y), channel(b.metal_f0.z)} * b.metal;
}

template <class Real>
ALHAZEN_HD Real mean_ggx_albedo(const LayeredBsdf<Real>& b, Real alpha) {
  return mean_albedo(b.tables + AlbedoTables::base, alpha) + mean_albedo(b.tables + AlbedoTables::edge, alpha);
}

template <class Real>
ALHAZEN_HD Frame<Real> coat_frame(const LayeredBsdf<Real>& b, Real side) {
  return frame_about(Vec3<Real>{b.coat_normal.x * side, b.coat_normal.y * side, b.coat_normal.z});
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD LayeredLobes<Real> layered_lobes(const LayeredBsdf<Real>& b, const Vec3<Real>& o,
                                                         Real coat_cosine) {
  LayeredLobes<Real> lobes;
  if (b.coat > 0 && coat_cosine > 0) {
    lobes.coat_albedo = b.coat * lookup_albedo(b.coat_albedo, coat_cosine, b.coat_alpha);
    lobes.below_coat = 1 - lobes.coat_albedo;
  }
  lobes.interface = interface_albedo(b, o);
  lobes.ggx = ggx_albedo(b, o);
  lobes.entering = b.transmission ? coat_transmission(b, o) : 1 - lobes.interface;
  const Real sheen = max_component(b.sheen);
  if (sheen > 0)
    lobes.sheen = lookup_albedo(b.tables + AlbedoTables::sheen, o.z, b.sheen_roughness * b.sheen_roughness);
  const Real below = lobes.below_coat, base = below * larger(Real(0), 1 - sheen * lobes.sheen);
  lobes.coat = lobes.coat_albedo;
  if (b.metal_is_exact) lobes.coated_metal = coated_metal_factors(b.coated_metal, o.z);
  lobes.specular =
      base * (b.dielectric * lobes.interface +
              (b.metal > 0 ? b.metal * max_component(fresnel_of_metal(b, o.z)) * lobes.ggx * sqr(lobes.coated_metal.all)
                           : Real(0)));
  lobes.diffuse = below * sheen * lobes.sheen +
                  base * (max_component(b.diffuse) * lobes.entering +
                          (b.metal_is_exact ? Real(0) : b.metal * max_component(b.metal_f0) * (1 - lobes.ggx)));
  lobes.through = base * (b.thin ? max_component(b.through) * (1 - lobes.interface)
                                 : b.glass * larger(max_component(b.through), Real(0.2) * b.glass));
  lobes.diffuse_through = base * max_component(b.diffuse_through) * (1 - lobes.interface);
  const Real sum = lobes.coat + lobes.specular + lobes.diffuse + lobes.diffuse_through + lobes.through;
  const Real scale = sum > 0 ? 1 / sum : Real(0);
  lobes.coat *= scale, lobes.specular *= scale, lobes.diffuse *= scale, lobes.through *= scale;
  lobes.diffuse_through *= scale;
  return lobes;
}

/// GGX without its Fresnel term: f * cos of `i`, and the density of sampling it by visible normals.
template <class Real>
struct GgxReflection {
  Real value = 0, pdf = 0;
  Real cosine = 0;  ///< between the directions and the microfacet
};

template <class Real, class Alpha>
ALHAZEN_HD GgxReflection<Real> ggx_reflection(const Vec3<Real>& o, const Vec3<Real>& i, const Alpha& alpha) {
  GgxReflection<Real> r;
  if (!(o.z > 0 && i.z > 0)) return r;
  const Vec3<Real> m = normalize(o + i);
  const Real d = ggx_d(m, alpha);
  r.cosine = smaller(dot(o, m), Real(1));
  r.value = d * ggx_g2(o, i, alpha) / (4 * o.z);
  r.pdf = ggx_g1(o, alpha) * d / (4 * o.z);
  return r;
}

/// Share of light that gets into the diffuse base along that of `lobes` and out of it again along `i`.
template <class Real>
ALHAZEN_HD Real share_of_diffuse_base(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes,
                                      const Vec3<Real>& i) {
  if (b.transmission) return lobes.entering * coat_transmission(b, i) * b.exit;
  return lobes.entering * ((1 - interface_albedo(b, i)) /
                           larger(Real(1e-3), 1 - mean_interface_albedo(b, std::sqrt(b.alpha.x * b.alpha.y))));
}

/// Sheen and base where both directions are on the same side, what the coat keeps not yet left out.
template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_below_coat(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes,
                                               const Vec3<Real>& o, const Vec3<Real>& i) {
  BsdfValue<Real> v;
  const GgxReflection<Real> ggx = ggx_reflection(o, i, b.alpha);
  v.value = fresnel_of_interface(b, ggx.cosine) * (b.dielectric * ggx.value);
  v.pdf = lobes.specular * ggx.pdf;
  const Real lambert = i.z * inv_pi<Real>;
  v.pdf += lobes.diffuse * lambert;
  const Real mean_alpha = std::sqrt(b.alpha.x * b.alpha.y);
  if (max_component(b.diffuse) > 0) {
    const Real shared = share_of_diffuse_base(b, lobes, i);
    v.value += b.diffuse * (shared * lambert);
  }
  if (b.metal > 0) {
    const Vec3<Real> f = fresnel_of_metal(b, ggx.cosine);
    v.value +=
        (b.metal_is_exact ? coated_metal_colour(lobes.coated_metal, coated_metal_factors(b.coated_metal, i.z), f) : f) *
        (b.metal * ggx.value);
    const Real mean = mean_ggx_albedo(b, mean_alpha);
    v.value +=
        metal_multiple(b, mean) * (lambert * (1 - lobes.ggx) * (1 - ggx_albedo(b, i)) / larger(Real(1e-3), 1 - mean));
  }
  const Real sheen = max_component(b.sheen);
  if (sheen > 0) {
    const Real albedo_i = lookup_albedo(b.tables + AlbedoTables::sheen, i.z, b.sheen_roughness * b.sheen_roughness);
    const Real most = sheen * larger(lobes.sheen, albedo_i);
    v.value *= larger(Real(0), 1 - most);
    v.value += b.sheen * (evaluate_sheen(b.sheen_roughness, o, i) / larger(Real(1), most));
  }
  return v;
}

/// The share that the sheen leaves of light that goes through.
template <class Real>
ALHAZEN_HD Real below_sheen(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes) {
  return larger(Real(0), 1 - max_component(b.sheen) * lobes.sheen);
}

/// From within a body that refracts nothing but its interface is met.
template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_from_within(const LayeredBsdf<Real>& b, const Vec3<Real>& wo,
                                                const Vec3<Real>& wi) {
  BsdfValue<Real> v = evaluate_dielectric(DielectricBsdf<Real, Vec2<Real>>{b.ior, b.alpha}, wo, wi);
  if (wi.z > 0) v.value *= b.through;
  return v;
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate_layered(const LayeredBsdf<Real>& b, const Vec3<Real>& wo,
                                                         const Vec3<Real>& wi) {
  if (wo.z == 0 || wi.z == 0) return {};
  if (wo.z < 0 && b.glass > 0) return evaluate_from_within(b, wo, wi);
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Frame<Real> coat = coat_frame(b, side);
  const Vec3<Real> coat_o = coat.to_local(o);
  const LayeredLobes<Real> lobes = layered_lobes(b, o, coat_o.z);
  BsdfValue<Real> v;
  if (i.z > 0) v = evaluate_below_coat(b, lobes, o, i);
  if (b.glass > 0) {
    const BsdfValue<Real> g = evaluate_dielectric(DielectricBsdf<Real, Vec2<Real>>{b.ior, b.alpha}, o, i);
    v.value += g.value * (i.z > 0 ? b.glass_reflection * b.glass : b.through * b.glass_entry) * below_sheen(b, lobes);
    v.pdf += lobes.through * g.pdf;
  } else if (i.z < 0 && lobes.through > 0) {
    const GgxReflection<Real> ggx = ggx_reflection(o, Vec3<Real>{i.x, i.y, -i.z}, b.alpha);
    v.value += b.through * ((1 - lobes.interface) * ggx.value / larger(lobes.ggx, Real(1e-3)) * below_sheen(b, lobes));
    v.pdf += lobes.through * ggx.pdf;
  }
  if (i.z < 0 && lobes.diffuse_through > 0) {
    const Vec3<Real> mirrored{i.x, i.y, -i.z};
    const Real lambert = mirrored.z * inv_pi<Real>;
    v.value += b.diffuse_through * (lambert * share_of_diffuse_base(b, lobes, mirrored) * below_sheen(b, lobes));
    v.pdf += lobes.diffuse_through * lambert;
  }
  if (b.coat > 0) {
    if (!b.metal_is_exact) v.value *= lobes.below_coat;
    const Vec3<Real> coat_i = coat.to_local(i);
    if (i.z > 0 && coat_o.z > 0 && coat_i.z > 0) {
      const GgxReflection<Real> ggx = ggx_reflection(coat_o, coat_i, b.coat_alpha);
      Real cos_t;
      v.value += splat(b.coat * fresnel_dielectric(ggx.cosine, b.coat_ior, cos_t) * ggx.value);
      v.pdf += lobes.coat * ggx.pdf;
    }
  }
  return v;
}

/// The mirror image of `o` at a microfacet that it sees.
template <class Real, class Alpha>
ALHAZEN_HD Vec3<Real> sample_ggx_reflection(const Vec3<Real>& o, const Alpha& alpha, const Vec2<Real>& u) {
  const Vec3<Real> m = sample_visible_normal(o, alpha, u);
  return m * (2 * dot(o, m)) - o;
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> sample_layered(const LayeredBsdf<Real>& b, const Vec3<Real>& wo, Real u_lobe,
                                           const Vec2<Real>& u) {
  BsdfSample<Real> s;
  if (wo.z == 0) return s;
  const DielectricBsdf<Real, Vec2<Real>> glass{b.ior, b.alpha};
  Vec3<Real> way{};
  if (wo.z < 0 && b.glass > 0) {
    way = sample_dielectric(glass, wo, u_lobe, u).direction;
  } else {
    const Real side = wo.z < 0 ? Real(-1) : Real(1);
    const Vec3<Real> o = wo * side;
    const Frame<Real> coat = coat_frame(b, side);
    const Vec3<Real> coat_o = coat.to_local(o);
    const LayeredLobes<Real> lobes = layered_lobes(b, o, coat_o.z);
    if (u_lobe < lobes.coat) {
      way = coat.to_world(sample_ggx_reflection(coat_o, b.coat_alpha, u));
      if (way.z < 0) return s;
    } else if (u_lobe < lobes.coat + lobes.specular) {
      way = sample_ggx_reflection(o, b.alpha, u);
      if (way.z < 0) return s;
    } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse) {
      way = sample_cosine_hemisphere(u);
    } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse + lobes.diffuse_through) {
      way = sample_cosine_hemisphere(u);
      way.z = -way.z;
    } else if (b.glass > 0 && lobes.through > 0) {
      const Real rest = (u_lobe - (1 - lobes.through)) / lobes.through;
      way = sample_dielectric(glass, o, clamp(rest, Real(0), one_minus_epsilon<Real>), u).direction;
    } else {
      way = sample_ggx_reflection(o, b.alpha, u);
      if (way.z < 0) return s;
      way.z = -way.z;
    }
    way *= side;
  }
  if (is_zero(way)) return s;
  const BsdfValue<Real> v = evaluate_layered(b, wo, way);
  if (!(v.pdf > 0)) return s;
  s.direction = way;
  s.pdf = v.pdf;
  s.weight = v.value / v.pdf;
  if (b.glass > 0 && way.z * wo.z < 0) s.eta = wo.z < 0 ? 1 / b.ior : b.ior;
  return s;
}

}  // namespace ALHAZEN_CORE
