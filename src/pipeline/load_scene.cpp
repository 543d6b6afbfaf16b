#include "pipeline/load_scene.h"

#include <chrono>

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

LoadedScene load(const std::string& path, const Settings& settings, bool turns, Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  // Before the scene is read, which may take long.
  refuse_same_file({settings.checkpoint, "the checkpoint"}, {{path == standard_input_name ? "" : path, "the scene"},
                                                             {settings.environment, "the environment map"}});
  diagnostics.activity().begin("reading the scene");
  LoadedScene loaded;
  loaded.inputs = std::make_shared<InputRecord>();
  ReadOptions choice = read_options(settings);
  choice.record = loaded.inputs;
  loaded.scene = read_scene(path, choice, diagnostics);
  loaded.inputs->refuse(settings.checkpoint, "the checkpoint");
  if (!settings.environment.empty()) {
    diagnostics.activity().begin("reading the environment map");
    use_environment(loaded.scene, path_beside(path, settings.environment, settings.confine));
  }
  apply_settings(settings, loaded.scene);
  if (turns)
    loaded.pivot = choose_turning_view(settings, loaded.scene, diagnostics);
  else
    choose_view(settings, loaded.scene, diagnostics);
  loaded.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return loaded;
}

}  // namespace

LoadedScene load_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics) {
  return load(path, settings, false, diagnostics);
}

LoadedScene load_turning_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics) {
  return load(path, settings, true, diagnostics);
}

}  // namespace alhazen::impl
