// Renders a scene that is in memory.

#include "alhazen/scene.h"
#include "api/rendered_image.h"
#include "api/scene_state.h"
#include "util/thread_limit.h"

namespace ALHAZEN_NAMESPACE {

RenderedImage render(const Scene& scene, const Settings& settings, const ProgressFunction& progress) {
  impl::refuse_reading_settings(settings);
  const impl::ThreadDefaults defaults;
  impl::Diagnostics diagnostics;
  impl::Listener listener(progress);
  listener.watch(diagnostics.activity());
  const impl::SceneState& state = scene.state();
  return impl::image_for_caller(listener, diagnostics, [&] {
    impl::Scene description = state.to_render(impl::aspect_of(settings.width, settings.height));
    return impl::rendered_image(impl::adapt_scene(std::move(description), state.inputs, settings, diagnostics),
                                settings, listener.function(), diagnostics);
  });
}

}  // namespace ALHAZEN_NAMESPACE
