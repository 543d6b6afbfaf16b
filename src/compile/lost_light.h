#pragma once

// Detects light that `path` does not find. Lights without area are found by shadow rays alone, so `path` misses the
// caustics that they cast by refraction in glass or reflection in mirrors.

#include <optional>
#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// A light of which some is lost, and a surface at which it is lost.
struct LostLight {
  uint32_t light = 0;               ///< index among the delta lights
  uint32_t surface = 0;             ///< index into `surfaces`
  bool is_mirror = false;           ///< metal; else glass or other materials that refract or reflect
  uint32_t others = 0;              ///< number of other lights to which the same happens
  bool others_may_be_more = false;  ///< there are more delta lights than were tested
};

/// Returns whether there are delta lights and surfaces that may be smooth. Uses neither trees nor rays.
template <class Real>
bool may_lose_light(const SceneView<Real>& view);

/// Follows light from the delta lights to points of smooth surfaces, and on from there for as long as paths of
/// `max_segments` allow, and from points of other surfaces straight through glass to the lights. Materials that scatter
/// almost all light diffusely, such as varnish, are ignored. `view` needs the binary tree.
template <class Real>
std::optional<LostLight> find_lost_light(const SceneView<Real>& view, uint32_t max_segments);

/// `where`: the location of the shape that has the surface.
void warn_of_lost_light(const LostLight& lost, const Scene& scene, const SourceLocation& where,
                        Diagnostics& diagnostics);

}  // namespace alhazen::impl
