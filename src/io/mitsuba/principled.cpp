#include "io/mitsuba/principled.h"

#include <cmath>
#include <optional>

#include "io/mitsuba/textures.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

std::optional<double> constant_number(const Build& build, uint32_t texture) {
  const std::optional<Vec3d> value = constant_value(build, texture);
  if (!value) return {};
  return value->x;
}

/// A parameter from 0 to `max`. Throws if it is a constant that is not; textures are not looked through.
uint32_t limited_scalar(Build& build, ObjectReader& reader, const char* name, double fallback, int max = 1) {
  const uint32_t texture = scalar_texture(build, reader, name, fallback);
  const std::optional<double> constant = constant_number(build, texture);
  constexpr double rounding = 1e-9;  // of the luminance of a colour
  if (constant && !(*constant >= 0 && *constant <= max + rounding))
    fail(reader.place_of(name), quoted(std::string_view(name)) + " must be from 0 to " + std::to_string(max));
  return texture;
}

/// The texture of a parameter that is 0 without it; no_index if it is 0 everywhere.
uint32_t optional_scalar(Build& build, ObjectReader& reader, const char* name, int max = 1) {
  const uint32_t texture = limited_scalar(build, reader, name, 0, max);
  return constant_number(build, texture) == 0.0 ? no_index : texture;
}

/// Here the lobe has alpha across the tangent, and lerp(alpha, 1, a^2) along it; there alpha / aspect along and alpha *
/// aspect across, with aspect^2 = 1 - 0.9 a.
void read_roughness(Build& build, ObjectReader& reader, Principled& principled) {
  principled.roughness = limited_scalar(build, reader, "roughness", 0.5);
  const uint32_t anisotropic = optional_scalar(build, reader, "anisotropic");
  if (anisotropic == no_index) return;
  const std::optional<double> roughness = constant_number(build, principled.roughness);
  const std::optional<double> amount = constant_number(build, anisotropic);
  if (!roughness || !amount) {
    build.warn(reader.place_of("anisotropic"),
               "where 'anisotropic' or 'roughness' is a texture, highlights are wider "
               "along the tangent than in Mitsuba");
    principled.anisotropy = anisotropic;
    return;
  }
  const double aspect = std::sqrt(1 - 0.9 * *amount), alpha = *roughness * *roughness;
  const double along = std::fmin(alpha / aspect, 1), across = alpha * aspect;
  principled.roughness = build.constant_texture(splat(std::sqrt(across)));
  principled.anisotropy = build.constant_texture(splat(std::sqrt((along - across) / (1 - across))));
}

/// (1, 1, 1) at an amount of 0, the base colour scaled to luminance 1 at 1.
Vec3d tint(Build& build, ObjectReader& reader, const char* name, uint32_t base) {
  const std::optional<double> amount = constant_number(build, limited_scalar(build, reader, name, 0));
  const std::optional<Vec3d> colour = constant_value(build, base);
  if (amount == 0.0) return {1, 1, 1};
  if (!amount || !colour) {
    build.warn(reader.place_of(name), std::string("'") + name + "' with textures is not supported; 0 is used");
    return {1, 1, 1};
  }
  const double brightness = luminance(*colour);
  const Vec3d full = brightness > 0 ? *colour / brightness : Vec3d{1, 1, 1};
  return splat(1 - *amount) + full * *amount;
}

void read_sheen(Build& build, ObjectReader& reader, Principled& principled) {
  const uint32_t sheen = optional_scalar(build, reader, "sheen");
  const Vec3d colour = tint(build, reader, "sheen_tint", principled.base_colour);
  if (sheen == no_index) return;
  build.warn(reader.place_of("sheen"), "'sheen' is rendered by another model, of about the same brightness");
  principled.sheen_colour = product(build, sheen, build.constant_texture(colour * 0.25));
  principled.sheen_roughness = build.constant_texture(splat(0.3));
}

/// Its weight is a quarter there; its alpha is from 0.1 to 0.001, the more the glossier.
void read_clearcoat(Build& build, ObjectReader& reader, Principled& principled) {
  const uint32_t clearcoat = optional_scalar(build, reader, "clearcoat");
  const std::optional<double> gloss = constant_number(build, limited_scalar(build, reader, "clearcoat_gloss", 0));
  if (clearcoat == no_index) return;
  if (!gloss)
    build.warn(reader.place_of("clearcoat_gloss"), "a textured 'clearcoat_gloss' is not supported; 0.5 is used");
  principled.clearcoat = product(build, clearcoat, build.constant_texture(splat(0.25)));
  const double alpha = 0.1 + (0.001 - 0.1) * gloss.value_or(0.5);
  principled.clearcoat_roughness = build.constant_texture(splat(std::sqrt(alpha)));
}

double read_ior(ObjectReader& reader) {
  if (reader.has("eta") && reader.has("specular"))
    fail(reader.place_of("specular"), reader.name() + " takes either 'eta' or 'specular'");
  if (reader.has("eta")) return reader.positive("eta", 1.5);
  const double specular = reader.number("specular", 0.5);
  if (!(specular >= 0 && specular <= 1)) fail(reader.place_of("specular"), "'specular' must be from 0 to 1");
  return 2 / (1 - std::sqrt(0.08 * specular)) - 1;
}

void warn_of_flatness(Build& build, ObjectReader& reader) {
  if (optional_scalar(build, reader, "flatness") != no_index)
    build.warn(reader.place_of("flatness"), "'flatness' is not supported; 0 is used");
}

}  // namespace

Material read_principled(Build& build, ObjectReader& reader) {
  Material material;
  material.kind = MaterialKind::principled;
  Principled& principled = material.principled;
  principled.base_colour = colour_texture(build, reader, "base_color", ColourUse::reflectance, splat(0.5));
  principled.metallic = optional_scalar(build, reader, "metallic");
  principled.ior = read_ior(reader);
  read_roughness(build, reader, principled);
  const Vec3d specular_colour = tint(build, reader, "spec_tint", principled.base_colour);
  if (!(specular_colour == Vec3d{1, 1, 1})) principled.specular_colour = build.constant_texture(specular_colour);
  read_sheen(build, reader, principled);
  read_clearcoat(build, reader, principled);
  warn_of_flatness(build, reader);
  principled.transmission = optional_scalar(build, reader, "spec_trans");
  if (principled.transmission != no_index) {
    principled.thin = false;
    // There each crossing of the surface takes the root of the base colour.
    const std::optional<Vec3d> base = constant_value(build, principled.base_colour);
    if (base && constant_number(build, principled.transmission) == 1.0)
      principled.base_colour = build.constant_texture({std::sqrt(base->x), std::sqrt(base->y), std::sqrt(base->z)});
  }
  reader.ignore({"main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate"});
  return material;
}

Material read_principled_thin(Build& build, ObjectReader& reader) {
  Material material;
  material.kind = MaterialKind::principled;
  Principled& principled = material.principled;
  principled.base_colour = colour_texture(build, reader, "base_color", ColourUse::reflectance, splat(0.5));
  principled.ior = reader.positive("eta", 1.5);
  read_roughness(build, reader, principled);
  const Vec3d specular_colour = tint(build, reader, "spec_tint", principled.base_colour);
  if (!(specular_colour == Vec3d{1, 1, 1})) principled.specular_colour = build.constant_texture(specular_colour);
  read_sheen(build, reader, principled);
  warn_of_flatness(build, reader);
  principled.transmission = optional_scalar(build, reader, "spec_trans");
  const uint32_t through = optional_scalar(build, reader, "diff_trans", 2);
  if (through != no_index) {
    // From 0 to 2, of which 2 is all.
    principled.diffuse_transmission = product(build, through, build.constant_texture(splat(0.5)));
    principled.diffuse_transmission_colour = principled.base_colour;
  }
  reader.ignore({"specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
                 "diffuse_transmittance_sampling_rate", "diffuse_reflectance_sampling_rate"});
  return material;
}

}  // namespace alhazen::impl::mitsuba
