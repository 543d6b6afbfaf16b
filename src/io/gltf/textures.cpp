#include "io/gltf/textures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "images/codecs/decoders.h"
#include "io/gltf/uri.h"

namespace alhazen::impl::gltf {

namespace {

bool starts_with(std::span<const uint8_t> bytes, std::string_view head) {
  return bytes.size() >= head.size() && std::memcmp(bytes.data(), head.data(), head.size()) == 0;
}

const char* unread_format(std::span<const uint8_t> bytes) {
  if (starts_with(bytes, "\xabKTX 20")) return "KTX2";
  if (starts_with(bytes, "DDS ")) return "DDS";
  if (bytes.size() > 12 && std::memcmp(bytes.data() + 4, "ftypavif", 8) == 0) return "AVIF";
  return nullptr;
}

WrapMode wrap_mode(const Document& document, const Json& sampler, const char* key) {
  switch (document.whole(sampler, key).value_or(10497)) {
    case 10497:
      return WrapMode::repeat;
    case 33071:
      return WrapMode::clamp;
    case 33648:
      return WrapMode::mirror;
    default:
      document.fail(sampler, std::string("unknown wrap mode in \"") + key +
                                 "\": it may be 10497 (repeat), 33071 (clamp) or 33648 (mirror)");
  }
}

}  // namespace

uint32_t Textures::add(Texture&& texture) {
  scene_.textures.push_back(std::move(texture));
  return static_cast<uint32_t>(scene_.textures.size() - 1);
}

uint32_t Textures::node(TextureKind kind) {
  Texture texture;
  texture.kind = kind;
  return add(std::move(texture));
}

uint32_t Textures::constant(const Vec3d& value) {
  Texture texture;
  texture.value = value;
  return add(std::move(texture));
}

uint32_t Textures::product(uint32_t a, uint32_t b) {
  if (a == no_index) return b;
  if (b == no_index) return a;
  Texture texture;
  texture.kind = TextureKind::scale;
  texture.inputs = {a, b, no_index};
  return add(std::move(texture));
}

uint32_t Textures::scaled(const Vec3d& value, uint32_t texture) {
  return value == Vec3d{1, 1, 1} ? texture : product(constant(value), texture);
}

uint32_t Textures::channel(uint32_t texture, int channel) {
  if (texture == no_index) return no_index;
  Texture node;
  node.kind = TextureKind::channel;
  node.inputs[0] = texture;
  node.channel = channel;
  return add(std::move(node));
}

uint32_t Textures::mix(uint32_t at_0, uint32_t at_1, uint32_t amount) {
  Texture node;
  node.kind = TextureKind::mix;
  node.inputs = {at_0, at_1, amount};
  return add(std::move(node));
}

uint32_t Textures::threshold(uint32_t texture, double value) {
  Texture node;
  node.kind = TextureKind::threshold;
  node.inputs[0] = texture;
  node.value = {value, value, value};
  return add(std::move(node));
}

int texture_coordinate_set(const Document& document, const Json& info) {
  uint64_t set = document.whole(info, "texCoord").value_or(0);
  if (const Json* transform = document.extension(info, "KHR_texture_transform"))
    set = document.whole(*transform, "texCoord").value_or(set);
  return static_cast<int>(std::min<uint64_t>(set, 1000));
}

uint32_t Textures::image(const Json& object, const char* key, Texels texels, const UvSets& uv_sets) {
  const Json* info = document_.object(object, key);
  if (info == nullptr) return no_index;
  const Json& texture = document_.item("textures", document_.required_index(*info, "index", "textures"));
  Texture node;
  node.kind = TextureKind::image;
  node.image = scene_image(texture, texels);
  if (node.image == no_index) return no_index;
  node.name = document_.string(texture, "name");
  set_sampler(texture, node);
  set_mapping(*info, uv_sets, node);
  return add(std::move(node));
}

void Textures::set_sampler(const Json& texture, Texture& node) const {
  const std::optional<uint32_t> index = document_.index(texture, "sampler", "samplers");
  if (!index) return;
  const Json& sampler = document_.item("samplers", *index);
  node.wrap = wrap_mode(document_, sampler, "wrapS");
  const WrapMode wrap_t = wrap_mode(document_, sampler, "wrapT");
  if (wrap_t != node.wrap) node.wrap_t = wrap_t;
  const uint64_t filter = document_.whole(sampler, "magFilter").value_or(9729);
  if (filter != 9728 && filter != 9729)
    document_.fail(sampler, "unknown \"magFilter\": it may be 9728 (nearest) or 9729 (linear)");
  node.nearest = filter == 9728;
}

/// KHR_texture_transform applies to coordinates whose v points down the image:
///   u' = c su u + s sv v + ou,  v' = -s su u + c sv v + ov  with c, s cosine and sine of the rotation.
/// Here t = 1 - v' is a function of (u, 1 - v).
void Textures::set_mapping(const Json& info, const UvSets& uv_sets, Texture& node) const {
  node.uv_set = texture_coordinate_set(document_, info) == uv_sets[1] ? 1 : 0;
  const Json* transform = document_.extension(info, "KHR_texture_transform");
  if (transform == nullptr) return;
  const std::vector<double> offset = document_.numbers(*transform, "offset", 2);
  const std::vector<double> scale = document_.numbers(*transform, "scale", 2);
  const double rotation = document_.number(*transform, "rotation", 0);
  const double s = std::sin(rotation), c = std::cos(rotation);
  if (!scale.empty()) node.uv_scale = {scale[0], scale[1]};
  const Vec2d o = offset.empty() ? Vec2d{} : Vec2d{offset[0], offset[1]};
  node.uv_rotation = rotation * 180 / std::numbers::pi;
  node.uv_offset = {o.x + s * node.uv_scale.y, 1 - c * node.uv_scale.y - o.y};
}

uint32_t Textures::scene_image(const Json& texture, Texels texels) {
  if (const auto source = document_.index(texture, "source", "images")) return load(*source, texels);
  if (const Json* webp = document_.extension(texture, "EXT_texture_webp"))
    return load(document_.required_index(*webp, "source", "images"), texels);
  for (const char* name : {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"})
    if (document_.extension(texture, name) != nullptr)
      document_.fail(texture,
                     std::string("the texture has its image by the extension ") + name +
                         " alone, which is not supported: convert it to PNG or JPEG, or add one as \"source\"");
  document_.warn(texture, "a texture has no \"source\"; it counts as white");
  return no_index;
}

/// Returns nothing for the alpha of an opaque image.
std::optional<ImageTexels> Textures::decode(const Json& image, const std::string& name, std::span<const uint8_t> bytes,
                                            Texels texels) const {
  const bool is_png = starts_with(bytes, "\x89PNG\r\n\x1a\n");
  const bool is_webp = starts_with(bytes, "RIFF") && bytes.size() >= 12 && starts_with(bytes.subspan(8), "WEBP");
  const bool is_jpeg = starts_with(bytes, "\xff\xd8\xff");
  if (!is_png && !is_webp && !is_jpeg) {
    const char* format = unread_format(bytes);
    document_.fail(image, format != nullptr
                              ? std::string("images in ") + format + " are not supported: convert it to PNG or JPEG"
                              : std::string("the image is neither PNG nor JPEG nor WebP"));
  }
  if (texels == Texels::alpha) {
    if (is_jpeg) return std::nullopt;
    return is_png ? decode_png_alpha(name, bytes) : decode_webp_alpha(name, bytes);
  }
  if (is_png) return decode_png(name, bytes, texels == Texels::srgb);
  return is_webp ? decode_webp(name, bytes) : decode_jpeg(name, bytes);
}

/// What counts instead of an image that is nowhere: magenta for colours, else as if there were no texture.
uint32_t Textures::replace_missing(const Json& at, const std::string& file, Texels texels) {
  const std::string problem = "there is no image " + file;
  if (document_.search().strict) document_.fail(at, problem + search_hint(document_.search()));
  document_.warn(at, problem +
                         ": magenta is shown in place of its colours, and values other than colours count as if "
                         "there were no texture" +
                         search_hint(document_.search()));
  if (texels != Texels::srgb) return no_index;
  scene_.images.push_back(missing_image(file));
  return static_cast<uint32_t>(scene_.images.size() - 1);
}

uint32_t Textures::load(uint32_t source, Texels texels) {
  const auto [entry, is_new] = images_.try_emplace({source, texels}, no_index);
  if (!is_new) return entry->second;
  const Json& image = document_.item("images", source);
  document_.diagnostics().activity().begin("reading textures", scene_.images.size() + 1);
  Resource resource;
  std::span<const uint8_t> bytes;
  if (const Json* uri = image.find("uri")) {
    std::optional<Resource> found = find_uri(document_, *uri);
    if (!found) return entry->second = replace_missing(*uri, "'" + uri->string + "'", texels);
    resource = std::move(*found);
    bytes = resource.bytes;
  } else {
    const uint32_t view = document_.required_index(image, "bufferView", "bufferViews");
    if (buffers_.has_no_data(view))
      return entry->second = replace_missing(image, "number " + std::to_string(source), texels);
    bytes = buffers_.view(view).bytes;
  }
  std::string name = document_.place(image).to_string() + ": image " + std::to_string(source);
  if (image.find("uri") != nullptr && resource.name != "a data URI") name = resource.name;
  std::optional<ImageTexels> decoded = decode(image, name, bytes, texels);
  if (!decoded) return no_index;
  decoded->srgb = !decoded->bytes.empty() && texels == Texels::srgb;
  scene_.images.push_back(std::move(*decoded));
  entry->second = static_cast<uint32_t>(scene_.images.size() - 1);
  return entry->second;
}

}  // namespace alhazen::impl::gltf
