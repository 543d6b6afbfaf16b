#include "alhazen/alhazen.h"

#include "api/rendered_image.h"
#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/thread_limit.h"

namespace alhazen::inline ALHAZEN_ABI_NAMESPACE {

const float* RenderedImage::plane(const std::string& channel) const {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i] == channel) return planes[i].data();
  return nullptr;
}

RenderedImage render(const std::string& scene_file, const Settings& settings, const ProgressFunction& progress) {
  using namespace impl;
  const ThreadDefaults defaults;
  Diagnostics diagnostics;
  LoadedScene loaded = load_scene(scene_file, settings, diagnostics);
  const RenderSettings resolved = resolve_settings(settings, loaded.scene);
  const Rendering rendering =
      render_scene(std::move(loaded.scene), resolved, loaded.seconds, RenderEvents{progress, {}, {}}, diagnostics);
  return rendered_image(rendering, diagnostics);
}

}  // namespace alhazen::inline ALHAZEN_ABI_NAMESPACE
