#pragma once

// The part of compiling that turns textures into programs over their nodes.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compile/images.h"
#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Adds what every evaluation of textures may look up: the decoding of sRGB and the permutation of noise.
template <class Real>
void add_texture_tables(SceneArrays<Real>& out);

/// The programs of textures, with the mappings and images that they look up.
template <class Real>
class TextureBuilder {
 public:
  TextureBuilder(const Scene& scene, ImageBuilder<Real>& images, SceneArrays<Real>& out);

  /// The program of texture `root`; the same range when it is asked for again. Absent for `no_index`.
  TextureRange range(uint32_t root);

  TextureRange constant(double value);

  /// Whether the value of a texture whose range was asked for depends on the uv of the surface.
  bool depends_on_uv(uint32_t root) const { return root != no_index && depends_on_uv_[root]; }

 private:
  uint32_t add_mapping(const Texture& texture);
  InputError too_many(const Texture& texture) const;
  uint64_t nodes_of(uint32_t index, int nesting);
  void append(uint32_t index, uint32_t waiting, int nesting);
  TextureRecord<Real> node_of(const Texture& texture);
  bool looks_up_uv(const TextureRecord<Real>& node) const;

  static constexpr int max_nesting = 96;
  static constexpr uint64_t max_nodes = uint64_t{1} << 24;

  const Scene& scene_;
  SceneArrays<Real>& out_;
  std::vector<TextureRange> ranges_;          ///< by texture; count 0: not built yet
  std::vector<bool> depends_on_uv_;           ///< by texture
  std::vector<uint64_t> nodes_;               ///< by texture; 0: not known yet
  std::map<std::string, uint32_t> mappings_;  ///< by the bytes of their records, so that equal ones are one
  ImageBuilder<Real>& images_;
};

}  // namespace alhazen::impl
