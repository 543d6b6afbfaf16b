#include "io/pbrt/materials.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "images/read_texture.h"
#include "io/pbrt/colours.h"
#include "io/pbrt/suggestions.h"
#include "io/pbrt/textures.h"
#include "scene/mixes.h"

namespace alhazen::impl::pbrt {

namespace {

struct ReadMaterial {
  Material material;
  bool invisible = false;  ///< its shapes are omitted
};

/// The Fraunhofer d line, at which indices of refraction of glass are quoted.
constexpr double d_line_nanometres = 587.56;

void read_roughness(Build& build, ParameterList& list, const std::string& prefix, Material& material) {
  const uint32_t both = scalar_texture(build, list, prefix + "roughness");
  const uint32_t u = scalar_texture(build, list, prefix + "uroughness");
  const uint32_t v = scalar_texture(build, list, prefix + "vroughness");
  material.roughness_u = u != no_index ? u : both;
  material.roughness_v = v != no_index ? v : both;
  material.remap_roughness = list.boolean("remaproughness", true);
  const auto is_smooth = [&](uint32_t texture) { return texture == no_index || constant_value(build, texture) == 0.0; };
  if (is_smooth(material.roughness_u) && is_smooth(material.roughness_v))
    material.roughness_u = material.roughness_v = no_index;
  else if (material.roughness_u == no_index)
    material.roughness_u = build.constant_texture({});
  else if (material.roughness_v == no_index)
    material.roughness_v = build.constant_texture({});
}

const Spectrum& copper(const ParameterList& list, const std::string& name) {
  if (const Spectrum* spectrum = named_spectrum(name)) return *spectrum;
  fail(list.place(), "the spectrum \"" + name + "\", default of " + list.directive() + ", is missing in this build");
}

/// Reads eta and k, together if both are spectra, since their conversions to sRGB depend on each other.
void read_conductor_indices(Build& build, ParameterList& list, const std::string& prefix, Material& material) {
  const std::string eta_name = prefix + "eta", k_name = prefix + "k";
  const Parameter* eta = list.find(eta_name);
  const Parameter* k = list.find(k_name);
  const auto eta_spectrum = eta ? spectrum_of(build, *eta) : copper(list, "metal-Cu-eta");
  const auto k_spectrum = k ? spectrum_of(build, *k) : copper(list, "metal-Cu-k");
  if (eta_spectrum && k_spectrum) {
    const ConductorRgb rgb = conductor_rgb(*eta_spectrum, *k_spectrum);
    material.eta = build.constant_texture(rgb.eta);
    material.k = build.constant_texture(rgb.k);
    return;
  }
  material.eta = eta ? colour_texture(build, list, eta_name, ColourUse::unbounded)
                     : build.constant_texture(reflectance_rgb(*eta_spectrum));
  material.k = k ? colour_texture(build, list, k_name, ColourUse::unbounded)
                 : build.constant_texture(reflectance_rgb(*k_spectrum));
}

void read_conductor_colour(Build& build, ParameterList& list, const std::string& prefix, Material& material) {
  material.kind = MaterialKind::conductor;
  material.reflectance = colour_texture(build, list, "reflectance", ColourUse::albedo);
  if (material.reflectance == no_index)
    read_conductor_indices(build, list, prefix, material);
  else if (list.has(prefix + "eta") || list.has(prefix + "k"))
    fail(list.place_of("reflectance"), "a conductor takes either \"reflectance\" or \"eta\" and \"k\", not both");
}

ReadMaterial read_diffuse(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.reflectance = colour_texture_or(build, list, "reflectance", ColourUse::albedo, 0.5);
  return read;
}

/// `roughness` is our extension; where it is 0 the material is diffuse as pbrt has it.
ReadMaterial read_rough_diffuse(Build& build, ParameterList& list) {
  ReadMaterial read = read_diffuse(build, list);
  const uint32_t roughness = scalar_texture(build, list, "roughness");
  if (roughness == no_index) return read;
  const std::optional<double> constant = constant_value(build, roughness);
  if (constant && !(*constant >= 0 && *constant <= 1))
    fail(list.place_of("roughness"), "\"roughness\" of a diffuse material must be between 0 and 1");
  if (constant == 0.0) return read;
  read.material.kind = MaterialKind::oren_nayar;
  read.material.roughness_u = roughness;
  return read;
}

ReadMaterial read_conductor(Build& build, ParameterList& list) {
  ReadMaterial read;
  read_conductor_colour(build, list, "", read.material);
  read_roughness(build, list, "", read.material);
  return read;
}

double read_ior(Build& build, ParameterList& list, const std::string& name, double fallback) {
  const Parameter* eta = list.find(name, {ParameterType::number, ParameterType::spectrum});
  if (!eta) return fallback;
  if (eta->type == ParameterType::number) return list.positive(name, fallback);
  const Spectrum spectrum = *spectrum_of(build, *eta);
  build.warn(eta->place, "dispersion is not supported; the index of refraction is that at 587.56 nm");
  const double ior = spectrum.at(d_line_nanometres);
  if (!(ior > 0)) fail(eta->place, "\"" + name + "\": the spectrum has no value over 0 at 587.56 nm");
  return ior;
}

ReadMaterial read_dielectric(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.kind = MaterialKind::dielectric;
  read.material.ior = read_ior(build, list, "eta", 1.5);
  read_roughness(build, list, "", read.material);
  return read;
}

/// Reads the medium between the interface and the base of a coat.
void read_coat(Build& build, ParameterList& list, Material& material) {
  material.thickness_is_given = list.has("thickness");
  material.thickness = list.number("thickness", 0.01);
  if (!(material.thickness >= 0)) fail(list.place_of("thickness"), "\"thickness\" must not be negative");
  const Parameter* albedo = list.find("albedo");
  if (albedo && albedo->type != ParameterType::texture && !is_zero(colour_of(build, *albedo, ColourUse::unbounded)))
    build.warn(albedo->place, "scattering within coats is not supported; they only absorb");
  // pbrt-v4 counts bounces at both surfaces.
  const int32_t depth = list.integer("maxdepth", 10);
  if (depth < 1) fail(list.place_of("maxdepth"), "\"maxdepth\" must be 1 or more");
  material.coat_bounces = (std::min(depth, 1000) + 1) / 2;
  list.ignore({"g", "nsamples"});
}

ReadMaterial read_coated_diffuse(Build& build, ParameterList& list) {
  ReadMaterial read = read_diffuse(build, list);
  read.material.kind = MaterialKind::coated_diffuse;
  read.material.ior = read_ior(build, list, "eta", 1.5);
  read_roughness(build, list, "", read.material);
  read_coat(build, list, read.material);
  return read;
}

ReadMaterial read_coated_conductor(Build& build, ParameterList& list) {
  ReadMaterial read;
  Material& material = read.material;
  Material interface;
  read_conductor_colour(build, list, "conductor.", material);
  read_roughness(build, list, "interface.", interface);
  read_roughness(build, list, "conductor.", material);
  material.kind = MaterialKind::coated_conductor;
  material.coat_ior = read_ior(build, list, "interface.eta", 1.5);
  material.coat_roughness = interface.roughness_u;
  if (interface.roughness_u != interface.roughness_v)
    build.warn(list.place_of("interface.vroughness"),
               "roughness of a coat that differs along u and v is not supported; that along u is used for both");
  read_coat(build, list, material);
  return read;
}

ReadMaterial read_thin_dielectric(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.kind = MaterialKind::thin_dielectric;
  read.material.ior = read_ior(build, list, "eta", 1.5);
  return read;
}

uint32_t scaled(Build& build, uint32_t texture, double scale) {
  if (scale == 1) return texture;
  Texture product;
  product.kind = TextureKind::scale;
  product.inputs = {texture, build.constant_texture(splat(scale)), no_index};
  build.scene.textures.push_back(product);
  return static_cast<uint32_t>(build.scene.textures.size() - 1);
}

ReadMaterial read_diffuse_transmission(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.kind = MaterialKind::diffuse_transmission;
  const double scale = list.number("scale", 1);
  read.material.reflectance =
      scaled(build, colour_texture_or(build, list, "reflectance", ColourUse::albedo, 0.25), scale);
  read.material.transmittance =
      scaled(build, colour_texture_or(build, list, "transmittance", ColourUse::albedo, 0.25), scale);
  return read;
}

ReadMaterial read_subsurface(Build& build, ParameterList& list) {
  ReadMaterial read = read_diffuse(build, list);
  read.material.kind = MaterialKind::coated_diffuse;
  read.material.ior = read_ior(build, list, "eta", 1.33);
  read_roughness(build, list, "", read.material);
  return read;
}

ReadMaterial read_interface(Build&, ParameterList&) {
  ReadMaterial read;
  read.invisible = true;
  return read;
}

ReadMaterial read_mix(Build& build, ParameterList& list) {
  const Place place = list.place_of("materials");
  const Strings names = list.take_strings("materials");
  if (names.size() != 2) fail(place, "a mix takes two names: \"string materials\" [ \"a\" \"b\" ]");
  ReadMaterial read;
  read.material.kind = MaterialKind::mix;
  read.material.amount = scalar_texture_or(build, list, "amount", 0.5);
  for (size_t i = 0; i < 2; ++i) read.material.mixed[i] = build.named_material(names[i], place).index;
  return read;
}

/// Ignores parameters of replaced materials that the replacement does not use.
void ignore_parameters_of_replaced(ParameterList& list) {
  list.ignore({"reflectance", "roughness", "uroughness", "vroughness", "remaproughness", "eta", "g", "scale", "sigma_a",
               "sigma_s", "mfp", "name", "eumelanin", "beta_m", "beta_n", "alpha", "color", "pheomelanin", "filename"});
}

struct KnownMaterial {
  ReadMaterial (*read)(Build&, ParameterList&);
  const char* replacement = nullptr;  ///< what is used instead, if the material is not supported
};

constexpr const char* as_diffuse = "diffuse with its reflectance (0.5 if it has none) is used";
constexpr const char* as_nothing = "its surfaces are omitted, as participating media are";

const std::map<std::string, KnownMaterial> known_materials{
    {"diffuse", {read_rough_diffuse}},
    {"conductor", {read_conductor}},
    {"dielectric", {read_dielectric}},
    {"coateddiffuse", {read_coated_diffuse}},
    {"coatedconductor", {read_coated_conductor}},
    {"thindielectric", {read_thin_dielectric}},
    {"diffusetransmission", {read_diffuse_transmission}},
    {"subsurface", {read_subsurface, "diffuse with its reflectance (0.5 if it has none) under its interface is used"}},
    {"measured", {read_diffuse, as_diffuse}},
    {"hair", {read_diffuse, as_diffuse}},
    {"mix", {read_mix}},
    {"interface", {read_interface, as_nothing}},
    {"none", {read_interface, as_nothing}},
    {"", {read_interface, as_nothing}}};

/// `"string normalmap"`: the image of normals, whose values are linear.
uint32_t read_normal_map(Build& build, ParameterList& list) {
  if (!list.has("normalmap")) return no_index;
  const std::optional<InputPath> found =
      build.existing_image(list.place_of("normalmap"), list.string("normalmap", ""), "the surface has no normal map");
  if (!found) return no_index;
  const InputPath& path = *found;
  const auto [entry, is_new] =
      build.images_by_key.try_emplace({path.name, static_cast<int>(TextureEncoding::data), false}, 0u);
  if (is_new) {
    entry->second = static_cast<uint32_t>(build.scene.images.size());
    build.scene.images.push_back(read_texture(path, TextureEncoding::data));
  }
  Texture texture;
  texture.kind = TextureKind::image;
  texture.image = entry->second;
  build.scene.textures.push_back(texture);
  return static_cast<uint32_t>(build.scene.textures.size() - 1);
}

ReadMaterial read_material(Build& build, const std::string& kind, const Place& kind_place, ParameterList& list) {
  list.inherit(build.state.defaults.material);
  const auto known = known_materials.find(kind);
  if (known == known_materials.end()) {
    std::vector<std::string> kinds;
    for (const auto& [name, material] : known_materials) kinds.push_back(name);
    fail(kind_place, "unknown material \"" + kind + "\"" + upgrade_or_suggestion(kind, kinds));
  }
  if (const char* replacement = known->second.replacement) {
    build.warn(kind_place, "material \"" + kind + "\" is not supported; " + replacement);
    ignore_parameters_of_replaced(list);
  }
  ReadMaterial read = known->second.read(build, list);
  read.material.displacement = scalar_texture(build, list, "displacement");
  read.material.normal_map = read_normal_map(build, list);
  list.reject_unknown();
  return read;
}

}  // namespace

void set_material(Build& build, const std::string& kind, ParameterList& list) {
  ReadMaterial read = read_material(build, kind, list.place(), list);
  build.state.material = static_cast<uint32_t>(build.scene.materials.size());
  if (read.material.kind == MaterialKind::mix) build.mix_places[build.state.material] = list.place();
  build.scene.materials.push_back(std::move(read.material));
  build.scene.materials.back().name.clear();
  build.material_is_invisible.push_back(read.invisible);
}

void define_named_material(Build& build, const std::string& name, ParameterList& list) {
  if (!list.has("type"))
    fail(list.place(), list.directive() + " needs its kind: \"string type\" [ \"diffuse\" ], for example");
  const std::string kind = list.string("type", "");
  NamedEntry& entry = build.named_material(name, list.place());
  if (entry.defined) fail(list.place(), "material \"" + name + "\" is defined twice; rename one");
  ReadMaterial read = read_material(build, kind, list.place_of("type"), list);
  entry.defined = true;
  if (read.material.kind == MaterialKind::mix) build.mix_places[entry.index] = list.place();
  build.scene.materials[entry.index] = std::move(read.material);
  build.scene.materials[entry.index].name = name;
  build.material_is_invisible[entry.index] = read.invisible;
}

void use_named_material(Build& build, const std::string& name, const Place& place) {
  build.state.material = build.named_material(name, place).index;
}

uint32_t current_material(Build& build) {
  if (build.state.material != no_index) return build.state.material;
  if (build.default_material == no_index) {
    build.default_material = static_cast<uint32_t>(build.scene.materials.size());
    Material& material = build.scene.materials.emplace_back();
    build.material_is_invisible.push_back(false);
    material.reflectance = build.constant_texture(splat(0.5));
  }
  return build.default_material;
}

uint32_t material_of_shape(Build& build, uint32_t alpha, const Place& place) {
  const uint32_t base = current_material(build);
  const Vec3d& absorption = build.state.absorption_inside;
  if (alpha == no_index && is_zero(absorption)) return base;
  const auto index = static_cast<uint32_t>(build.scene.materials.size());
  const auto [known, is_new] =
      build.variants_by_key.try_emplace({base, alpha, {absorption.x, absorption.y, absorption.z}}, index);
  if (!is_new) return known->second;
  build.scene.materials.emplace_back();
  build.material_is_invisible.push_back(false);
  build.variants[index] = {base, alpha, absorption, place};
  return index;
}

void define_named_medium(Build& build, const std::string& name, ParameterList& list) {
  const bool is_homogeneous = list.string("type", "homogeneous") == "homogeneous" && !list.has("preset");
  if (is_homogeneous && list.has("sigma_a") && list.has("sigma_s")) {
    const Vec3d scattering = colour(build, list, "sigma_s", ColourUse::unbounded, {});
    if (is_zero(scattering)) {
      const double scale = list.number("scale", 1);
      build.absorbing_media[name] = colour(build, list, "sigma_a", ColourUse::unbounded, {}) * scale;
      return;
    }
  }
  build.warn(list.place(), "participating media that scatter are not supported; they are omitted");
}

void set_medium_interface(Build& build, const std::string& inside, const std::string& outside, const Place& place) {
  const auto absorbing = [&](const std::string& name) { return name.empty() || build.absorbing_media.contains(name); };
  build.state.absorption_inside = {};
  if (!absorbing(inside) || !outside.empty()) {
    build.warn(place,
               "participating media are not supported, except homogeneous ones without scattering inside "
               "dielectrics; they are omitted");
    return;
  }
  if (!inside.empty()) build.state.absorption_inside = build.absorbing_media.at(inside);
}

namespace {

/// A mix with omitted surfaces is transparent where it selects those.
void finish_mix(Build& build, uint32_t index) {
  const Material mix = build.scene.materials[index];
  const bool first = build.material_is_invisible[mix.mixed[0]], second = build.material_is_invisible[mix.mixed[1]];
  if (!first && !second) return;
  if (first && second) {
    build.material_is_invisible[index] = true;
    return;
  }
  uint32_t alpha = mix.amount;
  if (second) {
    Texture rest;
    rest.kind = TextureKind::mix;
    rest.inputs = {build.constant_texture(splat(1.0)), build.constant_texture({}), mix.amount};
    alpha = static_cast<uint32_t>(build.scene.textures.size());
    build.scene.textures.push_back(rest);
  }
  const std::string name = mix.name;
  build.scene.materials[index] = build.scene.materials[mix.mixed[first ? 1 : 0]];
  build.scene.materials[index].name = name;
  build.scene.materials[index].alpha = alpha;
}

}  // namespace

void finish_materials(Build& build) {
  uint32_t of_itself = no_index;
  const std::vector<uint32_t> mixes = order_of_mixes(build.scene.materials, of_itself);
  if (of_itself != no_index)
    fail(build.mix_places.at(of_itself),
         "the mix \"" + build.scene.materials[of_itself].name + "\" contains itself, directly or through others");
  for (const uint32_t mix : mixes) finish_mix(build, mix);
  for (const auto& [index, variant] : build.variants) {
    Material material = build.scene.materials[variant.base];
    if (variant.alpha != no_index) material.alpha = variant.alpha;
    if (material.kind == MaterialKind::dielectric)
      material.absorption = variant.absorption;
    else if (!is_zero(variant.absorption) && !build.material_is_invisible[variant.base])
      build.warn(variant.medium_place, "a medium inside a surface that is not a dielectric is omitted");
    build.scene.materials[index] = std::move(material);
    build.material_is_invisible[index] = build.material_is_invisible[variant.base];
  }
}

}  // namespace alhazen::impl::pbrt
