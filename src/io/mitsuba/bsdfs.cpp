#include "io/mitsuba/bsdfs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "images/read_texture.h"
#include "io/mitsuba/dielectric_index.h"
#include "io/mitsuba/principled.h"
#include "io/mitsuba/textures.h"
#include "util/quoted.h"
#include "util/suggestion.h"

namespace alhazen::impl::mitsuba {

namespace {

constexpr Vec3d white{1, 1, 1};
constexpr double min_opaque = 1 - 1e-9;  ///< a luminance of 1 may be rounded down

ReadBsdf add_material(Build& build, const ObjectReader& reader, Material material, bool is_black_behind) {
  material.name = reader.object().id;
  build.scene.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(build.scene.materials.size() - 1), is_black_behind};
}

/// Reads alpha, which is that of the GGX distribution itself.
void read_roughness(Build& build, ObjectReader& reader, Material& material) {
  std::string distribution = reader.text("distribution", "beckmann");
  std::transform(distribution.begin(), distribution.end(), distribution.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (distribution == "beckmann")
    build.warn(reader.place_of("distribution"),
               "the distribution 'beckmann' (Mitsuba's default) is not supported; 'ggx' with the same alpha is used");
  else if (distribution != "ggx")
    fail(reader.place_of("distribution"), "unknown 'distribution' " + quoted(distribution) + "; use ggx or beckmann");
  reader.ignore({"sample_visible"});
  material.remap_roughness = false;
  if (reader.has("alpha_u") != reader.has("alpha_v") || (reader.has("alpha_u") && reader.has("alpha")))
    fail(reader.place(), reader.name() + " takes either 'alpha' or both 'alpha_u' and 'alpha_v'");
  if (reader.has("alpha_u")) {
    material.roughness_u = scalar_texture(build, reader, "alpha_u", 0.1);
    material.roughness_v = scalar_texture(build, reader, "alpha_v", 0.1);
  } else {
    material.roughness_u = material.roughness_v = scalar_texture(build, reader, "alpha", 0.1);
  }
}

/// Whether a factor is given that is not 1, which has no counterpart here.
bool has_factor(Build& build, ObjectReader& reader, const char* name) {
  return reader.has(name) && constant_value(build, colour_texture(build, reader, name, ColourUse::reflectance,
                                                                  white)) != std::optional<Vec3d>(white);
}

void warn_of_factor(Build& build, ObjectReader& reader, const char* name) {
  if (has_factor(build, reader, name))
    build.warn(reader.place_of(name),
               quoted(std::string_view(name)) + " of " + reader.name() + " is not supported; 1 is used");
}

ReadBsdf read_diffuse(Build& build, ObjectReader& reader) {
  Material material;
  material.reflectance = colour_texture(build, reader, "reflectance", ColourUse::reflectance, splat(0.5));
  return add_material(build, reader, material, true);
}

double normal_reflectance(double eta, double k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

/// The metals that Mitsuba names without a table of them here.
const std::set<std::string_view> other_metals{
    "a-C", "AlAs", "AlSb", "Be", "Cr",  "CsI",  "Cu2O", "CuO", "d-C",  "Hg",  "HgTe", "Ir", "K", "Li", "Mo", "Na",
    "Nb",  "Ni",   "Rh",   "Se", "SiC", "SnTe", "Ta",   "Te",  "ThF4", "TiC", "TiN",  "VC", "V", "VN", "W"};

void read_metal(Build& build, ObjectReader& reader, const std::string& name, Material& material) {
  std::string metal = name;
  if (metal.ends_with("_palik")) metal.resize(metal.size() - 6);
  if (other_metals.contains(metal)) {
    build.warn(reader.place_of("material"),
               "the metal " + quoted(metal) + " has no table here; that of aluminium is used: give 'eta' and 'k'");
    metal = "Al";
  }
  const Spectrum* eta = named_spectrum("metal-" + metal + "-eta");
  const Spectrum* k = named_spectrum("metal-" + metal + "-k");
  if (!eta || !k)
    fail(reader.place_of("material"),
         "no metal is named " + quoted(name) + "; known are Ag, Al, Au, Cu, CuZn, MgO, TiO2, none");
  material.eta = build.constant_texture(equal_energy_rgb(*eta));
  material.k = build.constant_texture(equal_energy_rgb(*k));
}

ReadBsdf read_conductor_of(Build& build, ObjectReader& reader, Material material) {
  material.kind = MaterialKind::conductor;
  const std::string metal = reader.text("material", "none");
  const uint32_t factor = colour_texture(build, reader, "specular_reflectance", ColourUse::reflectance, white);
  if (!reader.has("eta") && !reader.has("k") && metal == "none") {
    material.reflectance = factor;
    return add_material(build, reader, material, true);
  }
  if (reader.has("eta") || reader.has("k")) {
    if (reader.has("material")) fail(reader.place_of("material"), "give either 'material' or 'eta' and 'k'");
    material.eta = colour_texture(build, reader, "eta", ColourUse::unbounded, {});
    material.k = colour_texture(build, reader, "k", ColourUse::unbounded, white);
  } else {
    read_metal(build, reader, metal, material);
  }
  if (constant_value(build, factor) == std::optional<Vec3d>(white)) return add_material(build, reader, material, true);
  const auto eta = constant_value(build, material.eta), k = constant_value(build, material.k);
  if (!eta || !k) {
    warn_of_factor(build, reader, "specular_reflectance");
    return add_material(build, reader, material, true);
  }
  build.warn(reader.place_of("specular_reflectance"),
             "'specular_reflectance' of a metal scales its reflectance at normal incidence; at grazing angles it "
             "reflects all");
  Vec3d facing{};
  for (int i = 0; i < 3; ++i) facing[i] = normal_reflectance((*eta)[i], (*k)[i]);
  material.reflectance = product(build, build.constant_texture(facing), factor);
  material.eta = material.k = no_index;
  return add_material(build, reader, material, true);
}

ReadBsdf read_conductor(Build& build, ObjectReader& reader) { return read_conductor_of(build, reader, {}); }

ReadBsdf read_rough_conductor(Build& build, ObjectReader& reader) {
  Material material;
  read_roughness(build, reader, material);
  return read_conductor_of(build, reader, material);
}

/// Where transmitted light is coloured, the principled material has what the dielectric lacks.
ReadBsdf read_dielectric_of(Build& build, ObjectReader& reader, Material material) {
  material.kind = MaterialKind::dielectric;
  material.ior = relative_ior(reader, "bk7");
  warn_of_factor(build, reader, "specular_reflectance");
  if (!has_factor(build, reader, "specular_transmittance")) return add_material(build, reader, material, false);
  Principled& principled = material.principled;
  principled.base_colour = colour_texture(build, reader, "specular_transmittance", ColourUse::reflectance, white);
  principled.transmission = build.constant_texture(white);
  principled.thin = false;
  principled.ior = material.ior;
  const uint32_t alpha = material.roughness_u;
  const std::optional<Vec3d> constant = alpha == no_index ? Vec3d{} : constant_value(build, alpha);
  if (!constant || material.roughness_v != alpha)
    build.warn(reader.place(),
               "'specular_transmittance' with an alpha that is textured or differs along u and v is not "
               "supported; the mean roughness 0.3 is used");
  principled.roughness = build.constant_texture(splat(constant ? std::sqrt(constant->x) : 0.3));
  material.kind = MaterialKind::principled;
  return add_material(build, reader, material, false);
}

ReadBsdf read_dielectric(Build& build, ObjectReader& reader) { return read_dielectric_of(build, reader, {}); }

ReadBsdf read_rough_dielectric(Build& build, ObjectReader& reader) {
  Material material;
  read_roughness(build, reader, material);
  return read_dielectric_of(build, reader, material);
}

ReadBsdf read_thin_dielectric(Build& build, ObjectReader& reader) {
  Material material;
  material.kind = MaterialKind::thin_dielectric;
  material.ior = relative_ior(reader, "bk7");
  warn_of_factor(build, reader, "specular_reflectance");
  warn_of_factor(build, reader, "specular_transmittance");
  return add_material(build, reader, material, false);
}

/// Light is reflected to and fro below the coat. Without 'nonlinear' Mitsuba divides by what a white base would lose to
/// the interface; the base that gives the same light is a / (1 - F + a F).
uint32_t linear_base(Build& build, ObjectReader& reader, uint32_t reflectance, const Material& material) {
  const std::optional<Vec3d> a = constant_value(build, reflectance);
  const std::optional<Vec3d> alpha =
      material.roughness_u == no_index ? Vec3d{} : constant_value(build, material.roughness_u);
  if (!a) {
    build.warn(reader.place(),
               "a textured 'diffuse_reflectance' without 'nonlinear' is not supported; it is rendered "
               "with 'nonlinear', where colours are more saturated");
    return reflectance;
  }
  const double inside = internal_diffuse_reflectance(material.ior, alpha ? alpha->x : 0.1);
  return build.constant_texture(*a / (splat(1 - inside) + *a * inside));
}

ReadBsdf read_plastic_of(Build& build, ObjectReader& reader, Material material) {
  material.kind = MaterialKind::coated_diffuse;
  material.ior = relative_ior(reader, "polypropylene");
  material.reflectance = colour_texture(build, reader, "diffuse_reflectance", ColourUse::reflectance, splat(0.5));
  if (!reader.boolean("nonlinear", false))
    material.reflectance = linear_base(build, reader, material.reflectance, material);
  warn_of_factor(build, reader, "specular_reflectance");
  return add_material(build, reader, material, true);
}

ReadBsdf read_plastic(Build& build, ObjectReader& reader) { return read_plastic_of(build, reader, {}); }

ReadBsdf read_rough_plastic(Build& build, ObjectReader& reader) {
  Material material;
  read_roughness(build, reader, material);
  return read_plastic_of(build, reader, material);
}

ReadBsdf read_null(Build&, ObjectReader&) { return {}; }

/// The nested BSDFs, from `least` to `most`.
std::vector<ReadBsdf> nested_bsdfs(Build& build, ObjectReader& reader, size_t least, size_t most) {
  const std::vector<const Property*> found = reader.objects("bsdf");
  if (found.size() < least || found.size() > most)
    fail(reader.place(), reader.name() + " takes " + (least == most ? "" : std::to_string(least) + " or ") +
                             std::to_string(most) + " nested BSDFs; here are " + std::to_string(found.size()));
  std::vector<ReadBsdf> read;
  for (const Property* property : found) read.push_back(read_bsdf(build, *property));
  return read;
}

ReadBsdf read_two_sided(Build& build, ObjectReader& reader) {
  std::vector<ReadBsdf> nested = nested_bsdfs(build, reader, 1, 2);
  if (nested.size() == 2)
    build.warn(reader.place(), "different BSDFs on both sides are not supported; the first is used for both");
  reader.ignore({"allow_transmission"});
  nested[0].is_black_behind = false;
  return nested[0];
}

/// A copy of a material, of a mix with copies of what it mixes, after `change`. `copies` has those made so far, by the
/// material, as mixes may share parts.
template <class Change>
uint32_t changed(Build& build, uint32_t index, const Change& change, std::map<uint32_t, uint32_t>& copies) {
  if (const auto copy = copies.find(index); copy != copies.end()) return copy->second;
  Material material = build.scene.materials[index];
  if (material.kind == MaterialKind::mix)
    for (uint32_t& part : material.mixed) part = changed(build, part, change, copies);
  else
    change(material);
  build.scene.materials.push_back(std::move(material));
  return copies[index] = static_cast<uint32_t>(build.scene.materials.size() - 1);
}

template <class Change>
uint32_t changed(Build& build, uint32_t index, const Change& change) {
  std::map<uint32_t, uint32_t> copies;
  return changed(build, index, change, copies);
}

/// `bsdf` where a random number is below `opacity`, and nothing elsewhere.
ReadBsdf masked(Build& build, ReadBsdf bsdf, uint32_t opacity) {
  if (bsdf.material == no_index) return bsdf;
  const std::optional<Vec3d> constant = constant_value(build, opacity);
  if (constant && constant->x >= min_opaque) return bsdf;
  if (constant && constant->x <= 0) return {};
  Material material = build.scene.materials[bsdf.material];
  material.alpha = material.alpha == no_index ? opacity : product(build, material.alpha, opacity);
  build.scene.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(build.scene.materials.size() - 1), bsdf.is_black_behind};
}

ReadBsdf read_mask(Build& build, ObjectReader& reader) {
  const ReadBsdf nested = nested_bsdfs(build, reader, 1, 1)[0];
  return masked(build, nested, scalar_texture(build, reader, "opacity", 0.5));
}

/// The texture `a` where `weight` is 0, and `b` where it is 1.
uint32_t blended(Build& build, uint32_t a, uint32_t b, uint32_t weight) {
  if (a == b) return a;
  const std::optional<Vec3d> x = constant_value(build, a), y = constant_value(build, b),
                             w = constant_value(build, weight);
  if (x && y && w) return build.constant_texture(lerp(*x, *y, std::clamp(w->x, 0.0, 1.0)));
  Texture texture;
  texture.kind = TextureKind::mix;
  texture.inputs = {a, b, weight};
  return build.add_texture(texture);
}

uint32_t alpha_of(Build& build, const ReadBsdf& bsdf) {
  const uint32_t alpha = build.scene.materials[bsdf.material].alpha;
  return alpha == no_index ? build.constant_texture(white) : alpha;
}

/// The opacity of a mix counts, not those of its parts: it is that of both, and of the light that is stopped each part
/// has the fraction that it stops.
void blend_opacities(Build& build, ObjectReader& reader, const std::vector<ReadBsdf>& parts, Material& mix) {
  const uint32_t a = alpha_of(build, parts[0]), b = alpha_of(build, parts[1]), weight = mix.amount;
  const std::optional<Vec3d> x = constant_value(build, a), y = constant_value(build, b),
                             w = constant_value(build, weight);
  if (x && y && x->x >= min_opaque && y->x >= min_opaque) return;
  mix.alpha = blended(build, a, b, weight);
  if (a == b) return;
  if (!x || !y || !w) {
    build.warn(reader.place(),
               "the BSDFs of a 'blendbsdf' differ in their opacity ('mask'), and that or 'weight' is a texture: the "
               "surface is as opaque as in Mitsuba, but what it reflects is mixed by 'weight' alone");
    return;
  }
  const double opacity = constant_value(build, mix.alpha)->x;
  if (opacity > 0) mix.amount = build.constant_texture(splat(std::clamp(w->x, 0.0, 1.0) * y->x / opacity));
}

ReadBsdf read_blend(Build& build, ObjectReader& reader) {
  const std::vector<ReadBsdf> nested = nested_bsdfs(build, reader, 2, 2);
  if (!reader.has("weight")) fail(reader.place(), reader.name() + " needs its 'weight'");
  const uint32_t weight = scalar_texture(build, reader, "weight", 0.5);
  if (nested[0].material == no_index) return masked(build, nested[1], weight);
  if (nested[1].material == no_index) {
    const uint32_t all = build.constant_texture(white), nothing = build.constant_texture({});
    return masked(build, nested[0], blended(build, all, nothing, weight));
  }
  Material material;
  material.kind = MaterialKind::mix;
  material.amount = weight;
  material.mixed = {nested[0].material, nested[1].material};
  blend_opacities(build, reader, nested, material);
  return add_material(build, reader, material, nested[0].is_black_behind || nested[1].is_black_behind);
}

ReadBsdf read_bump_map(Build& build, ObjectReader& reader) {
  ReadBsdf nested = nested_bsdfs(build, reader, 1, 1)[0];
  uint32_t heights = nested_texture(build, reader, true);
  if (heights == no_index) fail(reader.place(), reader.name() + " needs a texture of heights");
  heights = product(build, heights, build.constant_texture(splat(reader.number("scale", 1))));
  reader.ignore({"flip_invalid_normals", "use_shadowing_function"});
  if (nested.material != no_index)
    nested.material = changed(build, nested.material, [&](Material& material) { material.displacement = heights; });
  return nested;
}

ReadBsdf read_normal_map(Build& build, ObjectReader& reader) {
  ReadBsdf nested = nested_bsdfs(build, reader, 1, 1)[0];
  if (!reader.has("normalmap")) fail(reader.place(), reader.name() + " needs its texture 'normalmap'");
  const uint32_t normals = colour_texture(build, reader, "normalmap", ColourUse::unbounded, {});
  const Texture& texture = build.scene.textures[normals];
  if (texture.kind == TextureKind::image && build.scene.images[texture.image].srgb &&
      !build.scene.images[texture.image].bytes.empty())
    build.warn(reader.place_of("normalmap"),
               "the normals are decoded from sRGB, as Mitsuba does too; give the bitmap <boolean name=\"raw\" "
               "value=\"true\"/>");
  reader.ignore({"flip_invalid_normals", "use_shadowing_function"});
  if (nested.material != no_index)
    nested.material = changed(build, nested.material, [&](Material& material) { material.normal_map = normals; });
  return nested;
}

ReadBsdf read_principled_solid(Build& build, ObjectReader& reader) {
  Material material = read_principled(build, reader);
  const bool transmits = material.principled.transmission != no_index;
  return add_material(build, reader, std::move(material), !transmits);
}

ReadBsdf read_principled_sheet(Build& build, ObjectReader& reader) {
  return add_material(build, reader, read_principled_thin(build, reader), false);
}

struct KnownBsdf {
  ReadBsdf (*read)(Build&, ObjectReader&);
  const char* replacement = nullptr;  ///< what is used instead, if the BSDF is not supported
};

constexpr const char* as_diffuse = "diffuse with its 'reflectance' (0.5 if it has none) is used";
constexpr const char* as_nothing = "its surfaces are omitted";

const std::map<std::string, KnownBsdf> known_bsdfs{
    {"diffuse", {read_diffuse}},
    {"conductor", {read_conductor}},
    {"roughconductor", {read_rough_conductor}},
    {"dielectric", {read_dielectric}},
    {"roughdielectric", {read_rough_dielectric}},
    {"thindielectric", {read_thin_dielectric}},
    {"plastic", {read_plastic}},
    {"roughplastic", {read_rough_plastic}},
    {"principled", {read_principled_solid}},
    {"principledthin", {read_principled_sheet}},
    {"twosided", {read_two_sided}},
    {"mask", {read_mask}},
    {"blendbsdf", {read_blend}},
    {"bumpmap", {read_bump_map}},
    {"normalmap", {read_normal_map}},
    {"null", {read_null}},
    {"pplastic", {read_rough_plastic, "roughplastic without polarization is used"}},
    {"measured", {read_diffuse, as_diffuse}},
    {"measured_polarized", {read_diffuse, as_diffuse}},
    {"hair", {read_diffuse, as_diffuse}},
    {"circular", {read_null, as_nothing}},
    {"polarizer", {read_null, as_nothing}},
    {"retarder", {read_null, as_nothing}}};

ReadBsdf read_object(Build& build, uint32_t index) {
  ObjectReader reader(build.document, index);
  const auto known = known_bsdfs.find(reader.object().type);
  if (known == known_bsdfs.end()) {
    std::vector<std::string> types;
    for (const auto& [type, bsdf] : known_bsdfs) types.push_back(type);
    fail(reader.place(), "unknown BSDF " + quoted(reader.object().type) + suggestion(reader.object().type, types));
  }
  if (reader.object().is_of_version_1 && known->first == "diffuse" && reader.has("diffuse_reflectance")) {
    Material material;
    material.reflectance = colour_texture(build, reader, "diffuse_reflectance", ColourUse::reflectance, splat(0.5));
    reader.reject_unknown();
    return add_material(build, reader, material, true);
  }
  if (known->second.replacement)
    build.warn(reader.place(), "the BSDF " + quoted(known->first) + " is not supported; " + known->second.replacement);
  ReadBsdf read = known->second.read(build, reader);
  if (known->second.replacement) reader.ignore_all();
  reader.reject_unknown();
  return read;
}

}  // namespace

ReadBsdf read_bsdf(Build& build, const Property& property) {
  const auto found = build.bsdfs.find(property.object);
  if (found != build.bsdfs.end()) return found->second;
  const ReadBsdf read = read_object(build, property.object);
  build.bsdfs.emplace(property.object, read);
  return read;
}

ReadBsdf default_bsdf(Build& build) {
  if (build.default_material == no_index) {
    Material material;
    material.reflectance = build.constant_texture(splat(0.5));
    build.default_material = static_cast<uint32_t>(build.scene.materials.size());
    build.scene.materials.push_back(std::move(material));
  }
  return {build.default_material, true};
}

}  // namespace alhazen::impl::mitsuba
