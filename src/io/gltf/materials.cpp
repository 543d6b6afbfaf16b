#include "io/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

constexpr Vec3d white{1, 1, 1};

/// Reads one material. A factor out of range is clamped, with a warning.
class MaterialReader {
 public:
  MaterialReader(const Document& document, Textures& textures, const Json& description, bool has_vertex_colours)
      : document_(document), textures_(textures), description_(description), has_vertex_colours_(has_vertex_colours) {
    use_.uv_sets = choose_uv_sets();
  }

  MaterialUse run(Scene& scene) {
    material_.name = document_.string(description_, "name");
    material_.double_sided = document_.flag(description_, "doubleSided", false);
    read_base();
    read_alpha();
    if (document_.extension(description_, "KHR_materials_unlit") != nullptr) {
      make_unlit();
    } else {
      read_common();
      read_extensions();
    }
    use_.tangent_set = tangent_set();
    scene.materials.push_back(std::move(material_));
    use_.material = static_cast<uint32_t>(scene.materials.size() - 1);
    return use_;
  }

 private:
  static void collect_sets(const Document& document, const Json& object, std::set<int>& sets) {
    if (object.kind != JsonKind::object) return;
    for (size_t i = 0; i < object.items.size(); ++i) {
      const Json& item = object.items[i];
      if (item.kind != JsonKind::object || object.keys[i] == "extras") continue;
      if (object.keys[i].ends_with("Texture") && object.keys[i] != "occlusionTexture")
        sets.insert(texture_coordinate_set(document, item));
      else
        collect_sets(document, item, sets);
    }
  }

  /// A mesh carries two uv sets, usually 0 and 1; a higher one replaces one that is not used.
  UvSets choose_uv_sets() const {
    std::set<int> sets;
    collect_sets(document_, description_, sets);
    UvSets chosen{0, 1};
    for (const int set : sets) {
      if (set < 2) continue;
      size_t place = chosen.size();
      for (size_t i = 0; i < chosen.size(); ++i)
        if (!sets.contains(chosen[i])) place = i;
      if (place == chosen.size()) {
        document_.warn(description_,
                       "the material uses more than two sets of texture coordinates; the textures of set " +
                           std::to_string(set) + " use set " + std::to_string(chosen[0]));
        continue;
      }
      chosen[place] = set;
    }
    return chosen;
  }

  /// The uv set of the first texture that uses tangents: a mesh has tangents for one set.
  std::optional<int> tangent_set() const {
    const Principled& p = material_.principled;
    for (const uint32_t texture : {material_.normal_map, p.clearcoat_normal_map, p.anisotropy_direction})
      if (texture != no_index) return textures_.at(texture).uv_set;
    if (p.anisotropy != no_index) return 0;
    return std::nullopt;
  }

  double in_range(const Json& at, const char* key, double value, double low, double high) const {
    if (value >= low && value <= high) return value;
    document_.warn(at, std::string("\"") + key + "\" is out of its range; it is clamped");
    return std::clamp(value, low, high);
  }

  double unit(const Json& object, const char* key, double fallback) const {
    return in_range(object, key, document_.number(object, key, fallback), 0, 1);
  }

  Vec3d colour(const Json& object, const char* key, const Vec3d& fallback, double high = 1) const {
    Vec3d value = document_.vec3(object, key, fallback);
    for (int i = 0; i < 3; ++i) value[i] = in_range(object, key, value[i], 0, high);
    return value;
  }

  uint32_t image(const Json& object, const char* key, Texels texels) {
    return textures_.image(object, key, texels, use_.uv_sets);
  }

  /// factor * one channel of a linear image; absent if it is `default_value` everywhere.
  uint32_t scalar(const Json& object, const char* factor_key, double factor_fallback, const char* texture_key,
                  int channel, double default_value) {
    const double factor = unit(object, factor_key, factor_fallback);
    const uint32_t texture =
        texture_key == nullptr ? no_index : textures_.channel(image(object, texture_key, Texels::linear), channel);
    if (texture == no_index) return factor == default_value ? no_index : textures_.constant({factor, factor, factor});
    return textures_.scaled({factor, factor, factor}, texture);
  }

  /// factor * the alpha of an image, likewise.
  uint32_t alpha_scalar(const Json& object, const char* factor_key, double factor_fallback, const char* texture_key,
                        double default_value) {
    const double factor = unit(object, factor_key, factor_fallback);
    const uint32_t texture = image(object, texture_key, Texels::alpha);
    if (texture == no_index) return factor == default_value ? no_index : textures_.constant({factor, factor, factor});
    return textures_.scaled({factor, factor, factor}, texture);
  }

  uint32_t coloured(const Json& object, const char* factor_key, const Vec3d& fallback, const char* texture_key,
                    const Vec3d& default_value, double high = 1) {
    const Vec3d factor = colour(object, factor_key, fallback, high);
    const uint32_t texture = image(object, texture_key, Texels::srgb);
    if (texture == no_index) return factor == default_value ? no_index : textures_.constant(factor);
    return textures_.scaled(factor, texture);
  }

  void read_base() {
    Principled& p = material_.principled;
    const Json* specular_glossiness = document_.extension(description_, "KHR_materials_pbrSpecularGlossiness");
    const Json* metallic_roughness = document_.object(description_, "pbrMetallicRoughness");
    material_.kind = MaterialKind::principled;
    if (specular_glossiness != nullptr) {
      read_base_colour(*specular_glossiness, "diffuseFactor", "diffuseTexture");
      read_specular_glossiness(*specular_glossiness);
      return;
    }
    const Json& nothing = empty_object();
    const Json& base = metallic_roughness != nullptr ? *metallic_roughness : nothing;
    read_base_colour(base, "baseColorFactor", "baseColorTexture");
    p.metallic = scalar(base, "metallicFactor", 1, "metallicRoughnessTexture", 2, 0);
    p.roughness = scalar(base, "roughnessFactor", 1, "metallicRoughnessTexture", 1, 1);
  }

  void read_base_colour(const Json& object, const char* factor_key, const char* texture_key) {
    Vec3d factor = white;
    if (const std::vector<double> f = document_.numbers(object, factor_key, 4); !f.empty()) {
      for (int i = 0; i < 3; ++i) factor[i] = in_range(object, factor_key, f[static_cast<size_t>(i)], 0, 1);
      alpha_factor_ = in_range(object, factor_key, f[3], 0, 1);
    }
    uint32_t result = textures_.scaled(factor, image(object, texture_key, Texels::srgb));
    if (has_vertex_colours_) result = textures_.product(result, textures_.node(TextureKind::vertex_colour));
    material_.principled.base_colour = result;
    if (document_.string(description_, "alphaMode", "OPAQUE") != "OPAQUE")
      alpha_ = image(object, texture_key, Texels::alpha);
  }

  /// Converts to the newer model's dielectric with its reflection scaled by `specularFactor`; black diffuse and bright
  /// specular colours give a metal.
  void read_specular_glossiness(const Json& object) {
    Principled& p = material_.principled;
    const Vec3d specular = colour(object, "specularFactor", white) / 0.04;
    p.specular_colour =
        textures_.product(textures_.constant(specular), image(object, "specularGlossinessTexture", Texels::srgb));
    const double glossiness = unit(object, "glossinessFactor", 1);
    const uint32_t gloss_map = image(object, "specularGlossinessTexture", Texels::alpha);
    if (gloss_map == no_index) {
      p.roughness = textures_.constant(white * (1 - glossiness));
      return;
    }
    Texture& texture = textures_.at(gloss_map);
    texture.image_scale = glossiness;
    texture.invert = true;
    p.roughness = gloss_map;
  }

  void read_alpha() {
    const std::string mode = document_.string(description_, "alphaMode", "OPAQUE");
    if (mode == "OPAQUE") return;
    if (mode != "MASK" && mode != "BLEND")
      document_.fail(description_, "unknown \"alphaMode\" " + quoted(mode) + ": it may be OPAQUE, MASK or BLEND");
    uint32_t alpha = textures_.scaled(white * alpha_factor_, alpha_);
    if (has_vertex_colours_) alpha = textures_.product(alpha, textures_.node(TextureKind::vertex_alpha));
    const double cutoff = document_.number(description_, "alphaCutoff", 0.5);
    if (mode == "MASK" && (alpha != no_index || cutoff > 1))
      alpha = textures_.threshold(alpha == no_index ? textures_.constant(white) : alpha, cutoff);
    material_.alpha = alpha;
  }

  /// Emits the base colour over black, independently of the lights.
  void make_unlit() {
    use_.emission = Emission{white, material_.double_sided, material_.principled.base_colour};
    material_.principled = {};
    material_.kind = MaterialKind::diffuse;
    material_.reflectance = textures_.constant({0, 0, 0});
  }

  void read_common() {
    material_.normal_map = image(description_, "normalTexture", Texels::linear);
    if (const Json* info = document_.object(description_, "normalTexture"))
      material_.normal_scale = document_.number(*info, "scale", 1);
    Vec3d emitted = colour(description_, "emissiveFactor", {0, 0, 0});
    if (const Json* strength = document_.extension(description_, "KHR_materials_emissive_strength"))
      emitted *= in_range(*strength, "emissiveStrength", document_.number(*strength, "emissiveStrength", 1), 0, 1e30);
    if (max_component(emitted) > 0)
      use_.emission = Emission{emitted, material_.double_sided, image(description_, "emissiveTexture", Texels::srgb)};
  }

  const Json* extension(const char* name) const { return document_.extension(description_, name); }

  void read_extensions() {
    Principled& p = material_.principled;
    if (const Json* e = extension("KHR_materials_ior")) {
      p.ior = document_.number(*e, "ior", 1.5);
      // 0 means an infinite index.
      if (p.ior == 0) p.ior = 1e6;
      p.ior = in_range(*e, "ior", p.ior, 1, 1e6);
    }
    if (const Json* e = extension("KHR_materials_specular")) {
      p.specular = alpha_scalar(*e, "specularFactor", 1, "specularTexture", 1);
      p.specular_colour = coloured(*e, "specularColorFactor", white, "specularColorTexture", white, 1e30);
    }
    if (const Json* e = extension("KHR_materials_transmission"))
      p.transmission = scalar(*e, "transmissionFactor", 0, "transmissionTexture", 0, 0);
    if (const Json* e = extension("KHR_materials_diffuse_transmission")) {
      p.diffuse_transmission = alpha_scalar(*e, "diffuseTransmissionFactor", 0, "diffuseTransmissionTexture", 0);
      p.diffuse_transmission_colour =
          coloured(*e, "diffuseTransmissionColorFactor", white, "diffuseTransmissionColorTexture", white);
    }
    if (const Json* e = extension("KHR_materials_dispersion"))
      p.dispersion = in_range(*e, "dispersion", document_.number(*e, "dispersion", 0), 0, 1e30);
    if (const Json* e = extension("KHR_materials_volume")) read_volume(*e);
    if (const Json* e = extension("KHR_materials_clearcoat")) read_clearcoat(*e);
    if (const Json* e = extension("KHR_materials_sheen")) {
      p.sheen_colour = coloured(*e, "sheenColorFactor", {0, 0, 0}, "sheenColorTexture", {0, 0, 0});
      p.sheen_roughness = alpha_scalar(*e, "sheenRoughnessFactor", 0, "sheenRoughnessTexture", 0);
    }
    if (const Json* e = extension("KHR_materials_iridescence")) read_iridescence(*e);
    if (const Json* e = extension("KHR_materials_anisotropy")) {
      p.anisotropy = scalar(*e, "anisotropyStrength", 0, "anisotropyTexture", 2, 0);
      p.anisotropy_rotation = document_.number(*e, "anisotropyRotation", 0) * 180 / std::numbers::pi;
      if (p.anisotropy != no_index) p.anisotropy_direction = image(*e, "anisotropyTexture", Texels::linear);
    }
  }

  /// The thickness is for rasterizers, which cannot find where a ray leaves; here it only indicates a volume.
  void read_volume(const Json& e) {
    Principled& p = material_.principled;
    p.thin = !(document_.number(e, "thicknessFactor", 0) > 0);
    if (p.thin) return;
    p.attenuation_colour = colour(e, "attenuationColor", white);
    p.attenuation_distance = document_.number(e, "attenuationDistance", std::numeric_limits<double>::infinity());
    if (!(p.attenuation_distance > 0)) document_.fail(e, "\"attenuationDistance\" must be above 0");
    // Light inside the volume must hit the surface from inside too.
    if (p.transmission != no_index || p.diffuse_transmission != no_index) material_.double_sided = true;
  }

  void read_clearcoat(const Json& e) {
    Principled& p = material_.principled;
    p.clearcoat = scalar(e, "clearcoatFactor", 0, "clearcoatTexture", 0, 0);
    p.clearcoat_roughness = scalar(e, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", 1, 0);
    p.clearcoat_normal_map = image(e, "clearcoatNormalTexture", Texels::linear);
    if (const Json* info = document_.object(e, "clearcoatNormalTexture"))
      p.clearcoat_normal_scale = document_.number(*info, "scale", 1);
  }

  void read_iridescence(const Json& e) {
    Principled& p = material_.principled;
    p.iridescence = scalar(e, "iridescenceFactor", 0, "iridescenceTexture", 0, 0);
    p.iridescence_ior = in_range(e, "iridescenceIor", document_.number(e, "iridescenceIor", 1.3), 1, 1e6);
    const double thinnest = document_.number(e, "iridescenceThicknessMinimum", 100);
    const double thickest = document_.number(e, "iridescenceThicknessMaximum", 400);
    const uint32_t amount = textures_.channel(image(e, "iridescenceThicknessTexture", Texels::linear), 1);
    const uint32_t at_1 = textures_.constant(white * thickest);
    p.iridescence_thickness =
        amount == no_index ? at_1 : textures_.mix(textures_.constant(white * thinnest), at_1, amount);
  }

  const Document& document_;
  Textures& textures_;
  const Json& description_;
  bool has_vertex_colours_;
  Material material_;
  MaterialUse use_;
  double alpha_factor_ = 1;
  uint32_t alpha_ = no_index;
};

}  // namespace

const MaterialUse& Materials::use(std::optional<uint32_t> index, bool has_vertex_colours) {
  const auto [entry, is_new] = uses_.try_emplace({index, has_vertex_colours});
  if (is_new) {
    const Json& default_material = empty_object();
    const Json& description = index ? document_.item("materials", *index) : default_material;
    entry->second = MaterialReader(document_, textures_, description, has_vertex_colours).run(scene_);
  }
  return entry->second;
}

}  // namespace alhazen::impl::gltf
