#pragma once

// The materials of OBJ files as those of a scene.

#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "io/find_file.h"
#include "io/obj/mtl.h"
#include "scene/scene.h"

namespace alhazen::impl::obj {

struct MaterialUse {
  uint32_t material = no_index;
  std::optional<Emission> emission;
};

/// Adds materials and their images to a scene.
class Materials {
 public:
  Materials(Scene& scene, std::string folder, InputScope scope, FileSearch search, Diagnostics& diagnostics)
      : scene_(scene),
        folder_(std::move(folder)),
        scope_(std::move(scope)),
        search_(std::move(search)),
        diagnostics_(diagnostics) {}

  /// `has_vertex_colours`: they multiply the base colour.
  MaterialUse add(const MtlMaterial& description, bool has_vertex_colours);

 private:
  enum class Texels { colour, scalar, data };

  uint32_t add_node(Texture texture);
  uint32_t constant(const Vec3d& value);
  uint32_t product(uint32_t a, uint32_t b);
  /// The number of an image that is not there: that of a magenta one for colours, else no_index.
  uint32_t replace_missing(const Map& map, const InputPath& path, Texels texels);
  /// The number of an image that is read for the first time, or of what replaces it.
  uint32_t load(const Map& map, const FoundFile& found, Texels texels);
  /// The texture of an image; no_index if there is none.
  uint32_t image(const Map& map, Texels texels);
  /// `value`, times the image if there is one.
  uint32_t with_image(const Vec3d& value, const Map& map, Texels texels);
  void read_surface(const MtlMaterial& description, Material& material);
  void read_glass(const MtlMaterial& description, Material& material);
  void read_details(const MtlMaterial& description, Material& material);

  Scene& scene_;
  std::string folder_;
  InputScope scope_;
  FileSearch search_;
  Diagnostics& diagnostics_;
  std::map<std::pair<std::string, Texels>, uint32_t> images_;
};

}  // namespace alhazen::impl::obj
