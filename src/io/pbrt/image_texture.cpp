#include "io/pbrt/image_texture.h"

#include <optional>
#include <utility>

#include "images/read_scalar_texture.h"
#include "images/read_texture.h"

namespace alhazen::impl::pbrt {

namespace {

TextureEncoding read_encoding(Build& build, ParameterList& list) {
  const std::string encoding = list.string("encoding", "");
  if (encoding.empty()) return TextureEncoding::automatic;
  if (encoding == "sRGB" || encoding == "srgb") return TextureEncoding::srgb;
  if (encoding == "linear") return TextureEncoding::linear;
  if (!encoding.starts_with("gamma"))
    fail(list.place_of("encoding"), "unknown encoding \"" + encoding + "\"; use sRGB or linear");
  build.warn(list.place_of("encoding"), "the encoding \"" + encoding + "\" is not supported; sRGB is used");
  return TextureEncoding::srgb;
}

WrapMode read_wrap(Build& build, ParameterList& list) {
  const std::string wrap = list.string("wrap", "repeat");
  if (wrap == "repeat") return WrapMode::repeat;
  if (wrap == "black") return WrapMode::black;
  if (wrap == "clamp") return WrapMode::clamp;
  if (wrap != "octahedralsphere")
    fail(list.place_of("wrap"), "unknown wrap mode \"" + wrap + "\"; use repeat, black or clamp");
  build.warn(list.place_of("wrap"), "the wrap mode \"octahedralsphere\" is not supported; clamp is used");
  return WrapMode::clamp;
}

/// All filters but "point" interpolate, and use the image pyramid for minification.
bool read_nearest(ParameterList& list) {
  const std::string filter = list.string("filter", "bilinear");
  if (filter == "point") return true;
  if (filter != "bilinear" && filter != "trilinear" && filter != "ewa" && filter != "EWA")
    fail(list.place_of("filter"), "unknown filter \"" + filter + "\"; use point, bilinear, trilinear or ewa");
  return false;
}

ImageTexels read_scalar(Build& build, ParameterList& list, const InputPath& path, TextureEncoding encoding) {
  ScalarTexture scalar = read_scalar_texture(path, encoding);
  if (scalar.differs_from_pbrt)
    build.warn(list.place_of("filename"),
               "the float texture is the alpha channel of \"" + list.string("filename", "") +
                   "\"; pbrt-v4 reads alpha of EXR, of RGBA in PNG and of QOI alone and takes the mean of the colours "
                   "here: save the image without alpha where they are meant");
  return std::move(scalar.texels);
}

/// Absent if there is no such image.
uint32_t image_index(Build& build, ParameterList& list, TextureEncoding encoding, bool is_float) {
  const std::string name = list.string("filename", "");
  const std::optional<InputPath> found =
      build.existing_image(list.place_of("filename"), name,
                           is_float ? "the float texture is 1 everywhere" : "magenta is shown in its place");
  if (!found) return no_index;
  const InputPath& path = *found;
  const auto [entry, is_new] = build.images_by_key.try_emplace({path.name, static_cast<int>(encoding), is_float}, 0u);
  if (is_new) {
    build.diagnostics.activity().begin("reading textures", build.scene.images.size() + 1);
    ImageTexels image = is_float ? read_scalar(build, list, path, encoding) : read_texture(path, encoding);
    entry->second = static_cast<uint32_t>(build.scene.images.size());
    build.scene.images.push_back(std::move(image));
  }
  return entry->second;
}

}  // namespace

void read_image_texture(Build& build, ParameterList& list, bool is_float, Texture& texture) {
  texture.kind = TextureKind::image;
  texture.wrap = read_wrap(build, list);
  texture.nearest = read_nearest(list);
  texture.image_scale = list.number("scale", 1);
  texture.invert = list.boolean("invert", false);
  list.ignore({"maxanisotropy"});
  texture.image = image_index(build, list, read_encoding(build, list), is_float);
  if (texture.image != no_index) return;
  // Whatever `scale` and `invert` say.
  Texture constant;
  constant.name = texture.name;
  constant.value = is_float ? splat(1.0) : missing_colour;
  texture = std::move(constant);
}

}  // namespace alhazen::impl::pbrt
