#include "pipeline/load_scene.h"

#include <chrono>
#include <utility>

#include "files/file_identity.h"
#include "io/environment.h"
#include "io/read_scene.h"
#include "render/setting_table.h"
#include "render/settings.h"

namespace alhazen::impl {

ReadOptions read_options(const Settings& settings) {
  for (const char* name : {"time", "fps", "shutter"}) check_setting(settings, name);
  ReadOptions options;
  options.camera = settings.camera;
  options.variant = settings.variant;
  options.animation = settings.animation;
  options.time = settings.animation_time;
  options.definitions = settings.definitions;
  options.aspect = aspect_of(settings.width, settings.height);
  options.confine = settings.confine;
  options.search = {settings.search_paths, settings.strict};
  if (settings.shutter) options.shutter_seconds = *settings.shutter / settings.frames_per_second;
  return options;
}

namespace {

/// Before a scene is read, which may take long.
void refuse_checkpoint_of(const std::string& path, const Settings& settings) {
  refuse_same_file({settings.checkpoint, "the checkpoint"}, {{path == standard_input_name ? "" : path, "the scene"},
                                                             {settings.environment, "the environment map"}});
}

/// Replaces what settings replace in a scene.
void adapt(const std::string& path, const Settings& settings, bool turns, LoadedScene& loaded,
           Diagnostics& diagnostics) {
  if (loaded.inputs) loaded.inputs->refuse(settings.checkpoint, "the checkpoint");
  if (!settings.environment.empty()) {
    diagnostics.activity().begin("reading the environment map");
    use_environment(loaded.scene, path_beside(path, settings.environment, settings.confine));
  }
  apply_settings(settings, loaded.scene);
  if (turns)
    loaded.pivot = choose_turning_view(settings, loaded.scene, diagnostics);
  else
    choose_view(settings, loaded.scene, diagnostics);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

LoadedScene load(const std::string& path, const Settings& settings, bool turns, Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  refuse_checkpoint_of(path, settings);
  diagnostics.activity().begin("reading the scene");
  LoadedScene loaded;
  loaded.inputs = std::make_shared<InputRecord>();
  ReadOptions choice = read_options(settings);
  choice.record = loaded.inputs;
  loaded.scene = read_scene(path, choice, diagnostics);
  adapt(path, settings, turns, loaded, diagnostics);
  loaded.seconds = seconds_since(start);
  return loaded;
}

}  // namespace

LoadedScene load_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics) {
  return load(path, settings, false, diagnostics);
}

LoadedScene load_turning_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics) {
  return load(path, settings, true, diagnostics);
}

void refuse_checkpoint(const std::string& path, const InputRecord* inputs, const Settings& settings) {
  refuse_checkpoint_of(path, settings);
  if (inputs) inputs->refuse(settings.checkpoint, "the checkpoint");
}

void adapt_outline(Scene& outline, const Settings& settings, bool reads_maps, Diagnostics& diagnostics) {
  if (!settings.environment.empty()) {
    const InputPath path = path_beside(outline.name, settings.environment, settings.confine);
    if (reads_maps)
      use_environment(outline, path);
    else
      use_environment(outline, ImageTexels{}, path.name);
  }
  apply_settings(settings, outline);
  choose_lights(settings, outline, diagnostics);
}

LoadedScene adapt_scene(Scene&& scene, std::shared_ptr<InputRecord> inputs, const Settings& settings,
                        Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  refuse_checkpoint_of(scene.name, settings);
  LoadedScene loaded;
  loaded.scene = std::move(scene);
  loaded.inputs = std::move(inputs);
  adapt(loaded.scene.name, settings, false, loaded, diagnostics);
  loaded.seconds = seconds_since(start);
  return loaded;
}

}  // namespace alhazen::impl
