#include "alhazen/alhazen.h"

#include "files/file_identity.h"
#include "io/environment.h"
#include "io/read_scene.h"
#include "render/renderer.h"
#include "util/thread_limit.h"

namespace alhazen {

const float* RenderedImage::plane(const std::string& channel) const {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i] == channel) return planes[i].data();
  return nullptr;
}

RenderedImage render(const std::string& scene_file, const Settings& settings, const ProgressFunction& progress) {
  const ThreadDefaults defaults;
  Diagnostics diagnostics;
  refuse_same_file({settings.checkpoint, "the checkpoint"},
                   {{scene_file, "the scene"}, {settings.environment, "the environment map"}});
  const ReadOptions choice{settings.camera,
                           settings.variant,
                           settings.animation,
                           settings.animation_time,
                           aspect_of(settings.width, settings.height),
                           settings.confine,
                           std::make_shared<InputRecord>()};
  Scene scene = read_scene(scene_file, choice, diagnostics);
  choice.record->refuse(settings.checkpoint, "the checkpoint");
  if (!settings.environment.empty())
    use_environment(scene, path_beside(scene_file, settings.environment, settings.confine));
  apply_settings(settings, scene);
  const RenderSettings resolved = resolve_settings(settings, scene);
  const Rendering rendering = render_scene(std::move(scene), resolved, 0, RenderEvents{progress, {}, {}}, diagnostics);
  const ImageSource source = rendering.source();
  RenderedImage image;
  image.width = source.width;
  image.height = source.height;
  image.channels = source.channels;
  image.complete = rendering.statistics.complete;
  const size_t width = static_cast<size_t>(source.width), height = static_cast<size_t>(source.height);
  image.planes.assign(source.channels.size(), std::vector<float>(width * height));
  std::vector<float> row(source.channels.size() * width);
  for (size_t y = 0; y < height; ++y) {
    source.fill_row(static_cast<int>(y), row);
    for (size_t c = 0; c < image.planes.size(); ++c)
      std::copy_n(row.data() + c * width, width, image.planes[c].data() + y * width);
  }
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) image.warnings.push_back(warning.to_string());
  return image;
}

}  // namespace alhazen
