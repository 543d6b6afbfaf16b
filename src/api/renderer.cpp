#include "alhazen/renderer.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <tuple>
#include <utility>

#include "api/rendered_image.h"
#include "api/scene_state.h"
#include "compile/render_space.h"
#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

/// What a compiled scene depends on besides the description: settings that change the scene or its records.
struct BuildKey {
  explicit BuildKey(const RenderSettings& s) : asked(s.asked), settings(s) {}

  auto fields() const {
    return std::tuple(settings.precision, settings.backend, settings.strategy, settings.device, settings.block.x,
                      settings.block.y, settings.chunk.x, settings.chunk.y, settings.threads, settings.texture_budget,
                      settings.integrator == IntegratorKind::path,
                      std::tie(asked.coats, asked.filter, asked.environment, asked.environment_rotation,
                               asked.environment_strength, asked.light_scale, asked.confine, asked.search_paths));
  }

  /// Whether layers need only names and light groups that were built with `built`.
  bool has_names(const BuildKey& built) const {
    const bool needs_groups = settings.aovs.light_groups, has_groups = built.settings.aovs.light_groups;
    return (!wants_names(settings.aovs) || wants_names(built.settings.aovs) || has_groups) &&
           (!needs_groups || (has_groups && asked.light_groups == built.asked.light_groups));
  }

  const Settings& asked;
  const RenderSettings& settings;
};

/// Whether settings move the camera of the scene.
bool places_camera(const Settings& s) {
  return !s.look_at.empty() || !s.orbit.empty() || s.fit || s.fov || s.aperture || s.focus;
}

/// Of a film, what is compiled.
bool is_same_film(const Scene& a, const Filter& filter, double exposure, CoatModel coats) {
  const auto fields = [](const Filter& f) {
    return std::tie(f.type, f.x_radius, f.y_radius, f.sigma, f.b, f.c, f.tau);
  };
  return fields(a.filter) == fields(filter) && a.film.exposure == exposure && a.coats == coats;
}

}  // namespace

struct RendererState {
  explicit RendererState(const Settings& settings) : asked(settings) {}
  ~RendererState() { set_image(nullptr); }  // its last progress may call `stop`

  /// Begins an image of what was built, if that is possible.
  bool reuse(const SceneState& scene) {
    if (!renderer || scene.id != scene_id || places_camera(asked)) return false;
    SceneRevisions now = scene.revisions;
    now.camera = revisions.camera, now.film = revisions.film, now.materials = revisions.materials;
    if (now != revisions) return false;
    const Scene& description = scene.description;
    if (!is_same_film(description, filter, exposure, coats)) return false;
    if (description.camera.shutter_open != camera.shutter_open ||
        description.camera.shutter_close != camera.shutter_close || description.camera.is_default)
      return false;
    refuse_checkpoint(description.name, scene.inputs.get(), asked);
    const RenderSettings resolved = resolve_settings(asked, description);
    const BuildKey key(resolved), before(*built);
    if (key.fields() != before.fields() || !key.has_names(before)) return false;
    if (scene.revisions.camera != revisions.camera &&
        !(renderer->is_in_world_space() && is_in_render_space(description)))
      return false;
    diagnostics = build_diagnostics;
    try {
      if (scene.revisions.materials != revisions.materials && !renderer->change_materials(description)) return false;
      revisions = scene.revisions;
      warn_of_settings(description, resolved, diagnostics);
      set_image(renderer->begin(events(), &description.camera, &resolved));
    } catch (...) {
      renderer.reset();  // it may be half changed
      throw;
    }
    return true;
  }

  void build(const SceneState& scene) {
    renderer.reset();
    diagnostics = Diagnostics();
    LoadedScene loaded =
        adapt_scene(scene.to_render(aspect_of(asked.width, asked.height)), scene.inputs, asked, diagnostics);
    built = std::make_unique<RenderSettings>(resolve_settings(asked, loaded.scene));
    scene_id = scene.id;
    revisions = scene.revisions;
    filter = scene.description.filter;
    exposure = scene.description.film.exposure;
    coats = scene.description.coats;
    camera = scene.description.camera;
    renderer = make_scene_renderer(std::move(loaded.scene), *built, loaded.seconds, diagnostics);
    build_diagnostics = diagnostics;
    set_image(renderer->begin(events()));
  }

  /// `stop` may look at it at any time.
  std::unique_ptr<GrowingImage> set_image(std::unique_ptr<GrowingImage> next) {
    const std::lock_guard lock(mutex);
    return std::exchange(image, std::move(next));
  }

  void stop() {
    const std::lock_guard lock(mutex);
    if (image)
      image->stop();
    else if (listener)
      listener->cancel();
  }

  RenderEvents events() const { return {listener->function(), {}, {}, {}}; }

  /// The progress function of the image that begins.
  void listen(const ProgressFunction& progress) {
    auto next = std::make_unique<Listener>(progress);
    next->watch(diagnostics.activity());
    const std::lock_guard lock(mutex);
    listener = std::move(next);
  }

  GrowingImage& under_way() const {
    if (!image) throw InputError("no image is under way: call start first");
    return *image;
  }

  Settings asked;
  Diagnostics diagnostics;        ///< of the scene and the image
  Diagnostics build_diagnostics;  ///< of the scene alone
  std::unique_ptr<Listener> listener;
  std::unique_ptr<RenderSettings> built;  ///< `renderer` refers to it
  std::unique_ptr<SceneRenderer> renderer;
  std::mutex mutex;                     ///< of `image` and `listener`
  std::unique_ptr<GrowingImage> image;  ///< refers to `renderer`
  // What was built.
  uint32_t scene_id = 0;
  SceneRevisions revisions;
  Filter filter;
  double exposure = 1;
  CoatModel coats = CoatModel::lossless;
  Camera camera;
};

}  // namespace alhazen::impl

namespace ALHAZEN_NAMESPACE {

Renderer::Renderer(const Settings& settings) : state_(std::make_unique<impl::RendererState>(settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;

const Settings& Renderer::settings() const { return state_->asked; }
void Renderer::set_settings(const Settings& settings) { state_->asked = settings; }

BuildReport Renderer::start(const Scene& scene, const ProgressFunction& progress) {
  const impl::ThreadDefaults defaults;
  const auto start = std::chrono::steady_clock::now();
  impl::refuse_reading_settings(state_->asked);
  state_->set_image(nullptr);
  state_->listen(progress);
  BuildReport report;
  report.is_new = state_->listener->for_caller([&] {
    if (state_->reuse(scene.state())) return false;
    state_->build(scene.state());
    return true;
  });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

bool Renderer::render_pass(int64_t samples) {
  const impl::ThreadDefaults defaults;
  if (samples < 0) throw InputError("samples of a pass must not be negative");
  return impl::for_caller(
      [&] { return state_->under_way().take_pass(static_cast<uint32_t>(std::min<int64_t>(samples, 0xffffff00u))); });
}

RenderedImage Renderer::image() const {
  return impl::for_caller([&] { return impl::rendered_image(state_->under_way().so_far(), state_->diagnostics); });
}

Progress Renderer::progress() const { return state_->under_way().progress(); }

void Renderer::stop() { state_->stop(); }

RenderedImage Renderer::finish() {
  const impl::ThreadDefaults defaults;
  state_->under_way();
  const std::unique_ptr<impl::GrowingImage> image = state_->set_image(nullptr);
  return state_->listener->for_caller([&] { return impl::rendered_image(image->finish(), state_->diagnostics); });
}

RenderedImage Renderer::render(const Scene& scene, const ProgressFunction& progress, const PassFunction& after_pass) {
  try {
    start(scene, progress);
  } catch (const Cancelled&) {
    if (state_->listener->has_thrown()) throw;
    return impl::empty_image(state_->diagnostics);
  }
  try {
    while (render_pass())
      if (after_pass && !after_pass(*this)) break;
  } catch (...) {
    state_->set_image(nullptr);  // with the thread that calls `progress`
    throw;
  }
  return finish();
}

std::vector<Warning> Renderer::warnings() const { return state_->diagnostics.public_warnings(); }

}  // namespace ALHAZEN_NAMESPACE
