#include "pipeline/load_scene.h"

#include <chrono>

#include "files/file_identity.h"
#include "io/environment.h"
#include "io/read_scene.h"
#include "pipeline/choose_view.h"
#include "render/settings.h"

namespace alhazen {

LoadedScene load_scene(const std::string& path, const Settings& settings, Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  // Before the scene is read, which may take long.
  refuse_same_file({settings.checkpoint, "the checkpoint"},
                   {{path, "the scene"}, {settings.environment, "the environment map"}});
  diagnostics.activity().begin("reading the scene");
  LoadedScene loaded;
  loaded.inputs = std::make_shared<InputRecord>();
  const ReadOptions choice{settings.camera,         settings.variant,     settings.animation,
                           settings.animation_time, settings.definitions, aspect_of(settings.width, settings.height),
                           settings.confine,        loaded.inputs};
  loaded.scene = read_scene(path, choice, diagnostics);
  loaded.inputs->refuse(settings.checkpoint, "the checkpoint");
  if (!settings.environment.empty()) {
    diagnostics.activity().begin("reading the environment map");
    use_environment(loaded.scene, path_beside(path, settings.environment, settings.confine));
  }
  apply_settings(settings, loaded.scene);
  choose_view(settings, loaded.scene, diagnostics);
  loaded.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return loaded;
}

}  // namespace alhazen
