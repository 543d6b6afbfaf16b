#pragma once

// Textures of the document as nodes of the scene description.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "io/gltf/buffers.h"
#include "scene/scene.h"

namespace alhazen::impl::gltf {

/// The data that are used of an image.
enum class Texels { srgb, linear, alpha };

/// The sets of texture coordinates of a mesh: uvs are TEXCOORD_(first), second_uvs TEXCOORD_(second).
using UvSets = std::array<int, 2>;

class Textures {
 public:
  Textures(const Document& document, Buffers& buffers, Scene& scene)
      : document_(document), buffers_(buffers), scene_(scene) {}

  uint32_t constant(const Vec3d& value);
  /// a * b; absent ones count as 1.
  uint32_t product(uint32_t a, uint32_t b);
  /// `value` times a texture; absent if both are 1.
  uint32_t scaled(const Vec3d& value, uint32_t texture);
  uint32_t channel(uint32_t texture, int channel);
  uint32_t mix(uint32_t at_0, uint32_t at_1, uint32_t amount);
  uint32_t threshold(uint32_t texture, double value);
  uint32_t node(TextureKind kind);
  Texture& at(uint32_t index) const { return scene_.textures[index]; }

  /// The image of the member `key` of `object`, a textureInfo; absent if there is no such member, and for `alpha` if
  /// the image is opaque.
  uint32_t image(const Json& object, const char* key, Texels texels, const UvSets& uv_sets);

 private:
  uint32_t add(Texture&& texture);
  uint32_t scene_image(const Json& texture, Texels texels);
  uint32_t load(uint32_t source, Texels texels);
  uint32_t replace_missing(const Json& at, const std::string& file, Texels texels);
  std::optional<ImageTexels> decode(const Json& image, const std::string& name, std::span<const uint8_t> bytes,
                                    Texels texels) const;
  void set_sampler(const Json& texture, Texture& node) const;
  void set_mapping(const Json& info, const UvSets& uv_sets, Texture& node) const;

  const Document& document_;
  Buffers& buffers_;
  Scene& scene_;
  std::map<std::tuple<uint32_t, Texels>, uint32_t> images_;
};

/// The set of texture coordinates that a textureInfo uses.
int texture_coordinate_set(const Document& document, const Json& info);

}  // namespace alhazen::impl::gltf
