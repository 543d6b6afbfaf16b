#include "compile/materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>

#include "compile/images.h"
#include "compile/tables/albedo_grids.h"
#include "compile/tables/albedo_tables.h"
#include "compile/tables/coated_metal_tables.h"
#include "core/materials/layer_parameters.h"
#include "core/textures/texture.h"
#include "scene/mixes.h"

namespace alhazen {

namespace {

/// Perlin's permutation of 0 to 255 (Perlin 2002, reference implementation's table).
constexpr uint8_t perlin_permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

template <class Real>
void add_srgb_table(SceneArrays<Real>& out) {
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    out.srgb_decode_table.push_back(static_cast<Real>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)));
  }
  for (int i = 0; i < 256; ++i) out.srgb_decode_table.push_back(static_cast<Real>(i / 255.0));
}

/// The programs of textures, with what they look up.
template <class Real>
class TextureBuilder {
 public:
  TextureBuilder(Scene& scene, SceneArrays<Real>& out) : scene_(scene), out_(out), images_(scene, out) {}

  /// The program of texture `root`; the same range when it is asked for again.
  TextureRange range(uint32_t root) {
    if (root == no_index) return {};
    if (root >= scene_.textures.size()) throw InputError("texture index " + std::to_string(root) + " is out of range");
    if (ranges_.empty()) ranges_.resize(scene_.textures.size());
    if (nodes_of(root, 0) > max_nodes) throw too_many(scene_.textures[root]);
    TextureRange& known = ranges_[root];
    if (known.count == 0) {
      known.first = static_cast<uint32_t>(out_.textures.size());
      append(root, 0, 0);
      known.count = static_cast<uint32_t>(out_.textures.size()) - known.first;
    }
    return known;
  }

  TextureRange constant(double value) {
    out_.textures.push_back({TextureKind::constant, 0, 0, 0, splat(static_cast<Real>(value))});
    return {static_cast<uint32_t>(out_.textures.size() - 1), 1};
  }

 private:
  uint32_t add_mapping(const Texture& texture) {
    const double turn = texture.uv_rotation * std::numbers::pi / 180;
    const double c = texture.uv_rotation == 0 ? 1 : std::cos(turn), r = texture.uv_rotation == 0 ? 0 : std::sin(turn);
    const Vec2d scale = texture.uv_scale, offset = texture.uv_offset;
    const auto real = [](double value) { return static_cast<Real>(value); };
    TextureMapping<Real> mapping{{{real(c * scale.x), real(-r * scale.y), real(offset.x)},
                                  {real(r * scale.x), real(c * scale.y), real(offset.y)}},
                                 texture.mapping,
                                 texture.uv_set == 1 ? 1u : 0u,
                                 {}};
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 4; ++j)
        mapping.texture_from_world[i][j] = static_cast<Real>(texture.texture_from_world.matrix()[i][j]);
    out_.texture_mappings.push_back(mapping);
    return static_cast<uint32_t>(out_.texture_mappings.size() - 1);
  }

  InputError too_many(const Texture& texture) const {
    return InputError({scene_.name}, "texture '" + texture.name + "' is made of too many textures within each other");
  }

  /// How long the program of a texture is, before any of it is written: what is used twice by each of a few dozen
  /// textures would fill all memory.
  uint64_t nodes_of(uint32_t index, int nesting) {
    if (index >= scene_.textures.size()) throw InputError({scene_.name}, "a texture refers to one that does not exist");
    if (nodes_.empty()) nodes_.resize(scene_.textures.size());
    if (nodes_[index] > 0) return nodes_[index];
    const Texture& texture = scene_.textures[index];
    if (nesting > max_nesting) throw too_many(texture);
    uint64_t nodes = 1;
    for (uint32_t i = 0; i < texture_input_count(texture.kind); ++i) nodes += nodes_of(texture.inputs[i], nesting + 1);
    nodes_[index] = std::min(nodes, 2 * max_nodes);
    return nodes_[index];
  }

  /// Appends the program of `index` in postorder; `waiting` values lie on the stack when it starts.
  void append(uint32_t index, uint32_t waiting, int nesting) {
    if (index >= scene_.textures.size()) throw InputError("a texture refers to one that does not exist");
    const Texture& texture = scene_.textures[index];
    const uint32_t inputs = texture_input_count(texture.kind);
    if (nesting > max_nesting || waiting + std::max(inputs, 1u) > max_texture_stack || out_.textures.size() > max_nodes)
      throw too_many(texture);
    for (uint32_t i = 0; i < inputs; ++i) append(texture.inputs[i], waiting + i, nesting + 1);
    TextureRecord<Real> node{texture.kind, 0, 0, static_cast<uint32_t>(std::clamp(texture.octaves, 1, 64)), {}};
    switch (texture.kind) {
      case TextureKind::constant:
        node.parameters = convert<Real>(texture.value);
        break;
      case TextureKind::checkerboard:
        node.mapping = add_mapping(texture);
        node.octaves = texture.solid_checks ? 1 : 0;
        break;
      case TextureKind::image:
        node.mapping = add_mapping(texture);
        node.image = images_.record(texture);
        node.parameters = {static_cast<Real>(texture.image_scale), texture.invert ? Real(1) : Real(0), 0};
        break;
      case TextureKind::fbm:
      case TextureKind::wrinkled:
      case TextureKind::marble:
        node.mapping = add_mapping(texture);
        node.parameters = {static_cast<Real>(texture.roughness), static_cast<Real>(texture.noise_scale),
                           static_cast<Real>(texture.variation)};
        break;
      case TextureKind::channel:
        node.octaves = static_cast<uint32_t>(std::clamp(texture.channel, 0, 2));
        break;
      case TextureKind::coordinates:
      case TextureKind::dots:
      case TextureKind::windy:
        node.mapping = add_mapping(texture);
        break;
      case TextureKind::direction_mix:
        node.parameters = convert<Real>(normalize(texture.direction));
        break;
      case TextureKind::threshold:
        node.parameters = convert<Real>(texture.value);
        break;
      case TextureKind::scale:
      case TextureKind::mix:
      case TextureKind::vertex_colour:
      case TextureKind::vertex_alpha:
        break;
    }
    out_.textures.push_back(node);
  }

  Scene& scene_;
  SceneArrays<Real>& out_;
  static constexpr int max_nesting = 96;
  static constexpr uint64_t max_nodes = uint64_t{1} << 24;
  std::vector<TextureRange> ranges_;
  std::vector<uint64_t> nodes_;  ///< by texture; 0: not known yet
  ImageBuilder<Real> images_;
};

/// The records of materials, and what only layered ones have.
template <class Real>
class MaterialBuilder {
 public:
  MaterialBuilder(const Scene& scene, TextureBuilder<Real>& textures, SceneArrays<Real>& out)
      : scene_(scene), textures_(textures), out_(out) {}

  void add(const Material& material) {
    MaterialRecord<Real> record{};
    record.ior = static_cast<Real>(material.ior);
    record.remap_roughness = material.remap_roughness ? 1 : 0;
    record.roughness = textures_.range(material.roughness_u != no_index ? material.roughness_u : material.roughness_v);
    add_kind(material, record);
    add_features(material, record);
    out_.materials.push_back(record);
  }

 private:
  void add_kind(const Material& material, MaterialRecord<Real>& record) {
    switch (material.type) {
      case MaterialType::diffuse:
        record.kind = MaterialKind::diffuse;
        record.reflectance = range_or(material.reflectance, 0.5);
        break;
      case MaterialType::conductor:
        add_conductor(material, record);
        record.kind = is_anisotropic(material, record) ? MaterialKind::anisotropic_conductor : MaterialKind::conductor;
        break;
      case MaterialType::dielectric:
        record.ior = static_cast<Real>(checked_ior(material, material.ior));
        record.kind =
            is_anisotropic(material, record) ? MaterialKind::anisotropic_dielectric : MaterialKind::dielectric;
        break;
      case MaterialType::thin_dielectric:
        record.ior = static_cast<Real>(checked_ior(material, material.ior));
        record.kind = MaterialKind::thin_dielectric;
        break;
      case MaterialType::diffuse_transmission:
        record.kind = MaterialKind::diffuse_transmission;
        record.reflectance = range_or(material.reflectance, 0.25);
        record.transmittance = range_or(material.transmittance, 0.25);
        break;
      case MaterialType::mix:
        add_mix(material, record);
        break;
      case MaterialType::principled:
      case MaterialType::coated_diffuse:
      case MaterialType::coated_conductor:
        record.kind = MaterialKind::layered;
        add_layers(material, record);
        break;
    }
  }

  void add_conductor(const Material& material, MaterialRecord<Real>& record) {
    record.reflectance = textures_.range(material.reflectance);
    if (material.reflectance != no_index) return;
    if (material.eta == no_index || material.k == no_index)
      throw InputError("material '" + material.name + "': a conductor needs a reflectance, or eta and k");
    record.eta = bounded(textures_.range(material.eta));
    record.k = bounded(textures_.range(material.k));
  }

  /// An index or absorption whose fourth power is a number in float too: beyond that it makes no difference.
  TextureRange bounded(TextureRange range) {
    TextureRecord<Real>& record = out_.textures[range.first];
    if (range.count == 1 && record.kind == TextureKind::constant)
      record.parameters = max(min(record.parameters, splat(Real(1e8))), splat(Real(-1e8)));
    return range;
  }

  bool is_anisotropic(const Material& material, MaterialRecord<Real>& record) {
    if (material.roughness_u == no_index || material.roughness_v == no_index ||
        material.roughness_u == material.roughness_v)
      return false;
    record.roughness_v = textures_.range(material.roughness_v);
    record.features |= MaterialFeatures::tangents;
    return true;
  }

  void add_mix(const Material& material, MaterialRecord<Real>& record) {
    record.kind = MaterialKind::mix;
    record.amount = range_or(material.amount, 0.5);
    for (size_t i = 0; i < 2; ++i) {
      if (material.mixed[i] >= scene_.materials.size())
        throw InputError("material '" + material.name + "': a mix names a material that does not exist");
      record.mixed[i] = material.mixed[i];
    }
  }

  void add_features(const Material& material, MaterialRecord<Real>& record) {
    if (material.alpha != no_index || !material.double_sided) record.features |= MaterialFeatures::cutout;
    if (!material.double_sided) record.features |= MaterialFeatures::one_sided;
    record.opacity = textures_.range(material.alpha);
    record.normal_map = textures_.range(material.normal_map);
    record.displacement = textures_.range(material.displacement);
    record.normal_scale = static_cast<Real>(material.normal_scale);
    if (material.normal_map != no_index || material.displacement != no_index)
      record.features |= MaterialFeatures::tangents;
    const Vec3d absorption = absorption_of(material);
    record.absorption = convert<Real>(absorption);
    if (!is_finite(record.absorption))
      throw InputError("material '" + material.name + "': the absorption of its volume is not finite");
    if (!is_zero(absorption)) record.features |= MaterialFeatures::absorbs;
  }

  /// Per scene unit, of what the surface bounds.
  static Vec3d absorption_of(const Material& material) {
    if (material.type != MaterialType::principled) return material.absorption;
    const Principled& p = material.principled;
    if (p.thin || p.transmission == no_index || !(p.attenuation_distance > 0)) return {};
    if (std::isinf(p.attenuation_distance)) return {};
    const auto channel = [&](double c) { return -std::log(std::clamp(c, 1e-6, 1.0)) / p.attenuation_distance; };
    return {channel(p.attenuation_colour.x), channel(p.attenuation_colour.y), channel(p.attenuation_colour.z)};
  }

  void add_layers(const Material& material, MaterialRecord<Real>& record) {
    LayersRecord<Real> layers{};
    layers.rotation_cosine = 1;
    layers.clearcoat_ior = Real(1.5);
    if (material.type == MaterialType::principled)
      add_principled(material, record, layers);
    else
      add_coat(material, record, layers);
    record.layers = static_cast<uint32_t>(out_.layers.size());
    out_.layers.push_back(layers);
  }

  void add_coat(const Material& material, MaterialRecord<Real>& record, LayersRecord<Real>& layers) {
    layers.is_anisotropic = is_anisotropic(material, record) ? 1 : 0;
    if (material.type == MaterialType::coated_diffuse) return add_coated_diffuse(material, record, layers);
    const double ior = checked_ior(material, material.coat_ior);
    layers.type = LayersType::coated_conductor;
    add_conductor(material, record);
    layers.clearcoat_ior = static_cast<Real>(ior);
    layers.clearcoat_roughness = textures_.range(material.coat_roughness);
    layers.coat_albedo = interface_table(ior);
    add_coated_metal(material, record, layers, ior);
  }

  void add_coated_diffuse(const Material& material, MaterialRecord<Real>& record, LayersRecord<Real>& layers) {
    const double ior = checked_ior(material, material.ior);
    layers.type = LayersType::coated_diffuse;
    record.ior = static_cast<Real>(ior);
    record.reflectance = range_or(material.reflectance, 0.5);
    layers.interface_albedo = interface_table(ior);
    layers.coat_transmission = transmission_table(ior, thickness_of(material), !loses_light());
    layers.bounces = static_cast<Real>(bounces_of(material));
    if (!layers.is_anisotropic) return;
    layers.grid = albedo_grid({.kind = AlbedoGrid::Kind::coat,
                               .ior = ior,
                               .is_anisotropic = true,
                               .alpha_u = constant_alpha(material, record.roughness),
                               .alpha_v = constant_alpha(material, record.roughness_v),
                               .thickness = thickness_of(material),
                               .conserves = !loses_light()});
  }

  void add_coated_metal(const Material& material, const MaterialRecord<Real>& record, LayersRecord<Real>& layers,
                        double ior) {
    CoatedMetal coat{ior, constant_alpha(material, layers.clearcoat_roughness),
                     constant_alpha(material, record.roughness), thickness_of(material), bounces_of(material)};
    // Of an anisotropic one the alphas' mean, which varies where one of them does.
    if (layers.is_anisotropic) {
      const std::optional<double> u = coat.metal_alpha, v = constant_alpha(material, record.roughness_v);
      coat.metal_alpha = u && v ? std::optional(std::sqrt(*u * *v)) : std::nullopt;
      const auto lobe = [&](const std::optional<double>& alpha) {
        return alpha && coat.coat_alpha ? std::optional(coated_metal_alpha(*coat.coat_alpha, *alpha, ior))
                                        : std::nullopt;
      };
      layers.grid = albedo_grid({.is_anisotropic = true, .alpha_u = lobe(u), .alpha_v = lobe(v)});
      layers.through_grid = albedo_grid({});
    } else {
      layers.grid = albedo_grid({});
    }
    layers.coat_varies = coat.coat_alpha ? 0 : 1;
    layers.metal_varies = coat.metal_alpha ? 0 : 1;
    const auto [place, is_new] =
        coated_metal_tables_.try_emplace(coat, static_cast<uint32_t>(out_.albedo_tables.size()));
    if (is_new) append_table(coated_metal_table(coat));
    layers.coated_metal = place->second;
  }

  bool loses_light() const { return scene_.coats == CoatModel::pbrt; }
  double thickness_of(const Material& material) const {
    return material.thickness_is_given || loses_light() ? material.thickness : 0;
  }
  int bounces_of(const Material& material) const { return loses_light() ? material.coat_bounces : 0; }

  /// alpha where the roughness is the same everywhere.
  std::optional<double> constant_alpha(const Material& material, TextureRange roughness) const {
    if (roughness.count == 0) return least_layered_alpha<double>;
    const TextureRecord<Real>& record = out_.textures[roughness.first];
    if (roughness.count > 1 || record.kind != TextureKind::constant) return std::nullopt;
    const double value = std::clamp(static_cast<double>(record.parameters.x), 0.0, 1.0);
    return std::max(material.remap_roughness ? std::sqrt(value) : value, least_layered_alpha<double>);
  }

  void add_principled(const Material& material, MaterialRecord<Real>& record, LayersRecord<Real>& layers) {
    const Principled& p = material.principled;
    const double ior = checked_ior(material, p.ior);
    record.ior = static_cast<Real>(ior);
    record.roughness = textures_.range(p.roughness);
    layers.type = LayersType::principled;
    layers.thin = does_not_refract(p, record.ior) ? 1 : 0;
    layers.base_colour = textures_.range(p.base_colour);
    layers.metallic = textures_.range(p.metallic);
    layers.specular = textures_.range(p.specular);
    layers.specular_colour = textures_.range(p.specular_colour);
    layers.transmission = textures_.range(p.transmission);
    layers.clearcoat = textures_.range(p.clearcoat);
    layers.clearcoat_roughness = textures_.range(p.clearcoat_roughness);
    layers.clearcoat_normal_map = textures_.range(p.clearcoat_normal_map);
    layers.sheen_colour = textures_.range(p.sheen_colour);
    layers.sheen_roughness = textures_.range(p.sheen_roughness);
    layers.iridescence = textures_.range(p.iridescence);
    layers.iridescence_thickness = textures_.range(p.iridescence_thickness);
    layers.anisotropy = textures_.range(p.anisotropy);
    layers.anisotropy_direction = textures_.range(p.anisotropy_direction);
    layers.diffuse_transmission = textures_.range(p.diffuse_transmission);
    layers.diffuse_transmission_colour = textures_.range(p.diffuse_transmission_colour);
    const double turn = p.anisotropy_rotation * std::numbers::pi / 180;
    layers.rotation_cosine = static_cast<Real>(std::cos(turn));
    layers.rotation_sine = static_cast<Real>(std::sin(turn));
    layers.iridescence_ior = static_cast<Real>(checked_ior(material, p.iridescence_ior));
    layers.clearcoat_normal_scale = static_cast<Real>(p.clearcoat_normal_scale);
    layers.dispersion = static_cast<Real>(p.dispersion);
    layers.coat_albedo = interface_table(1.5);
    add_principled_grids(material, ior, layers);
    if (p.anisotropy != no_index || p.clearcoat_normal_map != no_index) record.features |= MaterialFeatures::tangents;
  }

  /// Grids of albedo where the alphas differ, and of the glass of a body.
  void add_principled_grids(const Material& material, double ior, LayersRecord<Real>& layers) {
    const Principled& p = material.principled;
    const std::optional<double> roughness = constant_of(p.roughness, 1), anisotropy = constant_of(p.anisotropy, 0);
    layers.is_anisotropic = anisotropy == 0.0 ? 0 : 1;
    // The alphas at any point are those of the tables, where they are constant.
    const bool is_constant = roughness && anisotropy;
    const Vec2d alpha = is_constant ? principled_alpha(*roughness, *anisotropy) : Vec2d{};
    const auto grid_of = [&](AlbedoGrid::Kind kind, double index, const Vec2d& alphas) {
      AlbedoGrid grid{.kind = kind, .ior = index, .is_anisotropic = layers.is_anisotropic != 0};
      if (is_constant) grid.alpha_u = alphas.x, grid.alpha_v = alphas.y;
      return albedo_grid(grid);
    };
    layers.grid = grid_of(AlbedoGrid::Kind::ggx, 1.5, alpha);
    if (p.sheen_colour != no_index) layers.sheen_grid = albedo_grid(sheen_grid(p));
    if (p.transmission == no_index) return;
    if (layers.thin) {
      layers.through_grid = grid_of(AlbedoGrid::Kind::ggx, 1.5, is_constant ? thin_alpha(alpha, ior) : alpha);
      return;
    }
    for (int channel = 0; channel < 3; ++channel) {
      const double index = layers.dispersion > 0
                               ? static_cast<double>(dispersed_ior(static_cast<Real>(ior), layers.dispersion, channel))
                               : ior;
      layers.glass[channel] = grid_of(AlbedoGrid::Kind::glass, index, alpha);
    }
  }

  AlbedoGrid sheen_grid(const Principled& p) {
    AlbedoGrid grid{.kind = AlbedoGrid::Kind::sheen};
    if (const std::optional<double> roughness = constant_of(p.sheen_roughness, 0))
      grid.alpha_u = sqr(std::max(*roughness, 0.07));
    return grid;
  }

  /// Value of a scalar that is the same everywhere, in its range from 0 to 1.
  std::optional<double> constant_of(uint32_t texture, double fallback) {
    if (texture == no_index) return fallback;
    const TextureRange range = textures_.range(texture);
    const TextureRecord<Real>& record = out_.textures[range.first];
    if (range.count > 1 || record.kind != TextureKind::constant) return std::nullopt;
    return std::clamp(static_cast<double>(record.parameters.x), 0.0, 1.0);
  }

  /// Where a grid stands; the same one for all that ask for it.
  AlbedoGridRecord albedo_grid(const AlbedoGrid& grid) {
    const auto [place, is_new] = albedo_grids_.try_emplace(grid);
    if (is_new) {
      place->second = record_of(grid);
      place->second.first = static_cast<uint32_t>(out_.albedo_tables.size());
      append_table(values_of(grid));
    }
    return place->second;
  }

  void append_table(const Table& table) {
    for (const double value : *table) out_.albedo_tables.push_back(static_cast<Real>(value));
  }

  /// Where the table of an interface stands; one an index.
  uint32_t interface_table(double ior) {
    const auto [place, is_new] = interface_tables_.try_emplace(ior, static_cast<uint32_t>(out_.albedo_tables.size()));
    if (is_new) append_table(interface_albedo_table(ior));
    return place->second;
  }

  /// Where the table of what a coat lets through stands; one a coat.
  uint32_t transmission_table(double ior, double thickness, bool conserves) {
    const auto [place, is_new] =
        transmission_tables_.try_emplace({ior, thickness, conserves}, static_cast<uint32_t>(out_.albedo_tables.size()));
    if (is_new) append_table(coat_transmission_table(ior, thickness, conserves));
    return place->second;
  }

  TextureRange range_or(uint32_t texture, double fallback) {
    return texture == no_index ? textures_.constant(fallback) : textures_.range(texture);
  }

  /// The index, or that from which on more of it makes no difference: an interface reflects everything. It is rounded
  /// to the precision of the scene, so that its tables are those of the index that is met where they are looked up.
  static double checked_ior(const Material& material, double ior) {
    if (!(ior > 0) || !std::isfinite(ior))
      throw InputError("material '" + material.name + "': the index of refraction must be above 0");
    return static_cast<double>(static_cast<Real>(std::clamp(ior, min_layered_ior<double>, max_layered_ior<double>)));
  }

  /// Sheets, and what has the index of its surroundings.
  static bool does_not_refract(const Principled& p, Real ior) { return p.thin || std::abs(ior - 1) < Real(1e-3); }

  const Scene& scene_;
  TextureBuilder<Real>& textures_;
  SceneArrays<Real>& out_;
  std::map<double, uint32_t> interface_tables_;
  std::map<std::tuple<double, double, bool>, uint32_t> transmission_tables_;
  std::map<CoatedMetal, uint32_t> coated_metal_tables_;
  std::map<AlbedoGrid, AlbedoGridRecord> albedo_grids_;
};

/// By texture: whether it, or one that it is made of, looks at uv. Each is visited once, however often it is used.
std::vector<bool> textures_that_need_uv(const Scene& scene) {
  const size_t count = scene.textures.size();
  std::vector<std::vector<uint32_t>> users(count);
  std::vector<bool> needs(count);
  std::vector<uint32_t> pending;
  const auto mark = [&](uint32_t index) {
    if (needs[index]) return;
    needs[index] = true;
    pending.push_back(index);
  };
  for (uint32_t i = 0; i < count; ++i) {
    const Texture& texture = scene.textures[i];
    const bool is_flat = texture.kind == TextureKind::image || texture.kind == TextureKind::coordinates ||
                         texture.kind == TextureKind::dots ||
                         (texture.kind == TextureKind::checkerboard && !texture.solid_checks);
    if (is_flat && texture.mapping == TextureMappingKind::uv) mark(i);
    for (const uint32_t input : texture.inputs)
      if (input < count) users[input].push_back(i);
  }
  while (!pending.empty()) {
    const uint32_t index = pending.back();
    pending.pop_back();
    for (const uint32_t user : users[index]) mark(user);
  }
  return needs;
}

/// Of the material itself, not of what it mixes.
bool looks_at_uv(const Material& material, const std::vector<bool>& textures) {
  const Principled& p = material.principled;
  // What follows the tangents needs the frame of uv itself.
  if (material.normal_map != no_index || material.displacement != no_index || p.anisotropy != no_index ||
      (material.roughness_u != material.roughness_v && material.roughness_u != no_index &&
       material.roughness_v != no_index))
    return true;
  for (const uint32_t texture : {material.reflectance,
                                 material.eta,
                                 material.k,
                                 material.roughness_u,
                                 material.roughness_v,
                                 material.alpha,
                                 material.transmittance,
                                 material.amount,
                                 material.coat_roughness,
                                 p.base_colour,
                                 p.metallic,
                                 p.roughness,
                                 p.specular,
                                 p.specular_colour,
                                 p.transmission,
                                 p.clearcoat,
                                 p.clearcoat_roughness,
                                 p.clearcoat_normal_map,
                                 p.sheen_colour,
                                 p.sheen_roughness,
                                 p.iridescence,
                                 p.iridescence_thickness,
                                 p.diffuse_transmission,
                                 p.diffuse_transmission_colour})
    if (texture < textures.size() && textures[texture]) return true;
  return false;
}

}  // namespace

std::vector<bool> materials_that_need_uv(const Scene& scene) {
  const std::vector<bool> textures = textures_that_need_uv(scene);
  std::vector<bool> needs;
  for (const Material& material : scene.materials) needs.push_back(looks_at_uv(material, textures));
  uint32_t of_itself = no_index;
  for (const uint32_t mix : order_of_mixes(scene.materials, of_itself))
    for (const uint32_t part : scene.materials[mix].mixed)
      if (part < needs.size() && needs[part]) needs[mix] = true;
  return needs;
}

template <class Real>
std::vector<TextureRange> compile_materials(Scene& scene, SceneArrays<Real>& out) {
  add_srgb_table(out);
  out.noise_permutation.assign(perlin_permutation, perlin_permutation + 256);
  TextureBuilder<Real> textures(scene, out);
  MaterialBuilder<Real> materials(scene, textures, out);
  for (const Material& material : scene.materials) materials.add(material);
  materials.add(Material{});
  std::vector<TextureRange> emission(scene.textures.size());
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes) {
      if (!shape.emission || shape.emission->texture == no_index) continue;
      if (shape.emission->texture >= emission.size()) throw InputError(shape.where, "the emission names no texture");
      emission[shape.emission->texture] = textures.range(shape.emission->texture);
    }
  return emission;
}

template std::vector<TextureRange> compile_materials(Scene&, SceneArrays<float>&);
template std::vector<TextureRange> compile_materials(Scene&, SceneArrays<double>&);

}  // namespace alhazen
