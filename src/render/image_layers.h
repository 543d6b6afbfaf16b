#pragma once

// The layers of an image: their names, their channels, and how they are computed from the planes of the film.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "core/film/film_view.h"
#include "render/settings.h"

namespace alhazen::impl {

/// What layers need to know of the scene.
struct LayerScene {
  LayerScene() = default;
  template <class Real>
  explicit LayerScene(const CompiledScene<Real>& scene);

  /// Of the image in render space, unit length: to the right, upward, and forward.
  Vec3d right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
  Vec3d eye{};           ///< position of the camera in render space
  Vec3d world_origin{};  ///< the origin of render space, in world space
  CameraKind kind = CameraKind::perspective;
  /// Cameras that are not of the whole sphere: from render space to the plane at z = 1 (orthographic ones: z = 0) of
  /// camera space, and from there to pixels.
  double camera_from_render[3][4]{};
  double x_scale = 1, x_offset = 0, y_scale = 1, y_offset = 0;
  std::vector<std::string> object_names, material_names;  ///< by id - 1
  std::vector<std::string> light_groups;

  /// Raster position, in pixels, y down, of a point in render space.
  Vec2d project(const Vec3d& point) const;
};

/// A layer as it is stored: the member of AovSet that asks for it, its channels, and the function that computes them.
template <class Real>
struct ImageLayer {
  bool AovSet::*is_wanted;
  std::vector<std::string> channels;
  void (*put)(const FilmView<Real>& film, const LayerScene& scene, size_t pixel, float* values);
  /// If not null, the channels depend on the scene.
  std::vector<std::string> (*channels_of)(const LayerScene& scene) = nullptr;

  std::vector<std::string> channels_in(const LayerScene& scene) const {
    return channels_of ? channels_of(scene) : channels;
  }
};

/// Every layer that a film has, in the order of channels.
template <class Real>
const std::vector<ImageLayer<Real>>& image_layers();

/// Whether a layer needs the names of objects and materials.
bool wants_names(const AovSet& aovs);

/// What the header of an image with these layers says about them: the names of the objects and materials in it.
template <class Real>
std::map<std::string, std::string> layer_metadata(const FilmView<Real>& film, size_t pixels, const AovSet& aovs,
                                                  const LayerScene& scene);

}  // namespace alhazen::impl
