#pragma once

// Environment maps and images of lights whose texels and distributions are in the arrays already, so that other values
// of their lights need only other records.

#include <optional>
#include <vector>

#include "core/scene_view.h"

namespace alhazen::impl {

template <class Real>
struct LightMaps {
  struct Environment {
    EnvironmentRecord<Real> record;  ///< without what the light says of it
    Vec3d mean_radiance;
    double excess;  ///< what add_environment returns
  };

  std::vector<std::optional<Environment>> environments;       ///< by index into Scene::environments
  std::vector<std::optional<LightImageRecord<Real>>> images;  ///< by index into Scene::light_images, likewise
};

}  // namespace alhazen::impl
