#include "api/material_slots.h"

#include <limits>
#include <optional>
#include <utility>

#include "api/metals.h"
#include "api/slots.h"

namespace alhazen::impl {

namespace {

constexpr ValueRange not_negative = ValueRange::not_negative, unit = ValueRange::unit;

const auto as_it_is = [](const auto& value) { return value; };

template <class Io, class Inside>
void finite(Io& io, const char* name, double& outside, Inside& inside) {
  io.value(outside, inside, as_it_is, [&](double value) { return finite_number(name, value); });
}

template <class Io, class Inside>
void positive(Io& io, const char* name, double& outside, Inside& inside) {
  io.value(outside, inside, as_it_is, [&](double value) { return positive_number(name, value); });
}

template <class Io, class Outside, class Inside>
void plain(Io& io, Outside& outside, Inside& inside) {
  io.value(outside, inside, as_it_is, as_it_is);
}

void roughness(const SlotReader& io, alhazen::Roughness& outside, const Material& material) {
  const uint32_t u = material.roughness_u, v = material.roughness_v;
  io.number({}, outside.u, u != no_index ? u : v, 0, not_negative);
  io.number({}, outside.v, v != no_index ? v : u, 0, not_negative);
  outside.remap = material.remap_roughness;
}

/// One texture for both directions is what makes a surface isotropic. No number is equal to NaN, the value of an absent
/// input here.
void roughness(SlotWriter& io, const alhazen::Roughness& given, Material& material) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  alhazen::Roughness present;
  roughness(SlotReader(io.state()), present, material);
  if (io.writes()) material.remap_roughness = given.remap;
  if (present.u == given.u && present.v == given.v) return;
  if (!io.writes()) {
    uint32_t none = no_index;  // nothing is written to it
    io.number("roughness", given.u, none, nan, not_negative);
    io.number("roughness", given.v, none, nan, not_negative);
    return;
  }
  io.release(material.roughness_u);
  io.release(material.roughness_v);
  if (given.u == 0.0 && given.v == 0.0) return;
  io.number("roughness", given.u, material.roughness_u, nan, not_negative);
  if (given.u == given.v)
    material.roughness_v = material.roughness_u;
  else
    io.number("roughness", given.v, material.roughness_v, nan, not_negative);
}

template <class Io, class Kind, class Inside>
void metal(Io& io, Kind& metal, Inside& material) {
  io.optional_colour("reflectance", metal.reflectance, material.reflectance, unit);
  io.optional_colour("eta", metal.eta, material.eta, not_negative);
  io.optional_colour("k", metal.k, material.k, not_negative);
  roughness(io, metal.roughness, material);
}

template <class Io, class Kind, class Inside>
void coat(Io& io, Kind& coated, Inside& material) {
  const auto given = [](const auto& m) { return m.thickness_is_given ? std::optional(m.thickness) : std::nullopt; };
  struct Thickness {
    double thickness;
    bool thickness_is_given;
  };
  Thickness inside{material.thickness, material.thickness_is_given};
  io.value(coated.thickness, inside, given, [](const std::optional<double>& value) {
    return Thickness{value ? non_negative_number("thickness", *value) : 0.01, value.has_value()};
  });
  if constexpr (!std::is_const_v<Inside>) {
    material.thickness = inside.thickness;
    material.thickness_is_given = inside.thickness_is_given;
  }
  io.value(coated.bounces, material.coat_bounces, as_it_is,
           [](int value) { return static_cast<int>(integer_between("bounces", value, 0, 1000)); });
}

template <class Io, class Inside>
void describe(Io& io, alhazen::Diffuse& diffuse, Inside& material) {
  io.colour("reflectance", diffuse.reflectance, material.reflectance, 0.5, unit);
  io.number("roughness", diffuse.roughness, material.roughness_u, 0, unit);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::Conductor& conductor, Inside& material) {
  metal(io, conductor, material);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::Dielectric& dielectric, Inside& material) {
  positive(io, "ior", dielectric.ior, material.ior);
  roughness(io, dielectric.roughness, material);
  io.value(
      dielectric.absorption, material.absorption, [](const Vec3d& c) { return public_colour(c); },
      [](const alhazen::Colour& c) { return light_colour("absorption", c); });
}

template <class Io, class Inside>
void describe(Io& io, alhazen::ThinDielectric& sheet, Inside& material) {
  positive(io, "ior", sheet.ior, material.ior);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::CoatedDiffuse& coated, Inside& material) {
  io.colour("reflectance", coated.reflectance, material.reflectance, 0.5, unit);
  positive(io, "ior", coated.ior, material.ior);
  roughness(io, coated.roughness, material);
  coat(io, coated, material);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::CoatedConductor& coated, Inside& material) {
  metal(io, coated, material);
  positive(io, "coat_ior", coated.coat_ior, material.coat_ior);
  io.number("coat_roughness", coated.coat_roughness, material.coat_roughness, 0, not_negative);
  coat(io, coated, material);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::DiffuseTransmission& sheet, Inside& material) {
  io.colour("reflectance", sheet.reflectance, material.reflectance, 0.25, unit);
  io.colour("transmittance", sheet.transmittance, material.transmittance, 0.25, unit);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::Mix& mix, Inside& material) {
  for (size_t i = 0; i < 2; ++i) io.material("materials", mix.materials[i], material.mixed[i]);
  io.number("amount", mix.amount, material.amount, 0.5, unit);
}

template <class Io, class Inside>
void describe(Io& io, alhazen::Principled& outside, Inside& material) {
  auto& inside = material.principled;
  io.colour("base_colour", outside.base_colour, inside.base_colour, 1.0, unit);
  io.number("metallic", outside.metallic, inside.metallic, 0, unit);
  io.number("roughness", outside.roughness, inside.roughness, 1, unit);
  io.number("specular", outside.specular, inside.specular, 1, not_negative);
  io.colour("specular_colour", outside.specular_colour, inside.specular_colour, 1.0, not_negative);
  positive(io, "ior", outside.ior, inside.ior);
  io.number("transmission", outside.transmission, inside.transmission, 0, unit);
  plain(io, outside.thin, inside.thin);
  io.value(
      outside.attenuation_colour, inside.attenuation_colour, [](const Vec3d& c) { return public_colour(c); },
      [](const alhazen::Colour& c) {
        for (const double v : {c.r, c.g, c.b}) number_between("attenuation_colour", v, 0, 1);
        return vector_of(c);
      });
  io.value(outside.attenuation_distance, inside.attenuation_distance, as_it_is, [](double value) {
    if (!(value > 0)) refuse_argument("attenuation_distance", "must be over 0, or infinite");
    return value;
  });
  io.value(outside.dispersion, inside.dispersion, as_it_is,
           [](double value) { return non_negative_number("dispersion", value); });
  io.number("clearcoat", outside.clearcoat, inside.clearcoat, 0, unit);
  io.number("clearcoat_roughness", outside.clearcoat_roughness, inside.clearcoat_roughness, 0, unit);
  io.texture("clearcoat_normal_map", outside.clearcoat_normal_map, inside.clearcoat_normal_map);
  finite(io, "clearcoat_normal_scale", outside.clearcoat_normal_scale, inside.clearcoat_normal_scale);
  io.colour("sheen_colour", outside.sheen_colour, inside.sheen_colour, 0.0, unit);
  io.number("sheen_roughness", outside.sheen_roughness, inside.sheen_roughness, 0, unit);
  io.number("iridescence", outside.iridescence, inside.iridescence, 0, unit);
  io.number("iridescence_thickness", outside.iridescence_thickness, inside.iridescence_thickness, 400, not_negative);
  positive(io, "iridescence_ior", outside.iridescence_ior, inside.iridescence_ior);
  io.number("anisotropy", outside.anisotropy, inside.anisotropy, 0, unit);
  finite(io, "anisotropy_rotation", outside.anisotropy_rotation, inside.anisotropy_rotation);
  io.texture("anisotropy_direction", outside.anisotropy_direction, inside.anisotropy_direction);
  io.number("diffuse_transmission", outside.diffuse_transmission, inside.diffuse_transmission, 0, unit);
  io.colour("diffuse_transmission_colour", outside.diffuse_transmission_colour, inside.diffuse_transmission_colour, 1.0,
            unit);
}

/// What all kinds have.
template <class Io, class Inside>
void describe_common(Io& io, alhazen::Material& outside, Inside& inside) {
  plain(io, outside.name, inside.name);
  io.number("alpha", outside.alpha, inside.alpha, 1, unit);
  io.texture("normal_map", outside.normal_map, inside.normal_map);
  finite(io, "normal_scale", outside.normal_scale, inside.normal_scale);
  io.texture("displacement", outside.displacement, inside.displacement);
  plain(io, outside.double_sided, inside.double_sided);
}

alhazen::Bsdf bsdf_of(MaterialKind kind) {
  switch (kind) {
    case MaterialKind::diffuse:
    case MaterialKind::oren_nayar:
      return alhazen::Diffuse{};
    case MaterialKind::conductor:
    case MaterialKind::anisotropic_conductor:
      return alhazen::Conductor{};
    case MaterialKind::dielectric:
    case MaterialKind::anisotropic_dielectric:
      return alhazen::Dielectric{};
    case MaterialKind::thin_dielectric:
      return alhazen::ThinDielectric{};
    case MaterialKind::coated_diffuse:
      return alhazen::CoatedDiffuse{};
    case MaterialKind::coated_conductor:
      return alhazen::CoatedConductor{};
    case MaterialKind::diffuse_transmission:
      return alhazen::DiffuseTransmission{};
    case MaterialKind::mix:
      return alhazen::Mix{};
    case MaterialKind::principled:
      break;
  }
  return alhazen::Principled{};
}

MaterialKind kind_of(const alhazen::Bsdf& bsdf, const Material& material) {
  constexpr MaterialKind kinds[] = {MaterialKind::diffuse,
                                    MaterialKind::conductor,
                                    MaterialKind::dielectric,
                                    MaterialKind::thin_dielectric,
                                    MaterialKind::coated_diffuse,
                                    MaterialKind::coated_conductor,
                                    MaterialKind::diffuse_transmission,
                                    MaterialKind::mix,
                                    MaterialKind::principled};
  static_assert(std::size(kinds) == std::variant_size_v<alhazen::Bsdf>);
  const MaterialKind kind = kinds[bsdf.index()];
  return kind == MaterialKind::diffuse && material.roughness_u != no_index ? MaterialKind::oren_nayar : kind;
}

/// Gives back the constants of the inputs that are not of all kinds.
void release_own_inputs(SlotWriter& io, Material& material) {
  Principled& p = material.principled;
  for (uint32_t* slot : {&material.reflectance,
                         &material.eta,
                         &material.k,
                         &material.roughness_u,
                         &material.roughness_v,
                         &material.transmittance,
                         &material.amount,
                         &material.coat_roughness,
                         &p.base_colour,
                         &p.metallic,
                         &p.roughness,
                         &p.specular,
                         &p.specular_colour,
                         &p.transmission,
                         &p.clearcoat,
                         &p.clearcoat_roughness,
                         &p.clearcoat_normal_map,
                         &p.sheen_colour,
                         &p.sheen_roughness,
                         &p.iridescence,
                         &p.iridescence_thickness,
                         &p.anisotropy,
                         &p.anisotropy_direction,
                         &p.diffuse_transmission,
                         &p.diffuse_transmission_colour})
    io.release(*slot);
}

/// The same in what all kinds have.
Material with_common_of(const Material& material) {
  Material fresh;
  fresh.name = material.name;
  fresh.alpha = material.alpha;
  fresh.normal_map = material.normal_map;
  fresh.normal_scale = material.normal_scale;
  fresh.double_sided = material.double_sided;
  fresh.displacement = material.displacement;
  return fresh;
}

template <class Metal>
void complete_metal(Metal& metal) {
  if (metal.reflectance && (metal.eta || metal.k))
    refuse_argument("reflectance", "and 'eta' and 'k' are two ways to say the same: give one of them");
  if (metal.eta.has_value() != metal.k.has_value())
    refuse_argument(metal.eta ? "k" : "eta", "is missing: a conductor takes both, or a reflectance");
  if (metal.reflectance || metal.eta) return;
  const ConductorRgb copper = metal_rgb(alhazen::Metal::copper);
  metal.eta = public_colour(copper.eta);
  metal.k = public_colour(copper.k);
}

}  // namespace

alhazen::Material public_material(const SceneState& state, const Material& material) {
  const SlotReader io(state);
  alhazen::Material result;
  result.bsdf = bsdf_of(material.kind);
  std::visit([&](auto& kind) { describe(io, kind, material); }, result.bsdf);
  describe_common(io, result, material);
  return result;
}

void write_material(SceneState& state, alhazen::Material given, Material& material) {
  if (auto* conductor = std::get_if<alhazen::Conductor>(&given.bsdf)) complete_metal(*conductor);
  if (auto* coated = std::get_if<alhazen::CoatedConductor>(&given.bsdf)) complete_metal(*coated);
  const bool is_of_kind = bsdf_of(material.kind).index() == given.bsdf.index();
  Material trial = is_of_kind ? material : with_common_of(material);
  const auto describe_all = [&](SlotWriter& io, Material& target) {
    std::visit([&](auto& kind) { describe(io, kind, target); }, given.bsdf);
    describe_common(io, given, target);
  };
  SlotWriter check(state, false);
  describe_all(check, trial);
  SlotWriter write(state, true);
  if (!is_of_kind) {
    release_own_inputs(write, material);
    material = std::move(trial);
  }
  describe_all(write, material);
  material.kind = kind_of(given.bsdf, material);
}

}  // namespace alhazen::impl
