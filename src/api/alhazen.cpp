#include "alhazen/alhazen.h"

#include "api/rendered_image.h"
#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/thread_limit.h"

namespace ALHAZEN_NAMESPACE {

const float* RenderedImage::plane(const std::string& channel) const {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i] == channel) return planes[i].data();
  return nullptr;
}

RenderedImage render(const std::string& scene_file, const Settings& settings, const ProgressFunction& progress) {
  const impl::ThreadDefaults defaults;
  impl::Diagnostics diagnostics;
  impl::Listener listener(progress);
  listener.watch(diagnostics.activity());
  return impl::image_for_caller(listener, diagnostics, [&] {
    return impl::rendered_image(impl::load_scene(scene_file, settings, diagnostics), settings, listener.function(),
                                diagnostics);
  });
}

}  // namespace ALHAZEN_NAMESPACE
