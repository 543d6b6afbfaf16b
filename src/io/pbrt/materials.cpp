#include "io/pbrt/materials.h"

#include <map>
#include <utility>
#include <vector>

#include "io/pbrt/colours.h"
#include "io/pbrt/nearest.h"
#include "io/pbrt/textures.h"

namespace alhazen::pbrt {

namespace {

struct ReadMaterial {
  Material material;
  bool invisible = false;  ///< shapes of it are left out
};

/// The Fraunhofer d line, at which the index of a glass is quoted.
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
  if (material.roughness_u != material.roughness_v)
    build.warn(list.place_of(prefix + (v != no_index ? "vroughness" : "uroughness")),
               "roughness that differs along u and v is not supported; that along u is used for both");
}

const Spectrum& copper(const ParameterList& list, const std::string& name) {
  if (const Spectrum* spectrum = named_spectrum(name)) return *spectrum;
  fail(list.place(), "the spectrum \"" + name + "\", default of " + list.directive() + ", is missing in this build");
}

/// eta and k, together where both are spectra: their projections to sRGB depend on each other.
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
  material.type = MaterialType::conductor;
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

ReadMaterial read_conductor(Build& build, ParameterList& list) {
  ReadMaterial read;
  read_conductor_colour(build, list, "", read.material);
  read_roughness(build, list, "", read.material);
  return read;
}

double read_ior(Build& build, ParameterList& list) {
  const Parameter* eta = list.find("eta", {ParameterType::number, ParameterType::spectrum});
  if (!eta) return 1.5;
  if (eta->type == ParameterType::number) return list.positive("eta", 1.5);
  const Spectrum spectrum = *spectrum_of(build, *eta);
  build.warn(eta->place, "dispersion is not supported; the index of refraction is that at 587.56 nm");
  const double ior = spectrum.at(d_line_nanometres);
  if (!(ior > 0)) fail(eta->place, "\"eta\": the spectrum has no value over 0 at 587.56 nm");
  return ior;
}

ReadMaterial read_dielectric(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.type = MaterialType::dielectric;
  read.material.ior = read_ior(build, list);
  read_roughness(build, list, "", read.material);
  return read;
}

ReadMaterial read_coated_conductor(Build& build, ParameterList& list) {
  ReadMaterial read;
  read_conductor_colour(build, list, "conductor.", read.material);
  read_roughness(build, list, "conductor.", read.material);
  return read;
}

ReadMaterial read_diffuse_transmission(Build& build, ParameterList& list) {
  ReadMaterial read;
  read.material.reflectance = colour_texture_or(build, list, "reflectance", ColourUse::albedo, 0.25);
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
  const uint32_t amount = scalar_texture_or(build, list, "amount", 0.5);
  // Where the amount is 1 the second one is all that is seen.
  const std::string& name = constant_value(build, amount) == 1.0 ? names[1] : names[0];
  const auto found = build.materials.find(name);
  if (found == build.materials.end() || !found->second.defined)
    fail(place, "material \"" + name + "\" is not defined before this mix");
  return {build.scene.materials[found->second.index], build.material_is_invisible[found->second.index]};
}

/// What the materials that are replaced take besides what their replacement does.
void ignore_parameters_of_replaced(ParameterList& list) {
  list.ignore({"reflectance",
               "roughness",
               "uroughness",
               "vroughness",
               "remaproughness",
               "thickness",
               "eta",
               "g",
               "albedo",
               "maxdepth",
               "nsamples",
               "interface.roughness",
               "interface.uroughness",
               "interface.vroughness",
               "interface.eta",
               "transmittance",
               "scale",
               "sigma_a",
               "sigma_s",
               "mfp",
               "name",
               "eumelanin",
               "pheomelanin",
               "beta_m",
               "beta_n",
               "alpha",
               "color",
               "filename"});
}

struct KnownMaterial {
  ReadMaterial (*read)(Build&, ParameterList&);
  const char* replacement = nullptr;  ///< what is done instead, where the material is not supported
};

constexpr const char* as_diffuse = "diffuse of its reflectance (0.5 where it has none) is used";
constexpr const char* as_nothing = "its surfaces are left out, as participating media are";

const std::map<std::string, KnownMaterial> known_materials{
    {"diffuse", {read_diffuse}},
    {"conductor", {read_conductor}},
    {"dielectric", {read_dielectric}},
    {"coateddiffuse", {read_diffuse, "diffuse of its reflectance is used, without the coat"}},
    {"coatedconductor", {read_coated_conductor, "conductor of its conductor parameters is used, without the coat"}},
    // A dielectric would bend light as if all behind the pane were glass, and keep the light of lamps from passing.
    {"thindielectric", {read_interface, "the panes are left out, as if fully clear"}},
    {"diffusetransmission", {read_diffuse_transmission, "diffuse of its reflectance is used, without transmission"}},
    {"subsurface", {read_diffuse, as_diffuse}},
    {"measured", {read_diffuse, as_diffuse}},
    {"hair", {read_diffuse, as_diffuse}},
    {"mix", {read_mix, "the first of its materials is used (the second where the amount is 1)"}},
    {"interface", {read_interface, as_nothing}},
    {"none", {read_interface, as_nothing}},
    {"", {read_interface, as_nothing}}};

ReadMaterial read_material(Build& build, const std::string& kind, const Place& kind_place, ParameterList& list) {
  list.inherit(build.state.defaults.material);
  const auto known = known_materials.find(kind);
  if (known == known_materials.end()) {
    std::vector<std::string> kinds;
    for (const auto& [name, material] : known_materials) kinds.push_back(name);
    fail(kind_place, "unknown material \"" + kind + "\"" + suggestion(kind, kinds));
  }
  if (const char* replacement = known->second.replacement) {
    build.warn(kind_place, "material \"" + kind + "\" is not supported; " + replacement);
    ignore_parameters_of_replaced(list);
  }
  for (const char* name : {"displacement", "normalmap"})
    if (list.has(name))
      build.warn(list.place_of(name), std::string("\"") + name + "\" of materials is not supported; it is left out");
  ReadMaterial read = known->second.read(build, list);
  list.reject_unknown();
  return read;
}

}  // namespace

void set_material(Build& build, const std::string& kind, ParameterList& list) {
  ReadMaterial read = read_material(build, kind, list.place(), list);
  build.state.material = static_cast<uint32_t>(build.scene.materials.size());
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

}  // namespace alhazen::pbrt
