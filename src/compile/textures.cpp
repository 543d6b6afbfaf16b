#include "compile/textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/textures/texture.h"

namespace alhazen::impl {

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

}  // namespace

template <class Real>
void add_texture_tables(SceneArrays<Real>& out) {
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    out.srgb_decode_table.push_back(static_cast<Real>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)));
  }
  for (int i = 0; i < 256; ++i) out.srgb_decode_table.push_back(static_cast<Real>(i / 255.0));
  out.noise_permutation.assign(perlin_permutation, perlin_permutation + 256);
}

template <class Real>
TextureBuilder<Real>::TextureBuilder(const Scene& scene, ImageBuilder<Real>& images, SceneArrays<Real>& out)
    : scene_(scene), out_(out), images_(images) {}

template <class Real>
TextureRange TextureBuilder<Real>::range(uint32_t root) {
  if (root == no_index) return {};
  if (root >= scene_.textures.size()) throw InputError("texture index " + std::to_string(root) + " is out of range");
  if (ranges_.empty()) ranges_.resize(scene_.textures.size());
  if (depends_on_uv_.empty()) depends_on_uv_.resize(scene_.textures.size());
  if (nodes_of(root, 0) > max_nodes) throw too_many(scene_.textures[root]);
  TextureRange& known = ranges_[root];
  if (known.count == 0) {
    known.first = static_cast<uint32_t>(out_.textures.size());
    append(root, 0, 0);
    known.count = static_cast<uint32_t>(out_.textures.size()) - known.first;
    depends_on_uv_[root] = std::any_of(out_.textures.begin() + known.first, out_.textures.end(),
                                       [&](const TextureRecord<Real>& node) { return looks_up_uv(node); });
  }
  return known;
}

template <class Real>
TextureRange TextureBuilder<Real>::constant(double value) {
  out_.textures.push_back({TextureKind::constant, 0, 0, 0, splat(static_cast<Real>(value))});
  return {static_cast<uint32_t>(out_.textures.size() - 1), 1};
}

template <class Real>
bool TextureBuilder<Real>::looks_up_uv(const TextureRecord<Real>& node) const {
  const TextureDomain domain = texture_domain(node.kind);
  const bool is_flat = domain == TextureDomain::st || (domain == TextureDomain::st_or_space && node.number == 0);
  return is_flat && out_.texture_mappings[node.mapping].kind == TextureMappingKind::uv;
}

template <class Real>
uint32_t TextureBuilder<Real>::add_mapping(const Texture& texture) {
  const double turn = texture.uv_rotation * std::numbers::pi / 180;
  const double c = texture.uv_rotation == 0 ? 1 : std::cos(turn), r = texture.uv_rotation == 0 ? 0 : std::sin(turn);
  const Vec2d scale = texture.uv_scale, offset = texture.uv_offset;
  const auto real = [](double value) { return static_cast<Real>(value); };
  TextureMapping<Real> mapping{
      {{real(c * scale.x), real(-r * scale.y), real(offset.x)}, {real(r * scale.x), real(c * scale.y), real(offset.y)}},
      texture.mapping,
      texture.uv_set == 1 ? 1u : 0u,
      {}};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      mapping.texture_from_world[i][j] = static_cast<Real>(texture.texture_from_world.matrix()[i][j]);
  const auto [known, is_new] =
      mappings_.try_emplace(std::string(reinterpret_cast<const char*>(&mapping), sizeof mapping),
                            static_cast<uint32_t>(out_.texture_mappings.size()));
  if (is_new) out_.texture_mappings.push_back(mapping);
  return known->second;
}

template <class Real>
InputError TextureBuilder<Real>::too_many(const Texture& texture) const {
  return InputError({scene_.name}, "texture '" + texture.name + "' is made of too many textures within each other");
}

/// How long the program of a texture is, before any of it is written: what is used twice by each of a few dozen
/// textures would fill all memory.
template <class Real>
uint64_t TextureBuilder<Real>::nodes_of(uint32_t index, int nesting) {
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
template <class Real>
void TextureBuilder<Real>::append(uint32_t index, uint32_t waiting, int nesting) {
  if (index >= scene_.textures.size()) throw InputError("a texture refers to one that does not exist");
  const Texture& texture = scene_.textures[index];
  const uint32_t inputs = texture_input_count(texture.kind);
  if (nesting > max_nesting || waiting + std::max(inputs, 1u) > max_texture_stack || out_.textures.size() > max_nodes)
    throw too_many(texture);
  for (uint32_t i = 0; i < inputs; ++i) append(texture.inputs[i], waiting + i, nesting + 1);
  out_.textures.push_back(node_of(texture));
}

/// The last node of a texture's program, which takes the values of its inputs.
template <class Real>
TextureRecord<Real> TextureBuilder<Real>::node_of(const Texture& texture) {
  TextureRecord<Real> node{};
  node.kind = texture.kind;
  if (texture_domain(texture.kind) != TextureDomain::none) node.mapping = add_mapping(texture);
  if (texture.kind == TextureKind::image) node.image = images_.record(texture);
  switch (texture.kind) {
#define ALHAZEN_CASE(name, Name)                                         \
  case TextureKind::name:                                                \
    node.number = static_cast<uint32_t>(Name##Texture::number(texture)); \
    node.parameters = convert<Real>(Name##Texture::parameters(texture)); \
    break;
    ALHAZEN_TEXTURES(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return node;
}

template void add_texture_tables(SceneArrays<float>&);
template void add_texture_tables(SceneArrays<double>&);
template class TextureBuilder<float>;
template class TextureBuilder<double>;

}  // namespace alhazen::impl
