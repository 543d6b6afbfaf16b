#include "view/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alhazen::impl {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double coarse_seconds = 0.045;
constexpr int longest_side = 1280;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Places the camera as the settings say, which then say nothing of it any more.
void apply_camera_settings(Scene& scene, Settings& s) {
  Camera camera = scene.camera();
  if (s.fov) camera.fov = *s.fov;
  if (s.aperture) camera.lens_radius = *s.aperture;
  if (s.fov || s.aperture) scene.set_camera(camera);
  if (s.look_at.size() >= 6) {
    const auto& v = s.look_at;
    scene.look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]},
                  v.size() == 9 ? std::optional<Vec3>({v[6], v[7], v[8]}) : std::nullopt);
  }
  if (s.orbit.size() >= 2)
    scene.orbit(s.orbit[0], s.orbit[1], s.orbit.size() == 3 ? std::optional<double>(s.orbit[2]) : std::nullopt);
  if (s.fit) scene.fit();
  if (s.focus) {
    camera = scene.camera();
    camera.focal_distance = *s.focus;
    scene.set_camera(camera);
  }
  s.look_at.clear();
  s.orbit.clear();
  s.fit = false;
  s.fov.reset();
  s.aperture.reset();
  s.focus.reset();
}

/// The size of the film, made smaller if it is too large to be rendered while someone watches.
std::pair<int64_t, int64_t> default_size(const Film& film) {
  const double scale =
      std::min(1.0, static_cast<double>(longest_side) / static_cast<double>(std::max(film.width, film.height)));
  const auto scaled = [&](int64_t side) {
    return std::max<int64_t>(1, std::llround(static_cast<double>(side) * scale));
  };
  return {scaled(film.width), scaled(film.height)};
}

/// The same part of an image of another size, at least a pixel.
std::array<int64_t, 4> scaled_bounds(const std::array<int64_t, 4>& bounds, double x, double y, int64_t width,
                                     int64_t height) {
  const auto scaled = [](int64_t value, double factor, int64_t low, int64_t high) {
    return std::clamp<int64_t>(std::llround(static_cast<double>(value) * factor), low, high);
  };
  const int64_t x0 = scaled(bounds[0], x, 0, width - 1), y0 = scaled(bounds[2], y, 0, height - 1);
  return {x0, scaled(bounds[1], x, x0 + 1, width), y0, scaled(bounds[3], y, y0 + 1, height)};
}

/// A picture of the planes, and the rest.
ViewImage split(RenderedImage&& image) {
  std::vector<std::vector<float>> planes = std::exchange(image.planes, {});
  std::vector<std::string> channels = std::exchange(image.channels, {});
  ViewImage result{nullptr, image};
  image.planes = std::move(planes);
  image.channels = std::move(channels);
  result.picture = make_picture(std::move(image));
  return result;
}

}  // namespace

const std::vector<std::pair<std::string, std::vector<std::string>>>& view_layers() {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> layers{
      {"alpha", {"alpha.Y"}},
      {"albedo", {"albedo.R", "albedo.G", "albedo.B"}},
      {"normal", {"normal.X", "normal.Y", "normal.Z"}},
      {"camera_normal", {"camera_normal.X", "camera_normal.Y", "camera_normal.Z"}},
      {"depth", {"depth.Z"}},
      {"distance", {"distance.Y"}},
      {"position", {"position.X", "position.Y", "position.Z"}},
      {"uv", {"uv.U", "uv.V"}},
      {"motion", {"motion.X", "motion.Y"}},
      {"object", {"object.Y"}},
      {"material", {"material.Y"}},
      {"bounces", {"bounces.Y"}},
      {"samples", {"samples.Y"}},
      {"variance", {"variance.Y"}},
  };
  return layers;
}

ViewRenderer::ViewRenderer(Scene scene, const Settings& settings, Mailbox& mailbox, std::mutex& scene_mutex)
    : scene_(std::move(scene)), settings_(settings), mailbox_(mailbox), scene_mutex_(scene_mutex) {
  settings_.denoiser = "none";
  Film film = scene_.film();
  if (settings_.width <= 0) std::tie(settings_.width, settings_.height) = default_size(film);
  // Coarse pictures have no bounds of their own, so the film has none.
  if (film.pixel_bounds && !settings_.crop_window && !settings_.pixel_bounds)
    settings_.pixel_bounds = scaled_bounds(
        *film.pixel_bounds, static_cast<double>(settings_.width) / static_cast<double>(film.width),
        static_cast<double>(settings_.height) / static_cast<double>(film.height), settings_.width, settings_.height);
  film.pixel_bounds.reset();
  film.width = settings_.width;
  film.height = settings_.height;
  scene_.set_film(film);
  apply_camera_settings(scene_, settings_);
  first_bounds_ = settings_.pixel_bounds;
  first_width_ = settings_.width;
  first_height_ = settings_.height;
  first_camera_ = scene_.camera();
}

void ViewRenderer::set_size(int width, int height) {
  if (first_bounds_)
    settings_.pixel_bounds =
        scaled_bounds(*first_bounds_, static_cast<double>(width) / static_cast<double>(first_width_),
                      static_cast<double>(height) / static_cast<double>(first_height_), width, height);
  settings_.width = width;
  settings_.height = height;
  seconds_per_sample_ = 0;
}

void ViewRenderer::set_samples(int64_t samples) {
  settings_.samples_per_pixel = samples;
  settings_.quality.clear();
  settings_.noise = 0;
  settings_.noise_measure = "none";
}

void ViewRenderer::set_environment(const EnvironmentMessage& e) {
  settings_.environment_rotation = e.rotation;
  settings_.environment_strength = e.strength;
  settings_.light_scale = e.light_scale;
}

void ViewRenderer::set_layers(const std::set<std::string>& layers) {
  layers_ = layers;
  settings_.aovs.assign(layers.begin(), layers.end());
  seconds_per_sample_ = 0;
}

int64_t ViewRenderer::samples() const {
  return settings_.samples_per_pixel > 0 ? settings_.samples_per_pixel : scene_.render_defaults().samples_per_pixel;
}

PixelRegion ViewRenderer::region() const {
  if (settings_.pixel_bounds) {
    const auto& b = *settings_.pixel_bounds;
    return {static_cast<int>(b[0]), static_cast<int>(b[2]), static_cast<int>(b[1] - b[0]),
            static_cast<int>(b[3] - b[2])};
  }
  if (settings_.crop_window) {
    const auto& c = *settings_.crop_window;
    const auto pixel = [](double fraction, int size) {
      return std::clamp(static_cast<int>(std::ceil(fraction * size)), 0, size);
    };
    const int x0 = std::min(pixel(c[0], width()), width() - 1), y0 = std::min(pixel(c[2], height()), height() - 1);
    return {x0, y0, std::max(1, pixel(c[1], width()) - x0), std::max(1, pixel(c[3], height()) - y0)};
  }
  return {0, 0, width(), height()};
}

Settings ViewRenderer::coarse_settings(int step) const {
  Settings s = settings_;
  const PixelRegion whole = region();
  s.width = (whole.width + step - 1) / step;
  s.height = (whole.height + step - 1) / step;
  s.crop_window.reset();
  s.pixel_bounds.reset();
  s.samples_per_pixel = 1;
  s.quality.clear();
  s.noise = 0;
  s.noise_measure = "none";
  s.guiding.clear();
  s.denoiser = "none";
  // What is built for names of objects and materials serves images without them, but not the other way round.
  if (!is_built_ && names_parts_)
    for (const char* layer : {"object", "material"})
      if (!layers_.contains(layer)) s.aovs.emplace_back(layer);
  return s;
}

int ViewRenderer::suitable_step() const {
  if (seconds_per_pixel_ == 0) return max_step;
  const PixelRegion whole = region();
  const double pixels = static_cast<double>(whole.width) * static_cast<double>(whole.height);
  int step = 1;
  while (step < max_step && start_seconds_ + pixels / (step * step) * seconds_per_pixel_ > coarse_seconds) step *= 2;
  return step;
}

void ViewRenderer::start_coarse(int step, const PixelRegion& whole, const ProgressFunction& progress) {
  const Camera camera = scene_.camera();
  scene_.set_camera(coarse_camera(camera, width(), height(), whole, step));
  try {
    renderer_.set_settings(coarse_settings(step));
    renderer_.start(scene_, progress);
    is_built_ = true;
  } catch (const ::alhazen::InputError&) {
    scene_.set_camera(camera);
    if (is_built_ || !names_parts_) throw;
    names_parts_ = false;  // some integrators have no such layers
    return start_coarse(step, whole, progress);
  } catch (...) {
    scene_.set_camera(camera);
    throw;
  }
  scene_.set_camera(camera);
}

std::optional<ViewImage> ViewRenderer::render_coarse(int step, bool is_interruptible,
                                                     const ProgressFunction& progress) {
  const PixelRegion whole = region();
  const bool is_first = !is_built_;
  const Clock::time_point start = Clock::now();
  {
    const std::lock_guard lock(scene_mutex_);
    start_coarse(step, whole, progress);
  }
  const Clock::time_point started = Clock::now();
  if (!mailbox_.render_pass(renderer_, 1, is_interruptible)) return {};
  const double in_pass = seconds_since(started);
  ViewImage image = this->image();
  Picture& picture = *image.picture;
  std::erase_if(picture.layers, [&](const PictureLayer& layer) {
    return (layer.name == "object" || layer.name == "material") && !layers_.contains(layer.name);
  });
  seconds_per_pixel_ = in_pass / (static_cast<double>(picture.width) * picture.height);
  if (!is_first) start_seconds_ = seconds_since(start) - in_pass;
  picture.full_width = image.description.full_width = width();
  picture.full_height = image.description.full_height = height();
  picture.x = image.description.x = whole.x;
  picture.y = image.description.y = whole.y;
  picture.step = step;
  picture.is_final = false;
  return image;
}

void ViewRenderer::start(const ProgressFunction& progress) {
  renderer_.set_settings(settings_);
  is_done_ = false;
  const std::lock_guard lock(scene_mutex_);
  renderer_.start(scene_, progress);
  is_built_ = true;
}

bool ViewRenderer::render_pass(double seconds) {
  constexpr double fewest = 4, most = 64;
  const double wanted = seconds_per_sample_ > 0 ? std::floor(seconds / seconds_per_sample_ / fewest) * fewest : fewest;
  const Progress before = renderer_.progress();
  const Clock::time_point start = Clock::now();
  const std::optional<bool> goes_on =
      mailbox_.render_pass(renderer_, static_cast<int64_t>(std::clamp(wanted, fewest, most)), true);
  if (!goes_on) return false;
  is_done_ = !*goes_on;
  const Progress after = renderer_.progress();
  const double taken =
      static_cast<double>(after.samples_done - before.samples_done) / std::max(1.0, static_cast<double>(after.pixels));
  if (taken > 0) seconds_per_sample_ = seconds_since(start) / taken;
  return true;
}

ViewImage ViewRenderer::denoised() {
  ViewImage result = split(renderer_.finish());
  result.picture->is_final = true;
  std::vector<PictureLayer>& layers = result.picture->layers;
  std::erase_if(layers, [](const PictureLayer& layer) { return layer.name != "color"; });
  if (result.description.denoiser.empty()) layers.clear();
  for (PictureLayer& layer : layers) layer.name = "denoised";
  return result;
}

ViewImage ViewRenderer::image() const {
  ViewImage result = split(renderer_.image());
  result.picture->is_final = is_done_;
  return result;
}

}  // namespace alhazen::impl
