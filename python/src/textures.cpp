// The values of textures, and their mappings.

#include "alhazen/textures.h"

#include "alhazen/scene.h"
#include "described.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

/// The library says what it refuses: the texture is added to a scene of its own.
void check_texture(const void* data) {
  Texture texture = *static_cast<const Texture*>(data);
  alhazen::Scene scene;
  if (auto* image = std::get_if<ImageTexture>(&texture.node)) {
    constexpr std::array<uint8_t, 1> texel{};
    image->image = scene.add(Pixels{.width = 1, .height = 1, .channels = 1, .bytes = texel});
  }
  scene.add(texture);
}

void check_mapping(const void* data) {
  const Texture texture = CoordinatesTexture{*static_cast<const TextureMapping*>(data)};
  check_texture(&texture);
}

template <class Kind>
void bind_texture(py::module_& m, const char* name, const char* doc, std::vector<Field> fields, size_t positional = 0) {
  fields.push_back(field("name", &Texture::name, "by which scene.textures finds it"));
  bind_value<Kind>(m, {name, doc, positional}, std::move(fields), &check_texture);
}

constexpr const char* space_doc = "from world space to that of the texture";
constexpr const char* mapping_doc = "where its coordinates come from";
constexpr const char* octaves_doc = "number of octaves of noise";
constexpr const char* amplitude_doc = "factor on the amplitude per octave";

void bind_mapping(py::module_& m) {
  bind_value<TextureMapping>(
      m,
      {"Mapping",
       "Where the coordinates (s, t) of a texture come from. Kinds: 'uv' (those of the mesh: (s, t) = scale * (u, v),\n"
       "rotated counter-clockwise, plus offset), 'spherical' (the direction from the origin of texture space),\n"
       "'cylindrical' (the azimuth about its z axis, and z), 'planar' (s = dot(s_axis, p) + offset[0],\n"
       "t = dot(t_axis, p) + offset[1] of the point p in world space).",
       1},
      {field("kind", &TextureMapping::kind, "'uv', 'spherical', 'cylindrical' or 'planar'"),
       field("scale", &TextureMapping::scale, "uv: factors on u and v"),
       field("offset", &TextureMapping::offset, "uv, planar: added to s and t"),
       field("rotation", &TextureMapping::rotation, "uv: degrees, counter-clockwise"),
       field("uv_set", &TextureMapping::uv_set, "uv: 0 for uvs, 1 for second_uvs of the mesh"),
       field("s_axis", &TextureMapping::s_axis, "planar: per scene unit"),
       field("t_axis", &TextureMapping::t_axis, "planar: per scene unit"),
       field("texture_from_world", &TextureMapping::texture_from_world, "spherical, cylindrical: the texture's space")},
      &check_mapping);
}

void bind_images_of(py::module_& m) {
  bind_texture<ImageTexture>(
      m, "ImageTexture",
      "An image over the surface. It is an Image, an array that Image takes, or the name of a file. Images of data, "
      "such\n"
      "as roughness and normals, need Image(file, encoding='linear').",
      {field("image", &ImageTexture::image, "Image, array, SceneImage, or the name of a file"),
       field("mapping", &ImageTexture::mapping, mapping_doc),
       field("wrap", &ImageTexture::wrap, "beyond the image along s: 'repeat', 'black', 'clamp' or 'mirror'"),
       field("wrap_t", &ImageTexture::wrap_t, "the same along t, if different"),
       field("nearest", &ImageTexture::nearest, "the nearest texel instead of interpolation"),
       field("scale", &ImageTexture::scale, "factor on the value"),
       field("invert", &ImageTexture::invert, "1 - value, after the factor")},
      1);
}

void bind_noise(py::module_& m) {
  bind_texture<FbmTexture>(
      m, "FbmTexture", "Perlin noise summed over octaves.",
      {field("octaves", &FbmTexture::octaves, octaves_doc), field("roughness", &FbmTexture::roughness, amplitude_doc),
       field("texture_from_world", &FbmTexture::texture_from_world, space_doc)});
  bind_texture<WrinkledTexture>(m, "WrinkledTexture", "Absolute values of Perlin noise, summed (turbulence).",
                                {field("octaves", &WrinkledTexture::octaves, octaves_doc),
                                 field("roughness", &WrinkledTexture::roughness, amplitude_doc),
                                 field("texture_from_world", &WrinkledTexture::texture_from_world, space_doc)});
  bind_texture<MarbleTexture>(
      m, "MarbleTexture", "Veins that noise displaces.",
      {field("octaves", &MarbleTexture::octaves, octaves_doc),
       field("roughness", &MarbleTexture::roughness, amplitude_doc),
       field("scale", &MarbleTexture::scale, "factor on the point"),
       field("variation", &MarbleTexture::variation, "distance by which noise displaces the veins"),
       field("texture_from_world", &MarbleTexture::texture_from_world, space_doc)});
  bind_texture<WindyTexture>(m, "WindyTexture", "Waves on water under wind, to be used as a displacement.",
                             {field("texture_from_world", &WindyTexture::texture_from_world, space_doc)});
  bind_texture<CellularTexture>(
      m, "CellularTexture", "Cellular noise (Worley): one point in each unit cell of texture space.",
      {field("jitter", &CellularTexture::jitter, "0: points are in the middle of their cells; 1: anywhere in them"),
       field("per_cell", &CellularTexture::per_cell,
             "a random number for each cell instead of the distance to the closest point"),
       field("texture_from_world", &CellularTexture::texture_from_world, space_doc)});
}

void bind_patterns(py::module_& m) {
  bind_texture<CheckerboardTexture>(
      m, "CheckerboardTexture", "Alternates over (s, t), or in space.",
      {field("even", &CheckerboardTexture::even, "of one half of the squares"),
       field("odd", &CheckerboardTexture::odd, "of the other half"),
       field("mapping", &CheckerboardTexture::mapping, mapping_doc),
       field("solid", &CheckerboardTexture::solid, "in space: by the point in texture space"),
       field("texture_from_world", &CheckerboardTexture::texture_from_world, "solid: the texture's space")},
      2);
  bind_texture<DotsTexture>(m, "DotsTexture", "Polka dots, scattered by noise.",
                            {field("inside", &DotsTexture::inside, "of the dots"),
                             field("outside", &DotsTexture::outside, "between the dots"),
                             field("mapping", &DotsTexture::mapping, mapping_doc)});
  bind_texture<DirectionMixTexture>(
      m, "DirectionMixTexture", "Blends by the cosine of the surface's normal and a direction.",
      {field("along", &DirectionMixTexture::along, "where the normal has the direction"),
       field("perpendicular", &DirectionMixTexture::perpendicular, "where it is perpendicular to it"),
       field("direction", &DirectionMixTexture::direction, "world space, of any length but 0")});
}

void bind_operations(py::module_& m) {
  bind_texture<ConstantTexture>(m, "ConstantTexture", "One color.",
                                {field("value", &ConstantTexture::value, "linear sRGB")}, 1);
  bind_texture<ScaleTexture>(
      m, "ScaleTexture", "The product of two inputs.",
      {field("value", &ScaleTexture::value, "one input"), field("factor", &ScaleTexture::factor, "the other")}, 2);
  bind_texture<MixTexture>(
      m, "MixTexture", "Interpolates two inputs.",
      {field("at_0", &MixTexture::at_0, "where amount is 0"), field("at_1", &MixTexture::at_1, "where amount is 1"),
       field("amount", &MixTexture::amount, "0 to 1")});
  bind_texture<ChannelTexture>(m, "ChannelTexture", "One channel of an input in all three, as of a packed image.",
                               {field("input", &ChannelTexture::input, "a color or texture"),
                                field("channel", &ChannelTexture::channel, "0, 1 or 2: red, green, blue")},
                               2);
  bind_texture<ThresholdTexture>(m, "ThresholdTexture", "1 where the input is at least the edge, else 0; by channel.",
                                 {field("input", &ThresholdTexture::input, "a color or texture"),
                                  field("edge", &ThresholdTexture::edge, "the threshold")});
  bind_texture<VertexColourTexture>(m, "VertexColorTexture", "The colors of the mesh's vertices; 1 if it has none.",
                                    {});
  bind_texture<VertexAlphaTexture>(m, "VertexAlphaTexture", "The alpha of the mesh's vertices; 1 if it has none.", {});
  bind_texture<CoordinatesTexture>(m, "CoordinatesTexture", "(s, t, 0) as a color.",
                                   {field("mapping", &CoordinatesTexture::mapping, mapping_doc)});
  m.attr("VertexColourTexture") = m.attr("VertexColorTexture");
}

}  // namespace

TextureMapping FieldType<TextureMapping>::read(const std::string& name, py::handle given) {
  if (!py::isinstance<Described<TextureMapping>>(given)) refuse_given(name, "a Mapping", given);
  return given.cast<const Described<TextureMapping>&>().whole();
}

py::object FieldType<TextureMapping>::show(const TextureMapping& value) {
  return py::cast(Described<TextureMapping>(value).frozen());
}

void bind_textures(py::module_& m) {
  py::class_<Family<Texture>, Value, std::shared_ptr<Family<Texture>>>(
      m, "Texture",
      "The base of all textures: values that vary over a surface. Inputs of materials and of other textures take them\n"
      "in the place of a color or a number; of a number, the red channel counts.");
  bind_mapping(m);
  bind_images_of(m);
  bind_noise(m);
  bind_patterns(m);
  bind_operations(m);
}

std::shared_ptr<Value> texture_value(const std::shared_ptr<PythonScene>& scene, Texture texture) {
  return std::visit(
      [&]<class Kind>(const Kind&) -> std::shared_ptr<Value> { return value_of<Kind>(scene, std::move(texture)); },
      Texture(texture).node);
}

}  // namespace alhazen::python
