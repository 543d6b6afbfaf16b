#include "alhazen/renderer.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <tuple>
#include <utility>

#include "api/option_names.h"
#include "api/rendered_image.h"
#include "api/scene_state.h"
#include "compile/render_space.h"
#include "geometry/quadrics.h"
#include "pipeline/choose_view.h"
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
                      std::tie(asked.coats, asked.filter, asked.confine, asked.search_paths));
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

/// What settings change of the lights, and what they say of the camera.
auto light_settings(const Settings& s) {
  return std::tuple(s.environment, s.environment_rotation, s.environment_strength, s.light_scale);
}
auto camera_settings(const Settings& s) {
  return std::tuple(s.look_at, s.orbit, s.fit, s.fov, s.aperture, s.focus, aspect_of(s.width, s.height));
}

/// Whether a camera is placed for all that is in the scene.
bool fits_scene(const Camera& camera, const Settings& s) { return camera.is_default || s.fit || !s.orbit.empty(); }

/// The camera that the scene is seen by with these settings, as adapt_scene places it.
Camera placed_camera_of(const SceneState& scene, const Settings& asked) {
  const Scene& description = scene.description;
  const double aspect = aspect_of(asked.width, asked.height);
  if (fits_scene(description.camera, asked) && has_inexact_quadrics(description)) {
    const Scene whole = scene.to_render(aspect);
    return chosen_camera(asked, whole, whole.camera);
  }
  const Camera& camera = description.camera;
  return chosen_camera(asked, description, camera.is_default ? default_camera(description, aspect) : camera);
}

/// The parts of a scene that a camera is placed for.
bool is_same_view(const SceneRevisions& a, const SceneRevisions& b) {
  return a.camera == b.camera && a.geometry == b.geometry && a.transforms == b.transforms && a.film == b.film;
}

void add_warnings(const std::vector<Diagnostics::Warning>& warnings, Diagnostics& diagnostics) {
  for (const Diagnostics::Warning& warning : warnings) diagnostics.warn(warning.where, warning.message);
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

  /// Begins an image of what was built, with what has changed built anew, if that is possible.
  bool reuse(const SceneState& scene, BuildReport& report) {
    const Scene& description = scene.description;
    if (!renderer || !may_reuse(scene)) return false;
    refuse_checkpoint(description.name, scene.inputs.get(), asked);
    const RenderSettings resolved = resolve_settings(asked, description);
    const BuildKey key(resolved), before(*built);
    if (key.fields() != before.fields() || !key.has_names(before)) return false;
    try {
      const bool keeps_view = is_same_view(scene.revisions, revisions) && camera_settings(asked) == of_camera;
      const Camera placed = keeps_view ? camera : placed_camera_of(scene, asked);
      if (!keeps_view && !(renderer->is_in_world_space() && is_in_render_space(description, placed))) return false;
      if (!change(scene, placed, report) || !renderer->find_lost_light(resolved)) return false;
      keep(scene, placed);
      begin(description, resolved, &camera);
    } catch (...) {
      renderer.reset();  // it may be half changed
      throw;
    }
    return true;
  }

  void build(const SceneState& scene, BuildReport& report) {
    renderer.reset();
    adapted = diagnostics = Diagnostics();
    LoadedScene loaded =
        adapt_scene(scene.to_render(aspect_of(asked.width, asked.height)), scene.inputs, asked, adapted);
    built = std::make_unique<RenderSettings>(resolve_settings(asked, loaded.scene));
    keep(scene, loaded.scene.camera);
    filter = scene.description.filter;
    exposure = scene.description.film.exposure;
    coats = scene.description.coats;
    renderer = make_scene_renderer(std::move(loaded.scene), *built, loaded.seconds, diagnostics, ForChanges::yes);
    Diagnostics of_settings;
    warn_of_settings(scene.description, *built, of_settings);
    compiled.clear();
    for (const Diagnostics::Warning& warning : diagnostics.warnings())
      if (std::none_of(of_settings.warnings().begin(), of_settings.warnings().end(),
                       [&](const Diagnostics::Warning& other) { return other.message == warning.message; }))
        compiled.push_back(warning);
    report.is_new = report.materials = report.lights = report.environment = report.transforms = true;
    begin(scene.description, *built, nullptr);
  }

 private:
  /// Whether nothing has changed of what is built as a whole.
  bool may_reuse(const SceneState& scene) const {
    const Scene& description = scene.description;
    return scene.id == scene_id && scene.revisions.geometry == revisions.geometry &&
           scene.revisions.images == revisions.images && is_same_film(description, filter, exposure, coats) &&
           description.camera.shutter_open == camera.shutter_open &&
           description.camera.shutter_close == camera.shutter_close;
  }

  /// Builds anew what has changed. Returns false if that takes more.
  bool change(const SceneState& scene, const Camera& placed, BuildReport& report) {
    const SceneRevisions& now = scene.revisions;
    report.materials = now.materials != revisions.materials;
    if (report.materials && !renderer->change_materials(scene.description)) return false;
    SceneChanges changes;
    changes.transforms = now.transforms != revisions.transforms;
    changes.light_maps = now.light_maps != revisions.light_maps || asked.environment != std::get<0>(of_lights);
    changes.lights = changes.light_maps || now.lights != revisions.lights || now.environment != revisions.environment ||
                     light_settings(asked) != of_lights;
    report.lights = changes.lights;
    report.environment = changes.light_maps;
    report.transforms = changes.transforms;
    if (!changes.lights && !changes.transforms) return true;
    Scene outline = scene.outline_to_render(placed, changes.light_maps);
    adapted = Diagnostics();
    adapt_outline(outline, asked, changes.light_maps, adapted);
    return renderer->change_parts(changes, scene.description.meshes, std::move(outline));
  }

  void keep(const SceneState& scene, const Camera& placed) {
    scene_id = scene.id;
    revisions = scene.revisions;
    of_lights = light_settings(asked);
    of_camera = camera_settings(asked);
    camera = placed;
  }

  /// Begins an image with the warnings that a build for it alone would give.
  void begin(const Scene& description, const RenderSettings& settings, const Camera* seen_by) {
    diagnostics = Diagnostics();
    add_warnings(adapted.warnings(), diagnostics);
    warn_of_settings(description, settings, diagnostics);
    add_warnings(compiled, diagnostics);
    set_image(renderer->begin(events(), seen_by, seen_by ? &settings : nullptr));
  }

 public:
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
    next->watch(adapted.activity());
    // The one before ends after the lock: what it calls may need a lock of its own, whose holder may call `stop`.
    const std::lock_guard lock(mutex);
    listener.swap(next);
  }

  GrowingImage& under_way() const {
    if (!image) throw InputError("no image is under way: call start first");
    return *image;
  }

  Settings asked;
  Diagnostics diagnostics;                     ///< of the scene and the image
  Diagnostics adapted;                         ///< of what settings replace in the scene
  std::vector<Diagnostics::Warning> compiled;  ///< of what was built
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
  Camera camera;  ///< as it was placed
  decltype(light_settings(Settings())) of_lights;
  decltype(camera_settings(Settings())) of_camera;
};

}  // namespace alhazen::impl

namespace ALHAZEN_NAMESPACE {

namespace {

impl::RendererState& state_of(const std::unique_ptr<impl::RendererState>& state) {
  if (!state) throw InputError("the renderer was moved from: assign another to it first");
  return *state;
}

}  // namespace

Renderer::Renderer(const Settings& settings) : state_(std::make_unique<impl::RendererState>(settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;

const Settings& Renderer::settings() const { return state_of(state_).asked; }
void Renderer::set_settings(const Settings& settings) { state_of(state_).asked = settings; }

BuildReport Renderer::start(const Scene& scene, const ProgressFunction& progress) {
  const impl::ThreadDefaults defaults;
  const auto start = std::chrono::steady_clock::now();
  impl::RendererState& state = state_of(state_);
  impl::refuse_reading_settings(state.asked);
  state.set_image(nullptr);
  state.listen(progress);
  BuildReport report;
  state.listener->for_caller([&] {
    if (!state.reuse(scene.state(), report)) state.build(scene.state(), report);
  });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

bool Renderer::render_pass(int64_t samples) {
  const impl::ThreadDefaults defaults;
  if (samples < 0) throw InputError("samples of a pass must not be negative");
  return impl::for_caller([&] {
    return state_of(state_).under_way().take_pass(static_cast<uint32_t>(std::min<int64_t>(samples, 0xffffff00u)));
  });
}

RenderedImage Renderer::image() const {
  const impl::RendererState& state = state_of(state_);
  return impl::for_caller([&] { return impl::rendered_image(state.under_way().so_far(), state.diagnostics); });
}

RenderedImage Renderer::denoised_image() {
  const impl::ThreadDefaults defaults;
  impl::RendererState& state = state_of(state_);
  return impl::for_caller([&] {
    impl::GrowingImage& image = state.under_way();
    if (image.so_far().statistics.settings.denoiser.empty())
      throw InputError("the image under way has no denoiser: set 'denoiser' before it is started");
    return impl::rendered_image(image.denoised_so_far(), state.diagnostics);
  });
}

Progress Renderer::progress() const { return state_of(state_).under_way().progress(); }

void Renderer::stop() {
  if (state_) state_->stop();
}

RenderedImage Renderer::finish() {
  const impl::ThreadDefaults defaults;
  impl::RendererState& state = state_of(state_);
  state.under_way();
  const std::unique_ptr<impl::GrowingImage> image = state.set_image(nullptr);
  return state.listener->for_caller([&] { return impl::rendered_image(image->finish(), state.diagnostics); });
}

RenderedImage Renderer::render(const Scene& scene, const ProgressFunction& progress, const PassFunction& after_pass) {
  try {
    start(scene, progress);
  } catch (const Cancelled&) {
    if (!state_ || state_->listener->has_thrown()) throw;
    return impl::empty_image(state_->diagnostics);
  }
  try {
    while (render_pass())
      if (after_pass && !after_pass(*this)) break;
  } catch (...) {
    if (state_) state_->set_image(nullptr);  // with the thread that calls `progress`
    throw;
  }
  return finish();
}

std::vector<Warning> Renderer::warnings() const {
  return impl::with_field_names(state_of(state_).diagnostics.public_warnings());
}

}  // namespace ALHAZEN_NAMESPACE
