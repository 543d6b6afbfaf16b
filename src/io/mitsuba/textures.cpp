#include "io/mitsuba/textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "images/image.h"
#include "images/read_texture.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

/// Replaces colours by their luminance in one channel, of grey bytes nothing.
void make_scalar(ImageTexels& image) {
  const auto texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.channels != 3) return;
  if (!image.bytes.empty()) {
    bool is_grey = true;
    for (size_t i = 0; is_grey && i < texels; ++i)
      is_grey = image.bytes[3 * i] == image.bytes[3 * i + 1] && image.bytes[3 * i] == image.bytes[3 * i + 2];
    if (is_grey) return;
    image.floats.resize(image.bytes.size());
    for (size_t i = 0; i < image.bytes.size(); ++i) {
      const double value = image.bytes[i] / 255.0;
      image.floats[i] = static_cast<float>(image.srgb ? srgb_decode(value) : value);
    }
    std::vector<uint8_t>().swap(image.bytes);
    image.srgb = false;
  }
  for (size_t i = 0; i < texels; ++i) {
    const float* t = &image.floats[3 * i];
    image.floats[i] = static_cast<float>(
        luminance(Vec3d{static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])}));
  }
  image.floats.resize(texels);
  image.floats.shrink_to_fit();
  image.channels = 1;
}

/// Sets (s, t) = matrix * (u, v) of the first two rows of `to_uv`, times `scale`; if `is_image`, t is measured from the
/// bottom, as images are stored from the top with t = 0 there in the format.
void set_mapping(Build& build, const Place& place, const Transform& to_uv, double scale, bool is_image,
                 Texture& texture) {
  const Matrix4& m = to_uv.matrix();
  const double sign = is_image ? -1 : 1;
  const Vec2d across{m[0][0] * scale, sign * m[1][0] * scale}, up{m[0][1] * scale, sign * m[1][1] * scale};
  const double length = std::hypot(across.x, across.y), other = std::hypot(up.x, up.y);
  if (!(length > 0) || !(other > 0)) fail(place, "'to_uv' flattens the texture coordinates");
  const Vec2d axis{across.x / length, across.y / length};
  if (std::abs(axis.x * up.x + axis.y * up.y) > 1e-6 * other)
    build.warn(place, "'to_uv' shears the texture, which is not supported; its axes are made perpendicular");
  texture.uv_scale = {length, axis.x * up.y - axis.y * up.x};
  texture.uv_rotation = std::atan2(axis.y, axis.x) * 180 / std::numbers::pi;
  texture.uv_offset = {m[0][3] * scale, is_image ? 1 - m[1][3] * scale : m[1][3] * scale};
}

uint32_t image_index(Build& build, ObjectReader& reader, bool is_raw, bool is_scalar) {
  if (!reader.has("filename")) fail(reader.place(), reader.name() + " needs <string name=\"filename\" value=\"...\"/>");
  const InputPath path = build.document.existing_file(reader.place_of("filename"), reader.text("filename", ""));
  const auto [entry, is_new] = build.images.try_emplace({path.name, is_raw, is_scalar}, no_index);
  if (is_new) {
    build.diagnostics.activity().begin("reading textures", build.scene.images.size() + 1);
    ImageTexels image = read_texture(path, is_raw ? TextureEncoding::data : TextureEncoding::automatic);
    if (is_scalar) make_scalar(image);
    entry->second = static_cast<uint32_t>(build.scene.images.size());
    build.scene.images.push_back(std::move(image));
  }
  return entry->second;
}

WrapMode read_wrap(ObjectReader& reader) {
  const std::string wrap = reader.text("wrap_mode", "repeat");
  if (wrap == "repeat") return WrapMode::repeat;
  if (wrap == "mirror") return WrapMode::mirror;
  if (wrap == "clamp") return WrapMode::clamp;
  fail(reader.place_of("wrap_mode"), "unknown 'wrap_mode' " + quoted(wrap) + "; use repeat, mirror or clamp");
}

Texture read_bitmap(Build& build, ObjectReader& reader, bool is_scalar) {
  Texture texture;
  texture.kind = TextureKind::image;
  const bool is_raw = reader.boolean("raw", false);
  texture.image = image_index(build, reader, is_raw, is_scalar);
  texture.wrap = read_wrap(reader);
  const std::string filter = reader.text("filter_type", "bilinear");
  if (filter != "bilinear" && filter != "nearest" && filter != "trilinear" && filter != "ewa")
    fail(reader.place_of("filter_type"), "unknown 'filter_type' " + quoted(filter) + "; use bilinear or nearest");
  texture.nearest = filter == "nearest";
  set_mapping(build, reader.place_of("to_uv"), reader.transform("to_uv"), 1, true, texture);
  reader.ignore({"format", "accel", "max_anisotropy", "gamma"});
  return texture;
}

uint32_t texture_of_object(Build& build, uint32_t index, bool is_scalar);

uint32_t input(Build& build, ObjectReader& reader, std::string_view name, bool is_scalar, double fallback) {
  return is_scalar ? scalar_texture(build, reader, name, fallback)
                   : colour_texture(build, reader, name, ColourUse::unbounded, splat(fallback));
}

/// Each check is half a unit wide.
Texture read_checkerboard(Build& build, ObjectReader& reader, bool is_scalar) {
  Texture texture;
  texture.kind = TextureKind::checkerboard;
  texture.inputs[0] = input(build, reader, "color0", is_scalar, 0.4);
  texture.inputs[1] = input(build, reader, "color1", is_scalar, 0.2);
  set_mapping(build, reader.place_of("to_uv"), reader.transform("to_uv"), 2, false, texture);
  return texture;
}

Texture read_mesh_attribute(Build& build, ObjectReader& reader) {
  const std::string name = reader.text("name", "");
  if (name != "vertex_color")
    fail(reader.place_of("name"),
         "the attribute " + quoted(name) + " of meshes is not read; 'vertex_color' is the only one that is");
  Texture texture;
  texture.kind = TextureKind::vertex_colour;
  const double scale = reader.number("scale", 1);
  if (scale == 1) return texture;
  Texture scaled;
  scaled.kind = TextureKind::scale;
  scaled.inputs = {build.add_texture(texture), build.constant_texture(splat(scale)), no_index};
  return scaled;
}

uint32_t texture_of_object(Build& build, uint32_t index, bool is_scalar) {
  const auto [entry, is_new] = build.textures.try_emplace({index, is_scalar}, no_index);
  if (!is_new) return entry->second;
  ObjectReader reader(build.document, index);
  const std::string& type = reader.object().type;
  Texture texture;
  if (type == "bitmap")
    texture = read_bitmap(build, reader, is_scalar);
  else if (type == "checkerboard")
    texture = read_checkerboard(build, reader, is_scalar);
  else if (type == "mesh_attribute")
    texture = read_mesh_attribute(build, reader);
  else
    fail(reader.place(), "textures of type " + quoted(type) +
                             " are not supported; use bitmap, checkerboard, mesh_attribute or a colour");
  reader.reject_unknown();
  texture.name = reader.object().id;
  entry->second = build.add_texture(std::move(texture));
  return entry->second;
}

uint32_t texture_of(Build& build, const Property& property, bool is_scalar, ColourUse use) {
  if (is_constant_colour(build, property)) {
    const Vec3d value = colour_of(build, property, use);
    return build.constant_texture(is_scalar ? splat(luminance(value)) : value);
  }
  if (build.object(property).tag != "texture" && build.object(property).tag != "spectrum")
    fail(property.place, quoted(property.name) + " must be a texture, not a " + build.object(property).tag);
  return texture_of_object(build, property.object, is_scalar);
}

}  // namespace

uint32_t colour_texture(Build& build, ObjectReader& reader, std::string_view name, ColourUse use,
                        const Vec3d& fallback) {
  const Property* property = reader.find(name);
  return property ? texture_of(build, *property, false, use) : build.constant_texture(fallback);
}

uint32_t scalar_texture(Build& build, ObjectReader& reader, std::string_view name, double fallback) {
  const Property* property = reader.find(name);
  return property ? texture_of(build, *property, true, ColourUse::unbounded) : build.constant_texture(splat(fallback));
}

uint32_t nested_texture(Build& build, ObjectReader& reader, bool is_scalar) {
  const std::vector<const Property*> found = reader.objects("texture");
  if (found.empty()) return no_index;
  if (found.size() > 1) fail(found[1]->place, reader.name() + " takes one texture");
  return texture_of(build, *found[0], is_scalar, ColourUse::unbounded);
}

std::optional<Vec3d> constant_value(const Build& build, uint32_t texture) {
  const Texture& node = build.scene.textures[texture];
  if (node.kind != TextureKind::constant) return {};
  return node.value;
}

uint32_t product(Build& build, uint32_t a, uint32_t b) {
  const std::optional<Vec3d> x = constant_value(build, a), y = constant_value(build, b);
  if (x && y) return build.constant_texture(*x * *y);
  if (x && *x == Vec3d{1, 1, 1}) return b;
  if (y && *y == Vec3d{1, 1, 1}) return a;
  Texture texture;
  texture.kind = TextureKind::scale;
  texture.inputs = {a, b, no_index};
  return build.add_texture(texture);
}

}  // namespace alhazen::impl::mitsuba
