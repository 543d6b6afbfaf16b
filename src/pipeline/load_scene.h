#pragma once

// The first step of a render: load_scene, resolve_settings (render/settings.h), render_scene (render/renderer.h),
// write_outputs. The program, the library and studies go through all of them.

#include <memory>
#include <string>

#include "alhazen/alhazen.h"
#include "files/input_record.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen {

struct LoadedScene {
  Scene scene;
  std::shared_ptr<InputRecord> inputs;  ///< every file that was read
  double seconds = 0;
};

/// Reads a scene with what `settings` says about it: camera, variant, time of the animation, environment map, coats,
/// pixel filter, and whether it is confined to its folder. Throws InputError, also if the checkpoint that `settings`
/// names is one of the files that were read.
LoadedScene load_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics);

}  // namespace alhazen
