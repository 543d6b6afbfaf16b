#pragma once

// Textures: values that vary over a surface. Each kind is a struct whose members have the defaults of pbrt.

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "alhazen/alternative.h"
#include "alhazen/geometry.h"
#include "alhazen/handles.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// A colour that is the same everywhere, or a texture. A handle that names nothing is a texture too: functions that get
/// it throw InputError.
class ColourInput {
 public:
  constexpr ColourInput(const Colour& colour) : colour_(colour) {}  // NOLINT: either is an input
  constexpr ColourInput(double grey) : colour_(grey) {}             // NOLINT
  constexpr ColourInput(double r, double g, double b) : colour_(r, g, b) {}
  constexpr ColourInput(TextureId texture) : texture_(texture), is_texture_(true) {}  // NOLINT

  constexpr bool is_texture() const { return is_texture_; }
  constexpr const Colour& colour() const { return colour_; }  ///< black if it is a texture
  constexpr TextureId texture() const { return texture_; }    ///< none if it is a colour
  friend constexpr bool operator==(const ColourInput&, const ColourInput&) = default;

 private:
  Colour colour_;
  TextureId texture_;
  bool is_texture_ = false;
};

/// A number that is the same everywhere, or a texture, of which it is the red channel or all three where they are
/// equal.
class NumberInput {
 public:
  constexpr NumberInput(double number) : number_(number) {}                           // NOLINT: either is an input
  constexpr NumberInput(TextureId texture) : texture_(texture), is_texture_(true) {}  // NOLINT

  constexpr bool is_texture() const { return is_texture_; }
  constexpr double number() const { return number_; }       ///< 0 if it is a texture
  constexpr TextureId texture() const { return texture_; }  ///< none if it is a number
  friend constexpr bool operator==(const NumberInput&, const NumberInput&) = default;

 private:
  double number_ = 0;
  TextureId texture_;
  bool is_texture_ = false;
};

enum class MappingKind {
  uv,           ///< the uvs of the mesh
  spherical,    ///< the direction from the origin of texture space
  cylindrical,  ///< the azimuth about the z axis of texture space, and z
  planar,       ///< s_axis and t_axis
};

/// Where the coordinates (s, t) of a texture come from.
struct TextureMapping {
  MappingKind kind = MappingKind::uv;
  /// uv: (s, t) = scale * (u, v), rotated counter-clockwise, plus offset.
  Vec2 scale{1, 1};
  Vec2 offset{};        ///< uv, planar
  double rotation = 0;  ///< uv: degrees
  int uv_set = 0;       ///< uv: 0 for MeshArrays::uvs, 1 for second_uvs
  /// planar: s = dot(s_axis, p) + offset.x and t = dot(t_axis, p) + offset.y of the point p in world space.
  Vec3 s_axis{1, 0, 0}, t_axis{0, 1, 0};
  Transform texture_from_world{};  ///< spherical, cylindrical
};

enum class WrapMode { repeat, black, clamp, mirror };

struct ConstantTexture {
  Colour value{1};
};

struct ImageTexture {
  ImageId image{};
  TextureMapping mapping{};
  WrapMode wrap = WrapMode::repeat;  ///< along s
  std::optional<WrapMode> wrap_t{};  ///< along t, if different
  bool nearest = false;              ///< the nearest texel instead of interpolation
  double scale = 1;                  ///< factor on the value
  bool invert = false;               ///< 1 - value, after the factor
};

/// Alternates over (s, t), or in space.
struct CheckerboardTexture {
  ColourInput even = 1, odd = 0;
  TextureMapping mapping{};
  bool solid = false;              ///< in space: by the point in texture space
  Transform texture_from_world{};  ///< solid
};

/// Perlin noise summed over octaves.
struct FbmTexture {
  int octaves = 8;
  double roughness = 0.5;  ///< factor on the amplitude per octave
  Transform texture_from_world{};
};

/// The same of absolute values (turbulence).
struct WrinkledTexture {
  int octaves = 8;
  double roughness = 0.5;
  Transform texture_from_world{};
};

struct MarbleTexture {
  int octaves = 8;
  double roughness = 0.5;
  double scale = 1;        ///< factor on the point
  double variation = 0.2;  ///< distance by which noise displaces the veins
  Transform texture_from_world{};
};

/// Waves on water under wind, to be used as a displacement.
struct WindyTexture {
  Transform texture_from_world{};
};

/// Cellular noise (Worley): one point in each unit cell of texture space.
struct CellularTexture {
  double jitter = 1;      ///< 0: the points are in the middle of their cells; 1: anywhere in them
  bool per_cell = false;  ///< a random number for each cell instead of the distance to the closest point
  Transform texture_from_world{};
};

struct ScaleTexture {
  ColourInput value = 1, factor = 1;
};

struct MixTexture {
  ColourInput at_0 = 0, at_1 = 1, amount = 0.5;
};

/// One channel of another texture in all three, such as the green of a packed image.
struct ChannelTexture {
  ColourInput input = 1;
  int channel = 0;  ///< 0, 1 or 2
};

/// 1 where a texture is at least the edge, else 0; by channel.
struct ThresholdTexture {
  ColourInput input = 1;
  Colour edge{0.5};
};

struct VertexColourTexture {};  ///< the colours of the mesh's vertices; 1 if it has none
struct VertexAlphaTexture {};   ///< their alpha

/// (s, t, 0)
struct CoordinatesTexture {
  TextureMapping mapping{};
};

/// Polka dots, scattered by noise.
struct DotsTexture {
  ColourInput inside = 1, outside = 0;
  TextureMapping mapping{};
};

/// Blends by the cosine of the surface's normal and a direction.
struct DirectionMixTexture {
  ColourInput along = 0, perpendicular = 1;
  Vec3 direction{0, 1, 0};  ///< world space, of any length but 0
};

using TextureNode =
    std::variant<ConstantTexture, ImageTexture, CheckerboardTexture, FbmTexture, WrinkledTexture, MarbleTexture,
                 WindyTexture, CellularTexture, ScaleTexture, MixTexture, ChannelTexture, ThresholdTexture,
                 VertexColourTexture, VertexAlphaTexture, CoordinatesTexture, DotsTexture, DirectionMixTexture>;

/// A texture of any kind: `Texture checks = CheckerboardTexture{.even = 0.8, .odd = 0.1};`
struct Texture {
  TextureNode node;
  std::string name;

  Texture() = default;
  template <AlternativeOf<TextureNode> Kind>
  Texture(Kind&& kind, std::string its_name = {})  // NOLINT: each kind is a texture
      : node(std::forward<Kind>(kind)), name(std::move(its_name)) {}
};

}  // namespace ALHAZEN_NAMESPACE
