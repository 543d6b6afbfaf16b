#pragma once

// The camera and the brightness of lights by settings instead of the scene's own.

#include "alhazen/alhazen.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// What a camera that turns about the scene turns about.
struct Pivot {
  Vec3d middle;  ///< of the scene
  Vec3d up;      ///< of unit length
  bool is_left_handed = false;
};

/// Places the camera, and turns and scales the lights as `asked` says; warns of what has no effect. Throws InputError
/// that names the setting.
void choose_view(const Settings& asked, Scene& scene, Diagnostics& diagnostics);

/// The two parts of it. The lights of a scene are chosen once its camera is.
Camera chosen_camera(const Settings& asked, const Scene& scene, const Camera& camera);
void choose_lights(const Settings& asked, Scene& scene, Diagnostics& diagnostics);

/// The same for a camera that will turn about the scene: where it is placed to see the whole scene, it does so in every
/// direction.
Pivot choose_turning_view(const Settings& asked, Scene& scene, Diagnostics& diagnostics);

/// Places another camera of the scene as `asked` says.
Camera placed_camera(const Settings& asked, const Camera& camera, Scene& scene);

/// The camera after a turn by `degrees` about the pivot, to the right of the scene, as the azimuth of --orbit counts.
Camera turned_camera(const Camera& camera, const Pivot& pivot, double degrees);

}  // namespace alhazen::impl
