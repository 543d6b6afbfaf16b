#include "io/pbrt/textures.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/textures/texture.h"
#include "io/pbrt/image_texture.h"
#include "io/pbrt/suggestions.h"

namespace alhazen::impl::pbrt {

namespace {

constexpr uint32_t max_texture_levels = 64;
constexpr uint64_t max_texture_nodes = uint64_t{1} << 20;

/// A texture node being read, and whether its values are scalars or colours.
struct TextureRequest {
  Build& build;
  ParameterList& list;
  bool is_float;

  uint32_t input(std::string_view name, double fallback) const {
    return is_float ? scalar_texture_or(build, list, name, fallback)
                    : colour_texture_or(build, list, name, ColourUse::unbounded, fallback);
  }
};

/// The first two rows of a planar mapping are the vectors of s and t.
Transform planar_mapping(ParameterList& list, const Transform& texture_from_world) {
  const Vec3d v1 = list.point("v1", {1, 0, 0}), v2 = list.point("v2", {0, 1, 0});
  Matrix4 rows = texture_from_world.matrix();
  const Matrix4 old = rows;
  for (size_t j = 0; j < 4; ++j) {
    rows[0][j] = v1.x * old[0][j] + v1.y * old[1][j] + v1.z * old[2][j];
    rows[1][j] = v2.x * old[0][j] + v2.y * old[1][j] + v2.z * old[2][j];
    rows[2][j] = 0;
  }
  rows[0][3] += list.number("udelta", 0);
  rows[1][3] += list.number("vdelta", 0);
  return Transform(rows, rows);
}

/// Reads pbrt-v4's 2D mappings. Each uses only its own parameters.
void read_mapping(const TextureRequest& request, Texture& texture) {
  ParameterList& list = request.list;
  const std::string mapping = list.string("mapping", "uv");
  texture.texture_from_world = request.build.state.ctm_start.inverse();
  if (mapping == "spherical") {
    texture.mapping = TextureMappingKind::spherical;
  } else if (mapping == "cylindrical") {
    texture.mapping = TextureMappingKind::cylindrical;
  } else if (mapping == "planar") {
    texture.mapping = TextureMappingKind::planar;
    texture.texture_from_world = planar_mapping(list, texture.texture_from_world);
  } else if (mapping == "uv") {
    texture.uv_scale = {list.number("uscale", 1), list.number("vscale", 1)};
    texture.uv_offset = {list.number("udelta", 0), list.number("vdelta", 0)};
  } else {
    fail(list.place_of("mapping"),
         "unknown texture mapping \"" + mapping + "\"; use uv, spherical, cylindrical or planar");
  }
  list.ignore({"v1", "v2", "uscale", "vscale", "udelta", "vdelta"});
}

void read_world_mapping(const TextureRequest& request, Texture& texture) {
  texture.texture_from_world = request.build.state.ctm_start.inverse();
}

void read_noise(const TextureRequest& request, Texture& texture) {
  read_world_mapping(request, texture);
  texture.octaves = request.list.integer("octaves", 8);
  texture.roughness = request.list.number("roughness", 0.5);
  if (texture.octaves < 1 || texture.octaves > 64)
    fail(request.list.place_of("octaves"), "\"octaves\" must be from 1 to 64");
}

void read_constant(const TextureRequest& request, Texture& texture) {
  texture.value = request.is_float ? splat(request.list.number("value", 1))
                                   : colour(request.build, request.list, "value", ColourUse::unbounded, {1, 1, 1});
}

void read_scale(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::scale;
  texture.inputs[0] = request.input("tex", 1);
  texture.inputs[1] = scalar_texture_or(request.build, request.list, "scale", 1);
}

void read_mix(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::mix;
  texture.inputs[0] = request.input("tex1", 0);
  texture.inputs[1] = request.input("tex2", 1);
  texture.inputs[2] = scalar_texture_or(request.build, request.list, "amount", 0.5);
}

void read_checkerboard(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::checkerboard;
  const int dimension = request.list.integer("dimension", 2);
  if (dimension != 2 && dimension != 3)
    fail(request.list.place_of("dimension"), "\"dimension\" of a checkerboard must be 2 or 3");
  texture.solid_checks = dimension == 3;
  if (texture.solid_checks)
    read_world_mapping(request, texture);
  else
    read_mapping(request, texture);
  texture.inputs[0] = request.input("tex1", 1);
  texture.inputs[1] = request.input("tex2", 0);
}

void read_fbm(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::fbm;
  read_noise(request, texture);
}

void read_wrinkled(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::wrinkled;
  read_noise(request, texture);
}

void read_marble(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::marble;
  read_noise(request, texture);
  texture.noise_scale = request.list.number("scale", 1);
  texture.variation = request.list.number("variation", 0.2);
}

void read_image(const TextureRequest& request, Texture& texture) {
  read_mapping(request, texture);
  read_image_texture(request.build, request.list, request.is_float, texture);
}

uint32_t add_node(Build& build, Texture texture) {
  build.scene.textures.push_back(std::move(texture));
  return static_cast<uint32_t>(build.scene.textures.size() - 1);
}

uint32_t add_mix(Build& build, uint32_t at_0, uint32_t at_1, uint32_t amount) {
  Texture mix;
  mix.kind = TextureKind::mix;
  mix.inputs = {at_0, at_1, amount};
  return add_node(build, mix);
}

/// Builds bilinear interpolation from mixes of mixes, over the coordinates of the mapping.
void read_bilerp(const TextureRequest& request, Texture& texture) {
  Build& build = request.build;
  Texture coordinates;
  coordinates.kind = TextureKind::coordinates;
  read_mapping(request, coordinates);
  const uint32_t st = add_node(build, coordinates);
  Texture channel;
  channel.kind = TextureKind::channel;
  channel.inputs[0] = st;
  const uint32_t s = add_node(build, channel);
  channel.channel = 1;
  const uint32_t t = add_node(build, channel);
  const uint32_t v00 = request.input("v00", 0), v01 = request.input("v01", 1);
  const uint32_t v10 = request.input("v10", 0), v11 = request.input("v11", 1);
  texture.kind = TextureKind::mix;
  texture.inputs = {add_mix(build, v00, v10, s), add_mix(build, v01, v11, s), t};
}

void read_direction_mix(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::direction_mix;
  texture.inputs[0] = request.input("tex1", 0);
  texture.inputs[1] = request.input("tex2", 1);
  const Vec3d direction = request.build.state.ctm_start.direction(request.list.point("dir", {0, 1, 0}));
  if (!(length_squared(direction) > 0) || !is_finite(direction))
    fail(request.list.place_of("dir"), "\"dir\" must have a length above 0");
  texture.direction = normalize(direction);
}

void read_dots(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::dots;
  read_mapping(request, texture);
  texture.inputs[0] = request.input("inside", 1);
  texture.inputs[1] = request.input("outside", 0);
}

void read_windy(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::windy;
  read_world_mapping(request, texture);
}

/// Cellular noise, which pbrt does not have.
void read_cellular(const TextureRequest& request, Texture& texture) {
  texture.kind = TextureKind::cellular;
  read_world_mapping(request, texture);
  const double jitter = request.list.number("jitter", 1);
  if (!(jitter >= 0 && jitter <= 1)) fail(request.list.place_of("jitter"), "\"jitter\" must be from 0 to 1");
  const std::string value = request.list.string("value", "distance");
  if (value != "distance" && value != "cell")
    fail(request.list.place_of("value"), "unknown \"value\" \"" + value + "\"; use distance or cell");
  texture.value = {jitter, value == "cell" ? 1.0 : 0.0, 0};
}

void read_ptex(const TextureRequest& request, Texture&) {
  fail(request.list.place(), "textures of kind \"ptex\" are not supported; use an \"imagemap\" over uv instead");
}

using TextureReader = void (*)(const TextureRequest&, Texture&);
const std::map<std::string, TextureReader> texture_readers{{"constant", read_constant},
                                                           {"scale", read_scale},
                                                           {"mix", read_mix},
                                                           {"imagemap", read_image},
                                                           {"checkerboard", read_checkerboard},
                                                           {"fbm", read_fbm},
                                                           {"wrinkled", read_wrinkled},
                                                           {"marble", read_marble},
                                                           {"bilerp", read_bilerp},
                                                           {"dots", read_dots},
                                                           {"directionmix", read_direction_mix},
                                                           {"windy", read_windy},
                                                           {"cellular", read_cellular},
                                                           {"ptex", read_ptex}};

std::vector<std::string> names_of(const std::map<std::string, uint32_t>& textures) {
  std::vector<std::string> names;
  for (const auto& [name, index] : textures) names.push_back(name);
  return names;
}

uint32_t find_texture(const Build& build, const Parameter& parameter, bool is_float) {
  const auto& names = std::get<Strings>(parameter.values);
  if (names.size() != 1) fail(parameter.place, "\"" + parameter.name + "\" takes one texture");
  const auto& wanted = is_float ? build.float_textures : build.spectrum_textures;
  const auto& others = is_float ? build.spectrum_textures : build.float_textures;
  if (const auto found = wanted.find(names[0]); found != wanted.end()) return found->second;
  if (others.contains(names[0]))
    fail(parameter.place, "\"" + parameter.name + "\" takes a " + (is_float ? "float" : "spectrum") +
                              " texture, but \"" + names[0] + "\" is a " + (is_float ? "spectrum" : "float") +
                              " texture");
  fail(parameter.place,
       "texture \"" + names[0] + "\" is not defined before this" + suggestion(names[0], names_of(wanted)));
}

/// Updates the sizes; the inputs of a texture precede it.
void measure_textures(Build& build) {
  std::vector<TextureSize>& sizes = build.texture_sizes;
  for (size_t i = sizes.size(); i < build.scene.textures.size(); ++i) {
    const Texture& texture = build.scene.textures[i];
    const uint32_t inputs = texture_input_count(texture.kind);
    TextureSize size{1, std::max(inputs, 1u), 1};
    for (uint32_t input = 0; input < inputs; ++input) {
      const TextureSize& part = sizes.at(texture.inputs[input]);
      size.levels = std::max(size.levels, part.levels + 1);
      size.stack = std::max(size.stack, part.stack + input);
      size.nodes = std::min(size.nodes + part.nodes, 2 * max_texture_nodes);
    }
    sizes.push_back(size);
  }
}

/// Refuses a texture that could not be evaluated, where it is defined.
void check_size_of_last(Build& build, const Place& place) {
  measure_textures(build);
  const TextureSize& size = build.texture_sizes.back();
  if (size.levels > max_texture_levels || size.stack > max_texture_stack || size.nodes > max_texture_nodes)
    fail(place, "texture \"" + build.scene.textures.back().name +
                    "\" has too many textures nested within each other; use fewer levels of scale and mix");
}

}  // namespace

void add_texture(Build& build, const std::string& name, const std::string& value_type, const std::string& kind,
                 ParameterList& list) {
  if (value_type != "float" && value_type != "spectrum")
    fail(list.place(), "texture \"" + name + "\": unknown type \"" + value_type + "\"" +
                           or_upgrade(value_type, "; use float or spectrum"));
  const bool is_float = value_type == "float";
  auto& textures = is_float ? build.float_textures : build.spectrum_textures;
  if (textures.contains(name))
    fail(list.place(), "the " + value_type + " texture \"" + name + "\" is defined twice; rename one");
  const auto reader = texture_readers.find(kind);
  if (reader == texture_readers.end()) {
    std::vector<std::string> kinds;
    for (const auto& [known, function] : texture_readers) kinds.push_back(known);
    fail(list.place(), "unknown texture \"" + kind + "\"" + suggestion(kind, kinds));
  }
  Texture texture;
  texture.name = name;
  reader->second({build, list, is_float}, texture);
  list.reject_unknown();
  textures[name] = static_cast<uint32_t>(build.scene.textures.size());
  build.scene.textures.push_back(std::move(texture));
  check_size_of_last(build, list.place());
}

uint32_t colour_texture(Build& build, ParameterList& list, std::string_view name, ColourUse use) {
  const Parameter* parameter = list.find(name, {ParameterType::rgb, ParameterType::spectrum, ParameterType::texture,
                                                ParameterType::xyz, ParameterType::blackbody});
  if (!parameter) return no_index;
  if (parameter->type == ParameterType::texture) return find_texture(build, *parameter, false);
  return build.constant_texture(colour_of(build, *parameter, use));
}

uint32_t colour_texture_or(Build& build, ParameterList& list, std::string_view name, ColourUse use, double fallback) {
  const uint32_t texture = colour_texture(build, list, name, use);
  return texture == no_index ? build.constant_texture(splat(fallback)) : texture;
}

uint32_t scalar_texture(Build& build, ParameterList& list, std::string_view name) {
  const Parameter* parameter = list.find(name, {ParameterType::number, ParameterType::texture});
  if (!parameter) return no_index;
  if (parameter->type == ParameterType::texture) return find_texture(build, *parameter, true);
  return build.constant_texture(splat(list.number(name, 0)));
}

uint32_t scalar_texture_or(Build& build, ParameterList& list, std::string_view name, double fallback) {
  const uint32_t texture = scalar_texture(build, list, name);
  return texture == no_index ? build.constant_texture(splat(fallback)) : texture;
}

std::optional<double> constant_value(const Build& build, uint32_t texture) {
  const Texture& node = build.scene.textures[texture];
  if (node.kind != TextureKind::constant) return {};
  return node.value.x;
}

}  // namespace alhazen::impl::pbrt
