#pragma once

// The first step of a render: load_scene, resolve_settings (render/settings.h), render_scene (render/renderer.h),
// write_outputs. The program, the library and studies go through all of them.

#include <memory>
#include <string>

#include "alhazen/alhazen.h"
#include "files/input_record.h"
#include "io/read_options.h"
#include "pipeline/choose_view.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

struct LoadedScene {
  Scene scene;
  std::shared_ptr<InputRecord> inputs;  ///< every file that was read
  double seconds = 0;
  Pivot pivot;  ///< of a camera that turns
};

/// Reads a scene with what `settings` says about it: camera, variant, time of the animation, environment map, coats,
/// pixel filter, and whether it is confined to its folder. Throws InputError, also if the checkpoint that `settings`
/// names is one of the files that were read.
LoadedScene load_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics);
/// The same for a camera that will turn about the scene.
LoadedScene load_turning_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics);

/// The same for a scene that is in memory. `inputs`, if not null, are the files that it was read from.
LoadedScene adapt_scene(Scene&& scene, std::shared_ptr<InputRecord> inputs, const Settings& settings,
                        Diagnostics& diagnostics);

/// The same for the outline of a scene (scene/outline.h) whose camera has been placed. Maps are read if `reads_maps`.
void adapt_outline(Scene& outline, const Settings& settings, bool reads_maps, Diagnostics& diagnostics);

/// Throws InputError if the checkpoint is the scene's file, or one of those that it was read from. `inputs` may be
/// null.
void refuse_checkpoint(const std::string& path, const InputRecord* inputs, const Settings& settings);

/// What settings select in a file.
ReadOptions read_options(const Settings& settings);

}  // namespace alhazen::impl
