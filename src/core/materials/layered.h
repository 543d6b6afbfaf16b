#pragma once

// Layers over each other: a clearcoat over sheen over a base that mixes metal and dielectric, the dielectric over
// diffuse or transmitted light. What a layer sends back by its albedo (core/materials/lobes/albedo_grid.h) is kept from
// what lies below, so that all layers together send on as much light as arrives where none of them absorbs. The layers
// are those of appendix B of glTF 2.0 and of its KHR_materials extensions; pbrt's coats are the same with the
// dielectric's exact Fresnel term. Light that metal scatters several times is given back as Kulla and Conty 2017 do
// ("Revisiting Physically Based Shading at Imageworks"), that of glass as core/materials/lobes/rough_glass.h does. Coat
// and sheen take their light by the direction of the camera alone, so these are not reciprocal. There are no single
// directions: what is smooth has an alpha of `least_layered_alpha`.

#include "core/materials/layered_bsdf.h"
#include "core/materials/lobes/sheen.h"

namespace ALHAZEN_CORE {

/// What of the layers depends on the outgoing direction alone: `o.z` > 0.
template <class Real>
struct LayeredLobes {
  Real coat = 0, specular = 0, diffuse = 0, through = 0;  ///< probabilities
  Real diffuse_through = 0;                               ///< another
  Real below_coat = 1;                                    ///< share that the coat lets through
  Real coat_albedo = 0;
  Vec3<Real> interface;  ///< what the dielectric keeps from below it
  GgxAlbedo<Real> ggx{0, 0};
  Vec3<Real> entering;  ///< share that gets to the diffuse base
  CoatedMetalFactors<Real> coated_metal{1, 1};
  Real metal_scale = 1;  ///< factors on single scattering, mostly 1
  Vec3<Real> interface_scale{1, 1, 1};
  Real sheen = 0;  ///< albedo, of colour 1
  Real below_sheen = 1;
};

/// A body's inside: only its base is met there, not what lies over it.
template <class Real>
ALHAZEN_HD bool is_within(const LayeredBsdf<Real>& b, const Vec3<Real>& wo) {
  return wo.z < 0 && b.glass > 0;
}

/// Factors of metal below a coat. Its table is made for one alpha; where there are two, the lobe has another albedo.
template <class Real>
ALHAZEN_HD CoatedMetalFactors<Real> coated_metal_lobe(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes,
                                                      const Vec3<Real>& o) {
  CoatedMetalFactors<Real> factors = coated_metal_factors(b.coated_metal, o.z);
  if (!b.is_anisotropic) return factors;
  const Real scale = ggx_albedo(b.through_grid, o).all() / larger(Real(0.01), lobes.ggx.all());
  return {factors.once * scale, factors.all * scale};
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD LayeredLobes<Real> layered_lobes(const LayeredBsdf<Real>& b, const Vec3<Real>& o,
                                                         Real coat_cosine, bool within) {
  LayeredLobes<Real> lobes;
  if (!within && b.coat > 0 && coat_cosine > 0) {
    lobes.coat_albedo = b.coat * lookup_albedo(b.coat_albedo, coat_cosine, b.coat_alpha, b.coat_ior);
    lobes.below_coat = 1 - lobes.coat_albedo;
  }
  if (b.interface_albedo) {
    lobes.interface = interface_albedo(b, o);
  } else {
    lobes.ggx = ggx_albedo(b.grid, o);
    lobes.interface = kept_by_interface(b, lobes.ggx);
  }
  lobes.entering =
      b.transmission ? splat(coat_transmission(b, o)) : max(splat(Real(1)) - lobes.interface, Vec3<Real>{});
  if (!b.interface_albedo) {
    const GgxAlbedo<Real> mean = mean_ggx_albedo(b);
    lobes.metal_scale = single_scattering_scale(lobes.ggx.all(), lobes.ggx.missing(), mean.missing());
    const Vec3<Real> kept = kept_by_interface(b, mean);
    if (1 - max_component(kept) < least_mean_missing<Real>)
      for (int c = 0; c < 3; ++c)
        lobes.interface_scale[c] = single_scattering_scale(lobes.interface[c], lobes.entering[c], 1 - kept[c]);
  }
  const Real sheen = within ? Real(0) : max_component(b.sheen);
  if (sheen > 0) {
    lobes.sheen = grid_albedo(b.sheen_grid, 0, grid_direction(b.sheen_grid, o, Real(1)));
    lobes.below_sheen = larger(Real(0), 1 - sheen * lobes.sheen);
  }
  const Real below = lobes.below_coat, base = below * lobes.below_sheen;
  lobes.coat = lobes.coat_albedo;
  if (b.metal_is_exact) lobes.coated_metal = coated_metal_lobe(b, lobes, o);
  lobes.specular =
      base *
      (b.dielectric * max_component(lobes.interface) +
       (b.metal > 0 ? b.metal * max_component(fresnel_of_metal(b, o.z)) * lobes.ggx.all() * sqr(lobes.coated_metal.all)
                    : Real(0)));
  lobes.diffuse = below * sheen * lobes.sheen +
                  base * (max_component(b.diffuse * lobes.entering) +
                          (b.metal_is_exact ? Real(0) : b.metal * max_component(b.metal_f0) * lobes.ggx.missing()));
  if (b.glass > 0)
    lobes.through = base * b.glass * larger(max_component(b.refraction.through), Real(0.2));
  else
    lobes.through = base * max_component(b.through * (splat(Real(1)) - lobes.interface));
  lobes.diffuse_through = base * max_component(b.diffuse_through * (splat(Real(1)) - lobes.interface));
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
ALHAZEN_HD Vec3<Real> share_of_diffuse_base(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes,
                                            const Vec3<Real>& i) {
  if (b.transmission) return lobes.entering * coat_transmission(b, i) * b.exit;
  const Vec3<Real> leaving = max(splat(Real(1)) - interface_albedo(b, i), Vec3<Real>{});
  const Vec3<Real> mean = splat(Real(1)) - kept_by_interface(b, mean_ggx_albedo(b));
  return lobes.entering * (leaving / max(mean, splat(least_mean_missing<Real>)));
}

/// Where light leaves a coat of an index below 1, which refracts it into a cone, most samples of the diffuse lobe go
/// there.
template <class Real>
inline constexpr Real cone_rate = Real(0.9);

template <class Real>
ALHAZEN_HD Vec3<Real> sample_diffuse_lobe(const LayeredBsdf<Real>& b, const Vec2<Real>& u) {
  if (b.diffuse_cone >= 1) return sample_cosine_hemisphere(u);
  const bool in_cone = u.x < cone_rate<Real>;
  const Real x = in_cone ? u.x / cone_rate<Real> : (u.x - cone_rate<Real>) / (1 - cone_rate<Real>);
  const Vec2<Real> disk = sample_disk(Vec2<Real>{smaller(x, one_minus_epsilon<Real>), u.y});
  const Real scale = in_cone ? b.diffuse_cone : Real(1);
  const Real dx = disk.x * scale, dy = disk.y * scale;
  return {dx, dy, safe_sqrt(1 - dx * dx - dy * dy)};
}

/// Density of that over the one of cosines.
template <class Real>
ALHAZEN_HD Real diffuse_lobe_density(const LayeredBsdf<Real>& b, const Vec3<Real>& i) {
  if (b.diffuse_cone >= 1) return 1;
  const Real cone2 = sqr(b.diffuse_cone), sin2 = i.x * i.x + i.y * i.y;
  return 1 - cone_rate<Real> + (sin2 < cone2 ? cone_rate<Real> / cone2 : Real(0));
}

/// Sheen and base where both directions are on the same side, what the coat keeps not yet left out.
template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_below_coat(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes,
                                               const Vec3<Real>& o, const Vec3<Real>& i) {
  BsdfValue<Real> v;
  const GgxReflection<Real> ggx = ggx_reflection(o, i, b.alpha);
  v.value = fresnel_of_interface(b, ggx.cosine) * (b.dielectric * ggx.value);
  if (!b.interface_albedo) v.value *= lobes.interface_scale;
  v.pdf = lobes.specular * ggx.pdf;
  const Real lambert = i.z * inv_pi<Real>;
  v.pdf += lobes.diffuse * lambert * diffuse_lobe_density(b, i);
  if (max_component(b.diffuse) > 0) v.value += b.diffuse * (share_of_diffuse_base(b, lobes, i) * lambert);
  if (b.metal > 0) {
    const Vec3<Real> f = fresnel_of_metal(b, ggx.cosine);
    if (b.metal_is_exact) {
      v.value +=
          coated_metal_colour(lobes.coated_metal, coated_metal_factors(b.coated_metal, i.z), f) * (b.metal * ggx.value);
    } else {
      const GgxAlbedo<Real> mean = mean_ggx_albedo(b);
      v.value += f * (b.metal * ggx.value * lobes.metal_scale);
      v.value += metal_multiple(b, mean.all()) * (lambert * lobes.ggx.missing() * ggx_albedo(b.grid, i).missing() /
                                                  larger(least_mean_missing<Real>, mean.missing()));
    }
  }
  const Real sheen = max_component(b.sheen);
  if (lobes.sheen > 0) {
    v.value *= lobes.below_sheen;
    v.value += b.sheen * (evaluate_sheen(b.sheen_roughness, o, i) / larger(Real(1), sheen * lobes.sheen));
  }
  return v;
}

/// Light that the base lets through to the other side; `o.z` > 0 > `i.z`.
template <class Real>
ALHAZEN_HD void add_light_through(const LayeredBsdf<Real>& b, const LayeredLobes<Real>& lobes, const Vec3<Real>& o,
                                  const Vec3<Real>& i, bool leaves_body, BsdfValue<Real>& v) {
  const Vec3<Real> mirrored{i.x, i.y, -i.z};
  if (b.glass == 0 && lobes.through > 0) {
    const GgxReflection<Real> ggx = ggx_reflection(o, mirrored, b.through_alpha);
    v.value += b.through * ((splat(Real(1)) - lobes.interface) * ggx.value /
                            larger(ggx_albedo(b.through_grid, o).all(), Real(1e-3)) * lobes.below_sheen);
    v.pdf += lobes.through * ggx.pdf;
  }
  if (lobes.diffuse_through > 0) {
    const Real lambert = mirrored.z * inv_pi<Real>;
    // As radiance does that is refracted.
    const Real crossing = leaves_body ? sqr(b.body_ior) : 1 / sqr(b.body_ior);
    v.value +=
        b.diffuse_through * (lambert * share_of_diffuse_base(b, lobes, mirrored) * (lobes.below_sheen * crossing));
    v.pdf += lobes.diffuse_through * lambert;
  }
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate_layered(const LayeredBsdf<Real>& b, const Vec3<Real>& wo,
                                                         const Vec3<Real>& wi) {
  if (wo.z == 0 || wi.z == 0) return {};
  const bool within = is_within(b, wo);
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Frame<Real> coat = coat_frame(b, side);
  const Vec3<Real> coat_o = coat.to_local(o);
  const LayeredLobes<Real> lobes = layered_lobes(b, o, coat_o.z, within);
  BsdfValue<Real> v;
  if (i.z > 0) v = evaluate_below_coat(b, lobes, o, i);
  if (b.glass > 0) {
    const BsdfValue<Real> g = evaluate_glass(b.refraction, wo, wi);
    v.value += g.value * (b.glass * lobes.below_sheen);
    v.pdf += lobes.through * g.pdf;
  }
  if (i.z < 0) add_light_through(b, lobes, o, i, wo.z < 0, v);
  if (b.coat > 0 && !within) {
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

/// A direction of one of the lobes; zero: none.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_lobe(const LayeredBsdf<Real>& b, const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) {
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  const Frame<Real> coat = coat_frame(b, side);
  const Vec3<Real> coat_o = coat.to_local(o);
  const LayeredLobes<Real> lobes = layered_lobes(b, o, coat_o.z, is_within(b, wo));
  Vec3<Real> way{};
  if (u_lobe < lobes.coat) {
    way = coat.to_world(sample_ggx_reflection(coat_o, b.coat_alpha, u));
    if (way.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular) {
    way = sample_ggx_reflection(o, b.alpha, u);
    if (way.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse) {
    way = sample_diffuse_lobe(b, u);
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse + lobes.diffuse_through) {
    way = sample_cosine_hemisphere(u);
    way.z = -way.z;
  } else if (b.glass > 0 && lobes.through > 0) {
    const Real rest = (u_lobe - (1 - lobes.through)) / lobes.through;
    return sample_glass(b.refraction, wo, clamp(rest, Real(0), one_minus_epsilon<Real>), u);
  } else {
    way = sample_ggx_reflection(o, b.through_alpha, u);
    if (way.z < 0) return {};
    way.z = -way.z;
  }
  return way * side;
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> sample_layered(const LayeredBsdf<Real>& b, const Vec3<Real>& wo, Real u_lobe,
                                           const Vec2<Real>& u) {
  BsdfSample<Real> s;
  if (wo.z == 0) return s;
  const Vec3<Real> way = sample_lobe(b, wo, u_lobe, u);
  if (is_zero(way)) return s;
  const BsdfValue<Real> v = evaluate_layered(b, wo, way);
  if (!(v.pdf > 0)) return s;
  s.direction = way;
  s.pdf = v.pdf;
  s.weight = v.value / v.pdf;
  if (way.z * wo.z < 0) s.eta = wo.z < 0 ? 1 / b.body_ior : b.body_ior;
  return s;
}

}  // namespace ALHAZEN_CORE
