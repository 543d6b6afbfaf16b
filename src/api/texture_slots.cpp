#include "api/texture_slots.h"

#include <algorithm>
#include <utility>

#include "api/slots.h"
#include "core/textures/texture.h"

namespace alhazen::impl {

namespace {

constexpr ValueRange any = ValueRange::any;
constexpr uint32_t mapping_kinds = 4, wrap_modes = 4;

/// Members that are no inputs, of the node that is read.
struct NodeReader {
  const SlotReader& slots;

  void input(const char* name, ColourInput& outside, uint32_t slot) const {
    slots.colour(name, outside, slot, 0.0, any);
  }
  template <class Public, class Internal, class ToPublic, class ToInternal>
  void value(Public& outside, const Internal& inside, const ToPublic& to_public, const ToInternal&) const {
    outside = to_public(inside);
  }
  const SceneState& state;
};

struct NodeWriter {
  SlotWriter& slots;

  /// Inputs are never absent: one that is missing so far is equal to no colour.
  void input(const char* name, const ColourInput& outside, uint32_t& slot) const {
    if (outside.is_texture()) return slots.given_texture(name, outside.texture(), slot);
    const bool is_missing = slot == no_index;
    const Colour& c = outside.colour();
    if (is_missing) {
      for (const double v : {c.r, c.g, c.b}) finite_number(name, v);
      if (slots.writes()) slots.put_constant(slot, vector_of(c));
      return;
    }
    slots.colour(name, outside, slot, Colour(std::numeric_limits<double>::quiet_NaN()), any);
  }
  template <class Public, class Internal, class ToPublic, class ToInternal>
  void value(const Public& outside, Internal& inside, const ToPublic& to_public, const ToInternal& to_internal) const {
    slots.value(outside, inside, to_public, to_internal);
  }
  const SceneState& state;
};

const auto as_it_is = [](const auto& value) { return value; };

template <class Io, class Inside>
void finite(const Io& io, const char* name, double& outside, Inside& inside) {
  io.value(outside, inside, as_it_is, [&](double value) { return finite_number(name, value); });
}

template <class Io, class Inside>
void pair(const Io& io, const char* name, alhazen::Vec2& outside, Inside& inside) {
  io.value(
      outside, inside,
      [](const Vec2d& v) {
        return alhazen::Vec2{v.x, v.y};
      },
      [&](const alhazen::Vec2& v) {
        return Vec2d{finite_number(name, v.x), finite_number(name, v.y)};
      });
}

template <class Io, class Inside>
void colour(const Io& io, const char* name, Colour& outside, Inside& inside) {
  io.value(
      outside, inside, [](const Vec3d& v) { return public_colour(v); },
      [&](const Colour& c) {
        for (const double v : {c.r, c.g, c.b}) finite_number(name, v);
        return vector_of(c);
      });
}

template <class Io, class Inside>
void space(const Io& io, alhazen::Transform& outside, Inside& inside) {
  io.value(
      outside, inside, [](const Transform& t) { return public_transform(t); },
      [](const alhazen::Transform& t) { return affine_transform("texture_from_world", t); });
}

/// The rows of a planar mapping.
struct Plane {
  alhazen::Vec3 s, t;
  alhazen::Vec2 offset;
  friend bool operator==(const Plane&, const Plane&) = default;
};

Plane plane_of(const Transform& transform) {
  const Matrix4& m = transform.matrix();
  return {{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[0][3], m[1][3]}};
}

Transform transform_of_plane(const Plane& plane) {
  const Vec3d s = finite_vector("s_axis", plane.s), t = finite_vector("t_axis", plane.t);
  const Matrix4 rows{{{s.x, s.y, s.z, finite_number("offset", plane.offset.x)},
                      {t.x, t.y, t.z, finite_number("offset", plane.offset.y)},
                      {0, 0, 0, 0},
                      {0, 0, 0, 1}}};
  return Transform(rows, rows);
}

template <class Io, class Inside>
void mapping(const Io& io, alhazen::TextureMapping& outside, Inside& inside) {
  io.value(
      outside.kind, inside.mapping, [](TextureMappingKind kind) { return static_cast<MappingKind>(kind); },
      [](MappingKind kind) { return same_kind<TextureMappingKind>("mapping", kind, mapping_kinds); });
  if (outside.kind == MappingKind::uv) {
    pair(io, "scale", outside.scale, inside.uv_scale);
    pair(io, "offset", outside.offset, inside.uv_offset);
    finite(io, "rotation", outside.rotation, inside.uv_rotation);
    io.value(outside.uv_set, inside.uv_set, as_it_is,
             [](int set) { return static_cast<int>(integer_between("uv_set", set, 0, 1)); });
  } else if (outside.kind == MappingKind::planar) {
    Plane plane{outside.s_axis, outside.t_axis, outside.offset};
    io.value(plane, inside.texture_from_world, plane_of, transform_of_plane);
    outside.s_axis = plane.s, outside.t_axis = plane.t, outside.offset = plane.offset;
  } else {
    space(io, outside.texture_from_world, inside.texture_from_world);
  }
}

template <class Io, class Kind, class Inside>
void noise(const Io& io, Kind& outside, Inside& inside) {
  io.value(outside.octaves, inside.octaves, as_it_is,
           [](int octaves) { return static_cast<int>(integer_between("octaves", octaves, 1, 64)); });
  finite(io, "roughness", outside.roughness, inside.roughness);
  space(io, outside.texture_from_world, inside.texture_from_world);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::ConstantTexture& outside, Inside& inside) {
  colour(io, "value", outside.value, inside.value);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::ImageTexture& outside, Inside& inside) {
  io.value(
      outside.image, inside.image, [&](uint32_t index) { return handle_of<ImageId>(index, io.state.images); },
      [&](ImageId image) { return index_of("image", image, io.state); });
  if constexpr (!std::is_const_v<Inside>) index_of("image", outside.image, io.state);
  mapping(io, outside.mapping, inside);
  const auto wrap = [](WrapMode mode) { return static_cast<alhazen::WrapMode>(mode); };
  const auto checked = [](alhazen::WrapMode mode) { return same_kind<WrapMode>("wrap", mode, wrap_modes); };
  io.value(outside.wrap, inside.wrap, wrap, checked);
  io.value(
      outside.wrap_t, inside.wrap_t,
      [&](const std::optional<WrapMode>& mode) { return mode ? std::optional(wrap(*mode)) : std::nullopt; },
      [&](const std::optional<alhazen::WrapMode>& mode) {
        return mode ? std::optional(checked(*mode)) : std::nullopt;
      });
  io.value(outside.nearest, inside.nearest, as_it_is, as_it_is);
  finite(io, "scale", outside.scale, inside.image_scale);
  io.value(outside.invert, inside.invert, as_it_is, as_it_is);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::CheckerboardTexture& outside, Inside& inside) {
  io.input("even", outside.even, inside.inputs[0]);
  io.input("odd", outside.odd, inside.inputs[1]);
  io.value(outside.solid, inside.solid_checks, as_it_is, as_it_is);
  if (outside.solid)
    space(io, outside.texture_from_world, inside.texture_from_world);
  else
    mapping(io, outside.mapping, inside);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::FbmTexture& outside, Inside& inside) {
  noise(io, outside, inside);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::WrinkledTexture& outside, Inside& inside) {
  noise(io, outside, inside);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::MarbleTexture& outside, Inside& inside) {
  noise(io, outside, inside);
  finite(io, "scale", outside.scale, inside.noise_scale);
  finite(io, "variation", outside.variation, inside.variation);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::WindyTexture& outside, Inside& inside) {
  space(io, outside.texture_from_world, inside.texture_from_world);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::CellularTexture& outside, Inside& inside) {
  struct Cells {
    double jitter;
    bool per_cell;
    bool operator==(const Cells&) const = default;
  };
  Cells cells{outside.jitter, outside.per_cell};
  io.value(
      cells, inside.value,
      [](const Vec3d& v) {
        return Cells{v.x, v.y != 0};
      },
      [](const Cells& c) {
        return Vec3d{number_between("jitter", c.jitter, 0, 1), c.per_cell ? 1.0 : 0.0, 0};
      });
  outside.jitter = cells.jitter, outside.per_cell = cells.per_cell;
  space(io, outside.texture_from_world, inside.texture_from_world);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::ScaleTexture& outside, Inside& inside) {
  io.input("value", outside.value, inside.inputs[0]);
  io.input("factor", outside.factor, inside.inputs[1]);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::MixTexture& outside, Inside& inside) {
  io.input("at_0", outside.at_0, inside.inputs[0]);
  io.input("at_1", outside.at_1, inside.inputs[1]);
  io.input("amount", outside.amount, inside.inputs[2]);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::ChannelTexture& outside, Inside& inside) {
  io.input("input", outside.input, inside.inputs[0]);
  io.value(outside.channel, inside.channel, as_it_is,
           [](int channel) { return static_cast<int>(integer_between("channel", channel, 0, 2)); });
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::ThresholdTexture& outside, Inside& inside) {
  io.input("input", outside.input, inside.inputs[0]);
  colour(io, "edge", outside.edge, inside.value);
}

template <class Io, class Inside>
void describe(const Io&, alhazen::VertexColourTexture&, Inside&) {}

template <class Io, class Inside>
void describe(const Io&, alhazen::VertexAlphaTexture&, Inside&) {}

template <class Io, class Inside>
void describe(const Io& io, alhazen::CoordinatesTexture& outside, Inside& inside) {
  mapping(io, outside.mapping, inside);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::DotsTexture& outside, Inside& inside) {
  io.input("inside", outside.inside, inside.inputs[0]);
  io.input("outside", outside.outside, inside.inputs[1]);
  mapping(io, outside.mapping, inside);
}

template <class Io, class Inside>
void describe(const Io& io, alhazen::DirectionMixTexture& outside, Inside& inside) {
  io.input("along", outside.along, inside.inputs[0]);
  io.input("perpendicular", outside.perpendicular, inside.inputs[1]);
  io.value(
      outside.direction, inside.direction, [](const Vec3d& v) { return public_vector(v); },
      [](const alhazen::Vec3& v) { return direction_vector("direction", v); });
}

constexpr TextureKind kinds[] = {TextureKind::constant,      TextureKind::image,        TextureKind::checkerboard,
                                 TextureKind::fbm,           TextureKind::wrinkled,     TextureKind::marble,
                                 TextureKind::windy,         TextureKind::cellular,     TextureKind::scale,
                                 TextureKind::mix,           TextureKind::channel,      TextureKind::threshold,
                                 TextureKind::vertex_colour, TextureKind::vertex_alpha, TextureKind::coordinates,
                                 TextureKind::dots,          TextureKind::direction_mix};
static_assert(std::size(kinds) == std::variant_size_v<alhazen::TextureNode>);

template <size_t index = 0>
alhazen::TextureNode node_of(TextureKind kind) {
  if constexpr (index + 1 == std::size(kinds))
    return alhazen::TextureNode(std::in_place_index<index>);
  else
    return kinds[index] == kind ? alhazen::TextureNode(std::in_place_index<index>) : node_of<index + 1>(kind);
}

/// How deep the inputs of a texture are nested, and how many values wait while it is evaluated.
struct Nesting {
  uint32_t levels = 1, stack = 1;
  uint64_t nodes = 1;
};

constexpr uint32_t max_levels = 64;
constexpr uint64_t max_nodes = uint64_t{1} << 20;

/// Throws if `root`, whose node is to be `node`, would contain itself, or too much.
class NestingCheck {
 public:
  NestingCheck(const Scene& scene, uint32_t root, const Texture& node) : scene_(scene), root_(root), node_(node) {
    known_.resize(scene.textures.size());
  }
  Nesting of_root() { return of(node_, 1); }

 private:
  Nesting of(const Texture& texture, uint32_t level) {
    if (level > max_levels) refuse_argument("texture", "has too many textures nested within each other");
    const uint32_t inputs = texture_input_count(texture.kind);
    Nesting sum{1, std::max(inputs, 1u), 1};
    for (uint32_t i = 0; i < inputs; ++i) {
      const uint32_t input = texture.inputs[i];
      if (input >= known_.size()) continue;  // a constant that is not made yet
      if (input == root_) refuse_argument("texture", "would be an input of itself");
      if (known_[input].nodes == 0) known_[input] = of(scene_.textures[input], level + 1);
      const Nesting& part = known_[input];
      sum.levels = std::max(sum.levels, part.levels + 1);
      sum.stack = std::max(sum.stack, part.stack + i);
      sum.nodes = std::min(sum.nodes + part.nodes, 2 * max_nodes);
    }
    if (sum.levels > max_levels || sum.stack > max_texture_stack || sum.nodes > max_nodes)
      refuse_argument("texture", "has too many textures nested within each other");
    return sum;
  }

  struct Known : Nesting {
    Known() { nodes = 0; }
    Known& operator=(const Nesting& nesting) {
      static_cast<Nesting&>(*this) = nesting;
      return *this;
    }
  };
  const Scene& scene_;
  uint32_t root_;
  const Texture& node_;
  std::vector<Known> known_;
};

}  // namespace

alhazen::Texture public_texture(const SceneState& state, const Texture& texture) {
  const SlotReader slots(state);
  alhazen::Texture result;
  result.node = node_of(texture.kind);
  result.name = texture.name;
  const NodeReader io{slots, state};
  std::visit([&](auto& kind) { describe(io, kind, texture); }, result.node);
  return result;
}

void write_texture(SceneState& state, alhazen::Texture given, uint32_t index, Texture& texture) {
  const TextureKind kind = kinds[given.node.index()];
  const bool is_of_kind = texture.kind == kind;
  Texture trial;
  if (is_of_kind) trial = texture;
  trial.kind = kind;
  trial.name = given.name;
  const auto describe_with = [&](SlotWriter& slots, Texture& target) {
    const NodeWriter io{slots, state};
    std::visit([&](auto& node) { describe(io, node, target); }, given.node);
  };
  SlotWriter check(state, false);
  describe_with(check, trial);
  // The inputs that are textures already, so that a texture within itself is found before it is made.
  Texture linked = trial;
  const auto link = [&](size_t i, const ColourInput& input) {
    if (input.is_texture()) linked.inputs[i] = HandleAccess::index(input.texture());
  };
  std::visit(
      [&](const auto& node) {
        using Node = std::remove_cvref_t<decltype(node)>;
        if constexpr (requires { node.even; }) link(0, node.even), link(1, node.odd);
        if constexpr (std::is_same_v<Node, alhazen::ScaleTexture>) link(0, node.value), link(1, node.factor);
        if constexpr (requires { node.at_0; }) link(0, node.at_0), link(1, node.at_1), link(2, node.amount);
        if constexpr (requires { node.input; }) link(0, node.input);
        if constexpr (requires { node.inside; }) link(0, node.inside), link(1, node.outside);
        if constexpr (requires { node.along; }) link(0, node.along), link(1, node.perpendicular);
      },
      given.node);
  NestingCheck(state.description, index, linked).of_root();
  SlotWriter write(state, true);
  // Constants that are added may move the textures.
  if (!is_of_kind)
    for (uint32_t& input : texture.inputs) write.release(input);
  describe_with(write, trial);
  if (index < state.description.textures.size())
    state.description.textures[index] = std::move(trial);
  else
    texture = std::move(trial);
}

}  // namespace alhazen::impl
