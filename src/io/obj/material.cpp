#include "io/obj/material.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "images/read_scalar_texture.h"
#include "images/read_texture.h"
#include "util/quoted.h"

namespace alhazen::impl::obj {

namespace {

constexpr Vec3d white{1, 1, 1};

/// The perceptual roughness whose lobe is about as wide as Blinn and Phong's of that exponent: alpha^2 = 2 / (n + 2).
double roughness_of(double exponent) { return std::pow(2 / (exponent + 2), 0.25); }

/// Illumination models of glass, in which `d` and `Tf` say what passes. Maya writes `illum 4`, `Tf 1 1 1` and `Ni 1`
/// for every opaque material, so that `Tf` counts only with an index of refraction over 1.
bool is_glass(const MtlMaterial& description) {
  const int model = description.illumination;
  if (model != 4 && model != 6 && model != 7 && model != 9) return false;
  return description.opacity.value_or(1) < 1 || (description.transmission_filter && description.ior.value_or(1) > 1);
}

}  // namespace

uint32_t Materials::add_node(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return static_cast<uint32_t>(scene_.textures.size() - 1);
}

uint32_t Materials::constant(const Vec3d& value) {
  Texture texture;
  texture.value = value;
  return add_node(texture);
}

uint32_t Materials::product(uint32_t a, uint32_t b) {
  if (a == no_index || b == no_index) return a == no_index ? b : a;
  Texture texture;
  texture.kind = TextureKind::scale;
  texture.inputs = {a, b, no_index};
  return add_node(texture);
}

uint32_t Materials::replace_missing(const Map& map, const InputPath& path, Texels texels) {
  const std::string problem = "there is no image " + quoted(map.file) + " (looked for " + path.name + ")";
  if (search_.strict) throw InputError(map.where, problem + search_hint(search_));
  const bool is_colour = texels == Texels::colour;
  const std::string instead = is_colour ? ": magenta is shown in its place" : ": the material is rendered without it";
  diagnostics_.warn(map.where, problem + instead + search_hint(search_));
  if (!is_colour) return no_index;
  scene_.images.push_back(missing_image(map.file));
  return static_cast<uint32_t>(scene_.images.size() - 1);
}

uint32_t Materials::load(const Map& map, const FoundFile& found, Texels texels) {
  if (found.problem.is_missing) return replace_missing(map, found.path, texels);
  if (!found.problem.message.empty())
    throw InputError(map.where, "the image " + quoted(map.file) + " " + found.problem.message);
  diagnostics_.activity().begin("reading textures", scene_.images.size() + 1);
  ImageTexels image =
      texels == Texels::scalar
          ? read_scalar_texture(found.path, TextureEncoding::linear).texels
          : read_texture(found.path, texels == Texels::data ? TextureEncoding::data : TextureEncoding::automatic);
  scene_.images.push_back(std::move(image));
  return static_cast<uint32_t>(scene_.images.size() - 1);
}

uint32_t Materials::image(const Map& map, Texels texels) {
  if (map.file.empty()) return no_index;
  const FoundFile found = find_file(folder_, map.file, scope_, search_);
  const auto [entry, is_new] = images_.try_emplace({found.path.name, texels}, no_index);
  if (is_new) entry->second = load(map, found, texels);
  if (entry->second == no_index) return no_index;
  Texture texture;
  texture.kind = TextureKind::image;
  texture.image = entry->second;
  texture.uv_scale = map.scale;
  texture.uv_offset = map.offset;
  texture.wrap = map.is_clamped ? WrapMode::clamp : WrapMode::repeat;
  uint32_t node = add_node(texture);
  if (map.base == 0 && map.gain == 1) return node;
  Texture mix;
  mix.kind = TextureKind::mix;
  mix.inputs = {constant(splat(map.base)), constant(splat(map.base + map.gain)), node};
  return add_node(mix);
}

uint32_t Materials::with_image(const Vec3d& value, const Map& map, Texels texels) {
  const uint32_t node = image(map, texels);
  if (node == no_index) return constant(value);
  return value == white ? node : product(constant(value), node);
}

/// The base and what it reflects: by the extension where it is used, else by the exponent and colour of the highlight.
void Materials::read_surface(const MtlMaterial& d, Material& material) {
  Principled& p = material.principled;
  const Vec3d diffuse = d.diffuse.value_or(d.diffuse_map.file.empty() ? splat(0.8) : white);
  p.base_colour = with_image(diffuse, d.diffuse_map, Texels::colour);
  const bool is_physical = d.roughness || d.metallic || !d.roughness_map.file.empty() || !d.metallic_map.file.empty();
  if (is_physical) {
    p.roughness = with_image(splat(d.roughness.value_or(d.roughness_map.file.empty() ? 0.5 : 1)), d.roughness_map,
                             Texels::scalar);
    p.metallic = with_image(splat(std::min(d.metallic.value_or(d.metallic_map.file.empty() ? 0 : 1), 1.0)),
                            d.metallic_map, Texels::scalar);
  } else {
    p.roughness = constant(splat(roughness_of(d.exponent.value_or(10))));
    const bool is_mirror = (d.illumination == 3 || d.illumination == 5) && max_component(diffuse) == 0;
    if (is_mirror) {
      p.metallic = constant(white);
      p.base_colour = with_image(d.specular.value_or(white), d.specular_map, Texels::colour);
    } else if (d.illumination < 2 || !d.specular) {
      p.specular = constant({});
    } else {
      p.specular_colour = with_image(*d.specular, d.specular_map, Texels::colour);
    }
  }
  const double ior = d.ior.value_or(1.5);
  p.ior = ior > 1 ? ior : 1.5;
  if (d.sheen.value_or(0) > 0) {
    p.sheen_colour = constant(splat(std::min(*d.sheen, 1.0)));
    p.sheen_roughness = constant(splat(0.5));
  }
  if (d.clearcoat.value_or(0) > 0) {
    p.clearcoat = constant(splat(std::min(*d.clearcoat, 1.0)));
    p.clearcoat_roughness = constant(splat(std::min(d.clearcoat_roughness.value_or(0), 1.0)));
  }
  if (d.anisotropy.value_or(0) > 0) {
    p.anisotropy = constant(splat(std::min(*d.anisotropy, 1.0)));
    p.anisotropy_rotation = d.anisotropy_rotation.value_or(0) * 360;
  }
}

void Materials::read_glass(const MtlMaterial& d, Material& material) {
  Principled& p = material.principled;
  p.transmission = constant(splat(d.opacity.value_or(1) < 1 ? 1 - *d.opacity : 1));
  p.thin = false;
  p.base_colour = constant(d.transmission_filter.value_or(white));
  p.specular = p.specular_colour = no_index;
  if (!d.roughness) p.roughness = constant({});
}

void Materials::read_details(const MtlMaterial& d, Material& material) {
  if (!is_glass(d)) {
    const double opacity = std::min(d.opacity.value_or(1), 1.0);
    const uint32_t mask = image(d.opacity_map, Texels::scalar);
    if (mask != no_index || opacity < 1)
      material.alpha = product(mask, opacity < 1 ? constant(splat(opacity)) : no_index);
  }
  material.normal_map = image(d.normal_map, Texels::data);
  if (material.normal_map != no_index) return;
  const uint32_t heights = image(d.bump_map, Texels::scalar);
  if (heights != no_index) material.displacement = product(heights, constant(splat(d.bump_map.bump_multiplier)));
}

MaterialUse Materials::add(const MtlMaterial& description, bool has_vertex_colours) {
  Material material;
  material.name = description.name;
  material.kind = MaterialKind::principled;
  read_surface(description, material);
  if (is_glass(description)) read_glass(description, material);
  if (has_vertex_colours) {
    Texture colours;
    colours.kind = TextureKind::vertex_colour;
    // Without a material the colours are all that there is.
    const uint32_t node = add_node(colours);
    material.principled.base_colour = description.name.empty() ? node : product(material.principled.base_colour, node);
  }
  read_details(description, material);
  MaterialUse use;
  const Vec3d emitted = description.emission.value_or(description.emission_map.file.empty() ? Vec3d{} : white);
  if (max_component(emitted) > 0) {
    use.emission = Emission{emitted, true, image(description.emission_map, Texels::colour)};
    if (!description.emission && use.emission->texture == no_index) use.emission.reset();
  }
  scene_.materials.push_back(std::move(material));
  use.material = static_cast<uint32_t>(scene_.materials.size() - 1);
  return use;
}

}  // namespace alhazen::impl::obj
