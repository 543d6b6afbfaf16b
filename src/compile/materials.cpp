#include "compile/materials.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>

#include "compile/tables/stored_tables.h"
#include "compile/textures.h"
#include "core/materials/lobes/microfacet.h"
#include "scene/mixes.h"

namespace alhazen::impl {

namespace {

bool roughness_differs_by_direction(const Material& material) {
  return material.roughness_u != no_index && material.roughness_v != no_index &&
         material.roughness_u != material.roughness_v;
}

/// Returns the kind of record to which a material is compiled.
MaterialKind compiled_kind(const Material& material) {
  if (material.kind == MaterialKind::conductor && roughness_differs_by_direction(material))
    return MaterialKind::anisotropic_conductor;
  if (material.kind == MaterialKind::dielectric && roughness_differs_by_direction(material))
    return MaterialKind::anisotropic_dielectric;
  return material.kind;
}

/// Returns the absorption coefficient of the volume that the surface bounds, per scene unit.
Vec3d absorption_of(const Material& material) {
  if (material.kind != MaterialKind::principled) return material.absorption;
  const Principled& p = material.principled;
  if (p.thin || p.transmission == no_index || !(p.attenuation_distance > 0)) return {};
  if (std::isinf(p.attenuation_distance)) return {};
  const auto channel = [&](double c) { return -std::log(std::clamp(c, 1e-6, 1.0)) / p.attenuation_distance; };
  return {channel(p.attenuation_colour.x), channel(p.attenuation_colour.y), channel(p.attenuation_colour.z)};
}

/// Returns whether the shading frame must be aligned with the tangents of the surface.
bool follows_tangents(const Material& material) {
  if (material.normal_map != no_index || material.displacement != no_index) return true;
  if (material.kind == MaterialKind::principled)
    return material.principled.anisotropy != no_index || material.principled.clearcoat_normal_map != no_index;
  return roughness_differs_by_direction(material);
}

/// Makes the records of materials. Each kind has an overload of `fill`, which sets the record of that kind.
template <class Real>
class MaterialBuilder {
 public:
  MaterialBuilder(const Scene& scene, CoatModel coats, TextureBuilder<Real>& textures, SceneArrays<Real>& out)
      : scene_(scene), coats_(coats), textures_(textures), out_(out), tables_(out) {}

  /// Adds a material, and returns whether it depends on uv, not counting the materials that it mixes.
  bool add(const Material& material) {
    static_assert(std::is_trivially_copyable_v<MaterialRecord<Real>>);
    depends_on_uv_ = false;
    MaterialRecord<Real> record;
    // The fingerprint of a scene is computed from its bytes, padding included.
    std::memset(static_cast<void*>(&record), 0, sizeof(record));
    record.kind = compiled_kind(material);
    fill_common(material, record);
    switch (record.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    fill(material, record.name); \
    break;
      ALHAZEN_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    }
    out_.materials.push_back(record);
    return depends_on_uv_ || (record.features & MaterialFeatures::tangents) != 0;
  }

 private:
  using Optional = std::optional<double>;

  void fill_common(const Material& material, MaterialRecord<Real>& record) {
    if (material.alpha != no_index || !material.double_sided) record.features |= MaterialFeatures::cutout;
    if (!material.double_sided) record.features |= MaterialFeatures::one_sided;
    if (follows_tangents(material)) record.features |= MaterialFeatures::tangents;
    record.opacity = range(material.alpha);
    record.normal_map = range(material.normal_map);
    record.displacement = range(material.displacement);
    record.normal_scale = static_cast<Real>(material.normal_scale);
    const Vec3d absorption = absorption_of(material);
    record.absorption = convert<Real>(absorption);
    if (!is_finite(record.absorption))
      throw InputError("material '" + material.name + "': the absorption of its volume is not finite");
    if (!is_zero(absorption)) record.features |= MaterialFeatures::absorbs;
  }

  void fill(const Material& material, DiffuseRecord<Real>& record) {
    record.reflectance = range_or(material.reflectance, 0.5);
  }

  void fill(const Material& material, OrenNayarRecord<Real>& record) {
    record.reflectance = range_or(material.reflectance, 0.5);
    record.roughness = range(material.roughness_u);
  }

  void fill(const Material& material, ConductorRecord<Real>& record) {
    record.metal = metal_of(material);
    record.roughness = roughness_of(material);
    record.remap_roughness = material.remap_roughness;
  }

  void fill(const Material& material, AnisotropicConductorRecord<Real>& record) {
    record.metal = metal_of(material);
    record.roughness_u = range(material.roughness_u);
    record.roughness_v = range(material.roughness_v);
    record.remap_roughness = material.remap_roughness;
  }

  void fill(const Material& material, DielectricRecord<Real>& record) {
    record.ior = static_cast<Real>(checked_ior(material, material.ior));
    record.roughness = roughness_of(material);
    record.remap_roughness = material.remap_roughness;
    if (record.ior != 1 && !is_smooth_everywhere(record.roughness, record.remap_roughness))
      record.grid = tables_.grid({.kind = AlbedoGrid::Kind::glass,
                                  .ior = static_cast<double>(record.ior),
                                  .alpha_u = constant_alpha(material, record.roughness)});
  }

  void fill(const Material& material, AnisotropicDielectricRecord<Real>& record) {
    record.ior = static_cast<Real>(checked_ior(material, material.ior));
    record.roughness_u = range(material.roughness_u);
    record.roughness_v = range(material.roughness_v);
    record.remap_roughness = material.remap_roughness;
    if (record.ior != 1)
      record.grid = tables_.grid({.kind = AlbedoGrid::Kind::glass,
                                  .ior = static_cast<double>(record.ior),
                                  .is_anisotropic = true,
                                  .alpha_u = constant_alpha(material, record.roughness_u),
                                  .alpha_v = constant_alpha(material, record.roughness_v)});
  }

  void fill(const Material& material, ThinDielectricRecord<Real>& record) {
    record.ior = static_cast<Real>(checked_ior(material, material.ior));
  }

  void fill(const Material& material, DiffuseTransmissionRecord<Real>& record) {
    record.reflectance = range_or(material.reflectance, 0.25);
    record.transmittance = range_or(material.transmittance, 0.25);
  }

  void fill(const Material& material, MixRecord<Real>& record) {
    record.amount = range_or(material.amount, 0.5);
    for (size_t i = 0; i < 2; ++i) {
      if (material.mixed[i] >= scene_.materials.size())
        throw InputError("material '" + material.name + "': a mix names a material that does not exist");
      record.materials[i] = material.mixed[i];
    }
  }

  void fill(const Material& material, CoatedDiffuseRecord<Real>& record) {
    const double ior = checked_ior(material, material.ior), thickness = thickness_of(material);
    record.reflectance = range_or(material.reflectance, 0.5);
    record.ior = static_cast<Real>(ior);
    record.interface_albedo = tables_.interface(ior);
    record.coat_transmission = tables_.transmission(ior, thickness, !loses_light());
    record.bounces = static_cast<Real>(bounces_of(material));
    fill_roughness(material, record);
    if (!record.is_anisotropic) return;
    record.grid = tables_.grid({.kind = AlbedoGrid::Kind::coat,
                                .ior = ior,
                                .is_anisotropic = true,
                                .alpha_u = constant_alpha(material, record.roughness_u),
                                .alpha_v = constant_alpha(material, record.roughness_v),
                                .thickness = thickness,
                                .conserves = !loses_light()});
  }

  void fill(const Material& material, CoatedConductorRecord<Real>& record) {
    const double ior = checked_ior(material, material.coat_ior);
    record.metal = metal_of(material);
    record.coat_ior = static_cast<Real>(ior);
    record.coat_roughness = range(material.coat_roughness);
    record.coat_albedo = tables_.interface(ior);
    fill_roughness(material, record);
    CoatedMetal coat{ior, constant_alpha(material, record.coat_roughness), constant_alpha(material, record.roughness_u),
                     thickness_of(material), bounces_of(material)};
    if (record.is_anisotropic) {
      // The table is computed for the mean of the alphas, which varies if one of them does.
      const Optional u = coat.metal_alpha, v = constant_alpha(material, record.roughness_v);
      coat.metal_alpha = u && v ? Optional(std::sqrt(*u * *v)) : std::nullopt;
      const auto lobe = [&](const Optional& alpha) {
        return alpha && coat.coat_alpha ? Optional(coated_metal_alpha(*coat.coat_alpha, *alpha, ior)) : std::nullopt;
      };
      record.grid = tables_.grid({.is_anisotropic = true, .alpha_u = lobe(u), .alpha_v = lobe(v)});
      record.mean_grid = tables_.grid({});
    } else {
      record.grid = tables_.grid({});
    }
    record.coat_varies = coat.coat_alpha ? 0 : 1;
    record.metal_varies = coat.metal_alpha ? 0 : 1;
    record.coated_metal = tables_.coated_metal(coat);
  }

  void fill(const Material& material, PrincipledRecord<Real>& record) {
    const Principled& p = material.principled;
    const double ior = checked_ior(material, p.ior);
    record.ior = static_cast<Real>(ior);
    // Thin sheets, and bodies with the index of their surroundings.
    record.thin = p.thin || std::abs(record.ior - 1) < Real(1e-3) ? 1 : 0;
    record.base_colour = range(p.base_colour);
    record.metallic = range(p.metallic);
    record.roughness = range(p.roughness);
    record.specular = range(p.specular);
    record.specular_colour = range(p.specular_colour);
    record.transmission = range(p.transmission);
    record.clearcoat = range(p.clearcoat);
    record.clearcoat_roughness = range(p.clearcoat_roughness);
    record.clearcoat_normal_map = range(p.clearcoat_normal_map);
    record.sheen_colour = range(p.sheen_colour);
    record.sheen_roughness = range(p.sheen_roughness);
    record.iridescence = range(p.iridescence);
    record.iridescence_thickness = range(p.iridescence_thickness);
    record.anisotropy = range(p.anisotropy);
    record.anisotropy_direction = range(p.anisotropy_direction);
    record.diffuse_transmission = range(p.diffuse_transmission);
    record.diffuse_transmission_colour = range(p.diffuse_transmission_colour);
    const double turn = p.anisotropy_rotation * std::numbers::pi / 180;
    record.rotation_cosine = static_cast<Real>(std::cos(turn));
    record.rotation_sine = static_cast<Real>(std::sin(turn));
    record.iridescence_ior = static_cast<Real>(checked_ior(material, p.iridescence_ior));
    record.clearcoat_normal_scale = static_cast<Real>(p.clearcoat_normal_scale);
    record.dispersion = static_cast<Real>(p.dispersion);
    record.coat_albedo = tables_.interface(clearcoat_ior<double>);
    fill_grids(p, ior, record);
  }

  /// Adds the albedo grids of the base, of sheen, and of transmission.
  void fill_grids(const Principled& p, double ior, PrincipledRecord<Real>& record) {
    const Optional roughness = constant_of(p.roughness, 1), anisotropy = constant_of(p.anisotropy, 0);
    // Constant alphas are those that the closure computes, so that the grids hold them exactly.
    const bool is_constant = roughness && anisotropy;
    const Vec2d alpha = is_constant ? principled_alpha(*roughness, *anisotropy) : Vec2d{};
    const auto grid_of = [&](AlbedoGrid::Kind kind, double index, const Vec2d& alphas) {
      AlbedoGrid grid{.kind = kind, .ior = index, .is_anisotropic = anisotropy != 0.0};
      if (is_constant) grid.alpha_u = alphas.x, grid.alpha_v = alphas.y;
      return tables_.grid(grid);
    };
    record.grid = grid_of(AlbedoGrid::Kind::ggx, 1.5, alpha);
    if (p.sheen_colour != no_index) record.sheen_grid = tables_.grid(sheen_grid(p));
    if (p.transmission == no_index) return;
    if (record.thin) {
      record.through_grid = grid_of(AlbedoGrid::Kind::ggx, 1.5, is_constant ? thin_alpha(alpha, ior) : alpha);
      return;
    }
    for (int channel = 0; channel < 3; ++channel) {
      const double index =
          record.dispersion > 0 ? static_cast<double>(dispersed_ior(record.ior, record.dispersion, channel)) : ior;
      record.glass[channel] = grid_of(AlbedoGrid::Kind::glass, index, alpha);
    }
  }

  AlbedoGrid sheen_grid(const Principled& p) {
    AlbedoGrid grid{.kind = AlbedoGrid::Kind::sheen};
    if (const Optional roughness = constant_of(p.sheen_roughness, 0)) grid.alpha_u = sqr(std::max(*roughness, 0.07));
    return grid;
  }

  MetalRecord metal_of(const Material& material) {
    if (material.reflectance != no_index) return {range(material.reflectance), {}, {}};
    if (material.eta == no_index || material.k == no_index)
      throw InputError("material '" + material.name + "': a conductor needs a reflectance, or eta and k");
    return {{}, bounded(range(material.eta)), bounded(range(material.k))};
  }

  /// Clamps a constant index or absorption coefficient so that its fourth power is finite in float; larger values make
  /// no difference.
  TextureRange bounded(TextureRange index) {
    TextureRecord<Real>& record = out_.textures[index.first];
    if (index.count == 1 && record.kind == TextureKind::constant)
      record.parameters = max(min(record.parameters, splat(Real(1e8))), splat(Real(-1e8)));
    return index;
  }

  TextureRange roughness_of(const Material& material) {
    return range(material.roughness_u != no_index ? material.roughness_u : material.roughness_v);
  }

  /// Sets the roughness of a layered kind, which may be anisotropic.
  template <class Record>
  void fill_roughness(const Material& material, Record& record) {
    record.is_anisotropic = roughness_differs_by_direction(material) ? 1 : 0;
    record.remap_roughness = material.remap_roughness;
    record.roughness_u = roughness_of(material);
    if (record.is_anisotropic) record.roughness_v = range(material.roughness_v);
  }

  bool loses_light() const { return coats_ == CoatModel::pbrt; }
  double thickness_of(const Material& material) const {
    return material.thickness_is_given || loses_light() ? material.thickness : 0;
  }
  int bounces_of(const Material& material) const { return loses_light() ? material.coat_bounces : 0; }

  /// Returns the program of a texture, and records whether it depends on uv.
  TextureRange range(uint32_t texture) {
    const TextureRange found = textures_.range(texture);
    depends_on_uv_ = depends_on_uv_ || textures_.depends_on_uv(texture);
    return found;
  }
  TextureRange range_or(uint32_t texture, double fallback) {
    return texture == no_index ? textures_.constant(fallback) : range(texture);
  }

  /// Returns the value of a constant scalar, clamped to [0, 1], or nothing if it varies.
  Optional constant_of(TextureRange scalar) const {
    const TextureRecord<Real>& record = out_.textures[scalar.first];
    if (scalar.count > 1 || record.kind != TextureKind::constant) return std::nullopt;
    return std::clamp(static_cast<double>(record.parameters.x), 0.0, 1.0);
  }
  Optional constant_of(uint32_t texture, double fallback) {
    return texture == no_index ? fallback : constant_of(range(texture));
  }

  /// Returns the alpha of a layer with constant roughness, or nothing if it varies.
  Optional constant_alpha(const Material& material, TextureRange roughness) const {
    if (roughness.count == 0) return min_layered_alpha<double>;
    const Optional value = constant_of(roughness);
    if (!value) return std::nullopt;
    return layered_alpha(alpha_of_roughness(*value, material.remap_roughness));
  }

  bool is_smooth_everywhere(TextureRange roughness, uint32_t remap) const {
    if (roughness.count == 0) return true;
    const Optional value = constant_of(roughness);
    return value && is_smooth(alpha_of_roughness(static_cast<Real>(*value), remap));
  }

  /// Returns the index, clamped to the limits beyond which an interface reflects almost everything. It is rounded to
  /// the precision of the scene, so that tables are computed for the index with which they are looked up.
  static double checked_ior(const Material& material, double ior) {
    if (!(ior > 0) || !std::isfinite(ior))
      throw InputError("material '" + material.name + "': the index of refraction must be above 0");
    return static_cast<double>(static_cast<Real>(std::clamp(ior, min_layered_ior<double>, max_layered_ior<double>)));
  }

  const Scene& scene_;
  CoatModel coats_;
  TextureBuilder<Real>& textures_;
  SceneArrays<Real>& out_;
  StoredTables<Real> tables_;
  bool depends_on_uv_ = false;  ///< of the material being added
};

/// Marks mixes that contain a material that needs uv.
void pass_on_to_mixes(const Scene& scene, std::vector<bool>& needs_uv) {
  uint32_t of_itself = no_index;
  for (const uint32_t mix : order_of_mixes(scene.materials, of_itself))
    for (const uint32_t part : scene.materials[mix].mixed)
      if (part < needs_uv.size() && needs_uv[part]) needs_uv[mix] = true;
}

template <class Real>
std::vector<TextureRange> compile_emission(const Scene& scene, TextureBuilder<Real>& textures) {
  std::vector<TextureRange> emission(scene.textures.size());
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes) {
      if (!shape.emission || shape.emission->texture == no_index) continue;
      if (shape.emission->texture >= emission.size()) throw InputError(shape.where, "the emission names no texture");
      emission[shape.emission->texture] = textures.range(shape.emission->texture);
    }
  return emission;
}

template <class Real>
CompiledMaterials compile(const Scene& scene, CoatModel coats, ImageBuilder<Real>& images, SceneArrays<Real>& out) {
  add_texture_tables(out);
  TextureBuilder<Real> textures(scene, images, out);
  MaterialBuilder<Real> materials(scene, coats, textures, out);
  CompiledMaterials compiled;
  for (const Material& material : scene.materials) compiled.needs_uv.push_back(materials.add(material));
  pass_on_to_mixes(scene, compiled.needs_uv);
  materials.add(Material{});
  compiled.emission = compile_emission(scene, textures);
  compiled.images = images.pyramids();
  compiled.filtered_images = filtered_images(scene);
  compiled.coats = coats;
  for (const Material& material : scene.materials) compiled.names.push_back(material.name);
  return compiled;
}

}  // namespace

template <class Real>
CompiledMaterials compile_materials(Scene& scene, SceneArrays<Real>& out) {
  ImageBuilder<Real> images(scene, out);
  return compile(scene, scene.coats, images, out);
}

template <class Real>
CompiledMaterials compile_materials_again(const Scene& scene, const CompiledMaterials& before, SceneArrays<Real>& out) {
  ImageBuilder<Real> images(before.images, out);
  return compile(scene, before.coats, images, out);
}

template CompiledMaterials compile_materials(Scene&, SceneArrays<float>&);
template CompiledMaterials compile_materials(Scene&, SceneArrays<double>&);
template CompiledMaterials compile_materials_again(const Scene&, const CompiledMaterials&, SceneArrays<float>&);
template CompiledMaterials compile_materials_again(const Scene&, const CompiledMaterials&, SceneArrays<double>&);

}  // namespace alhazen::impl
