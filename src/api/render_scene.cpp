// Renders a scene that is in memory.

#include "alhazen/scene.h"
#include "api/rendered_image.h"
#include "api/scene_state.h"
#include "util/thread_limit.h"

namespace alhazen::inline ALHAZEN_ABI_NAMESPACE {

namespace {

/// Settings that select what is read from a file have come too late.
void refuse_reading_settings(const Settings& settings) {
  const auto refuse = [](bool is_given, const char* name) {
    if (is_given)
      throw InputError("the setting '" + std::string(name) +
                       "' is about reading a file: give it to Scene::load instead of render");
  };
  refuse(!settings.camera.empty(), "camera");
  refuse(!settings.variant.empty(), "variant");
  refuse(!settings.animation.empty(), "animation");
  refuse(settings.animation_time.has_value(), "animation_time");
  refuse(settings.shutter.has_value(), "shutter");
  refuse(!settings.definitions.empty(), "definitions");
}

}  // namespace

RenderedImage render(const Scene& scene, const Settings& settings, const ProgressFunction& progress) {
  refuse_reading_settings(settings);
  const impl::ThreadDefaults defaults;
  impl::Diagnostics diagnostics;
  const impl::SceneState& state = scene.state();
  impl::Scene description = state.to_render(impl::aspect_of(settings.width, settings.height));
  return impl::rendered_image(impl::adapt_scene(std::move(description), state.inputs, settings, diagnostics), settings,
                              progress, diagnostics);
}

}  // namespace alhazen::inline ALHAZEN_ABI_NAMESPACE
