#pragma once

// Light that `path` does not find. It looks for lights without size along straight lines from surfaces that scatter;
// what glass refracts or a mirror reflects on its way to such a surface, a caustic, it would have to meet by chance,
// and what has no size is not met.

#include <optional>
#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// A light of which some is lost, and a surface that it is lost at.
struct LostLight {
  uint32_t light = 0;               ///< index among the lights without size
  uint32_t surface = 0;             ///< index into `surfaces`
  bool is_mirror = false;           ///< of metal; else glass, or what refracts or mirrors as it does
  uint32_t others = 0;              ///< lights that fare likewise
  bool others_may_be_more = false;  ///< there are more lights without size than were looked at
};

/// Whether there are lights without size and surfaces that may be smooth. Asks nothing of trees or rays.
template <class Real>
bool may_lose_light(const SceneView<Real>& view);

/// Follows light from the lights without size to points of the surfaces that are smooth, and on from there, as far as
/// `max_segments` let paths go. What scatters all of it but a small part, as a varnish does, does not count. `view` has
/// the binary tree.
template <class Real>
std::optional<LostLight> find_lost_light(const SceneView<Real>& view, uint32_t max_segments);

/// `where`: the shape that has the surface.
void warn_of_lost_light(const LostLight& lost, const Scene& scene, const SourceLocation& where,
                        Diagnostics& diagnostics);

}  // namespace alhazen
