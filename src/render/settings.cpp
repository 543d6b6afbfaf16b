#include "render/settings.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <thread>

#include "images/display/tone_map.h"
#include "render/backend.h"
#include "render/checkpoint.h"
#include "render/denoiser.h"
#include "render/quality.h"
#include "scene/filters.h"
#include "scene/limits.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

template <class Value>
struct Named {
  const char* name;
  Value value;
};

constexpr Named<Precision> precisions[] = {{"float", Precision::single}, {"double", Precision::double_}};
constexpr Named<IntegratorKind> integrators[] = {{"path", IntegratorKind::path},
                                                 {"iterative", IntegratorKind::iterative},
                                                 {"recursive", IntegratorKind::recursive},
                                                 {"branching", IntegratorKind::branching}};
constexpr Named<SamplerType> samplers[] = {
    {"sobol", SamplerType::sobol}, {"zsobol", SamplerType::zsobol}, {"independent", SamplerType::independent}};
constexpr Named<ScheduleKind> schedules[] = {
    {"static", ScheduleKind::static_}, {"dynamic", ScheduleKind::dynamic}, {"guided", ScheduleKind::guided}};
constexpr Named<GuidingMode> guiding_modes[] = {
    {"off", GuidingMode::off}, {"on", GuidingMode::on}, {"auto", GuidingMode::automatic}};
constexpr NamedLayer layers[] = {{"alpha", &AovSet::alpha},           {"albedo", &AovSet::albedo},
                                 {"normal", &AovSet::normal},         {"camera_normal", &AovSet::camera_normal},
                                 {"depth", &AovSet::depth},           {"distance", &AovSet::distance},
                                 {"position", &AovSet::position},     {"uv", &AovSet::uv},
                                 {"motion", &AovSet::motion},         {"object", &AovSet::object},
                                 {"material", &AovSet::material},     {"cryptomatte", &AovSet::cryptomatte},
                                 {"components", &AovSet::components}, {"light_groups", &AovSet::light_groups},
                                 {"bounces", &AovSet::bounces},       {"samples", &AovSet::samples},
                                 {"variance", &AovSet::variance},     {"noisy", &AovSet::noisy}};

template <class Value, size_t count>
Value by_name(const Named<Value> (&table)[count], const std::string& name, const std::string& what) {
  std::string choices;
  for (const Named<Value>& entry : table) {
    if (name == entry.name) return entry.value;
    choices += (choices.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError("unknown " + what + " '" + name + "': it may be " + choices);
}

template <class Value, size_t count>
std::string name_of(const Named<Value> (&table)[count], Value value) {
  for (const Named<Value>& entry : table)
    if (entry.value == value) return entry.name;
  return {};
}

int64_t in_range(int64_t value, int64_t low, int64_t high, const std::string& what) {
  if (value < low || value > high)
    throw InputError(what + " must be between " + std::to_string(low) + " and " + std::to_string(high) + ", not " +
                     std::to_string(value));
  return value;
}

constexpr const char* crop_form = "the crop window must be x0,x1,y0,y1 with x0 < x1 and y0 < y1, within 0 and 1";

PixelWindow window_from(const std::array<double, 4>& crop, int width, int height) {
  const auto edge = [](double fraction, int size) {
    return static_cast<int>(std::ceil(std::clamp(fraction, 0.0, 1.0) * size));
  };
  if (!(crop[0] < crop[1] && crop[2] < crop[3])) throw InputError(crop_form);
  return {edge(crop[0], width), edge(crop[1], width), edge(crop[2], height), edge(crop[3], height)};
}

PixelWindow window_from(const std::array<int64_t, 4>& bounds, int width, int height) {
  const auto edge = [](int64_t pixel, int size) { return static_cast<int>(std::clamp<int64_t>(pixel, 0, size)); };
  return {edge(bounds[0], width), edge(bounds[1], width), edge(bounds[2], height), edge(bounds[3], height)};
}

/// The scene's bounds are in pixels of the scene's resolution; they scale with another one.
PixelWindow scene_window(const FilmSettings& film, int width, int height) {
  if (!film.pixel_bounds) return {0, width, 0, height};
  const auto& b = *film.pixel_bounds;
  const auto fraction = [](int64_t pixel, int64_t size) {
    return static_cast<double>(pixel) / static_cast<double>(size);
  };
  if (width == film.width && height == film.height) return window_from(b, width, height);
  return window_from(std::array<double, 4>{fraction(b[0], film.width), fraction(b[1], film.width),
                                           fraction(b[2], film.height), fraction(b[3], film.height)},
                     width, height);
}

/// The side that is not given, so that the image has the aspect ratio of the film.
int64_t side_for(int64_t other, int64_t film_side, int64_t film_other) {
  return std::max<int64_t>(
      1, std::llround(static_cast<double>(other) * static_cast<double>(film_side) / static_cast<double>(film_other)));
}

void resolve_image(const Settings& asked, const Scene& scene, RenderSettings& s) {
  constexpr int64_t longest = 100'000, max_pixels = 1'000'000'000;
  const auto side = [&](int64_t own, int64_t other, int64_t film_side, int64_t film_other, const char* name) {
    if (own != 0) return static_cast<int>(in_range(own, 1, longest, name));
    if (other <= 0 || other > longest) other = 0;  // refused as the other side
    return static_cast<int>(
        in_range(other == 0 ? film_side : side_for(other, film_side, film_other), 1, longest, name));
  };
  s.width = side(asked.width, asked.height, scene.film.width, scene.film.height, "the image's width");
  s.height = side(asked.height, asked.width, scene.film.height, scene.film.width, "the image's height");
  if (asked.crop_window && asked.pixel_bounds) throw InputError("give a crop window or pixel bounds, not both");
  if (asked.crop_window)
    for (const double edge : *asked.crop_window)
      if (!(edge >= 0 && edge <= 1)) throw InputError(crop_form);
  s.window = asked.crop_window    ? window_from(*asked.crop_window, s.width, s.height)
             : asked.pixel_bounds ? window_from(*asked.pixel_bounds, s.width, s.height)
                                  : scene_window(scene.film, s.width, s.height);
  if (s.window.width() < 1 || s.window.height() < 1)
    throw InputError("the part of the image to render holds no pixel: widen the crop window or pixel bounds");
  if (s.window.pixels() >= max_pixels)
    throw InputError("an image of 10^9 pixels or more cannot be rendered at once: render parts of it with --crop");
}

/// If the system does not provide the requested threads, that is an error; without a request fewer are used.
void check_threads(int asked, RenderSettings& s) {
  if (s.runs_on_device) return;
  const int available = threads_available(s.threads);
  if (available >= s.threads) return;
  if (asked != 0)
    throw InputError("the system does not give " + std::to_string(s.threads) + " threads: give --threads " +
                     std::to_string(available) +
                     " or fewer, or raise what limits them (ulimit -u, ulimit -v, the container's pids or memory)");
  s.threads = available;
}

/// Refuses an unavailable denoiser before the render.
void resolve_denoiser(const std::string& name, RenderSettings& s) {
  const ChosenDenoiser chosen = choose_denoiser(name);
  s.denoiser = chosen.name;
  s.denoiser_warning = chosen.warning;
  if (s.aovs.noisy && s.denoiser.empty())
    throw InputError("the layer 'noisy' is the image before denoising: give --denoise as well");
}

void resolve_noise(const Settings& asked, const Scene& scene, RenderSettings& s) {
  if (!(asked.noise >= 0 && asked.noise <= 1))
    throw InputError("the noise target must be a number above 0 and at most 1, for example 0.05; 0 for none");
  const bool is_displayed = asked.noise_measure == "display", is_none = asked.noise_measure == "none";
  if (!is_displayed && !is_none && !asked.noise_measure.empty() && asked.noise_measure != "relative")
    throw InputError("unknown measure of noise '" + asked.noise_measure + "': it may be relative, display, none");
  if (is_none && asked.noise > 0) throw InputError("give a noise target, or 'none' for none, not both");
  if (asked.noise == 0 || !is_displayed) return;
  const double exposure = asked.noise_exposure.value_or(0);
  if (!(std::abs(exposure) <= 100))
    throw InputError("the exposure at which noise is seen must be a number of stops from -100 to 100");
  if (asked.noise_auto_exposure && asked.noise_exposure)
    throw InputError("give the exposure at which noise is seen, or let the image decide on it, not both");
  s.noise_curve = DisplayCurve{portable_exp2(exposure), tone_map_named(asked.noise_tone_map)};
  s.noise_exposure = asked.noise_auto_exposure                           ? ExposureRule::automatic
                     : !asked.noise_exposure && scene.film.fits_exposure ? ExposureRule::fitting
                                                                         : ExposureRule::given;
}

void resolve_guiding(const Settings& asked, RenderSettings& s) {
  s.guiding = asked.guiding.empty() ? GuidingMode::off : by_name(guiding_modes, asked.guiding, "mode of guiding");
  s.guiding_memory = static_cast<uint64_t>(in_range(asked.guiding_memory, 1, 1 << 20, "the memory of guiding in MiB"))
                     << 20;
  if (s.guiding != GuidingMode::off && s.integrator != IntegratorKind::path)
    throw InputError("guiding needs the integrator 'path', and this is '" + to_string(s.integrator) +
                     "': leave out --guiding, or give --integrator path");
}

void check_clamp(const Settings& asked, const RenderSettings& s) {
  if (!(asked.clamp_indirect >= 0) || !std::isfinite(asked.clamp_indirect))
    throw InputError("the limit of indirect light must be a finite number, not negative; 0 for none");
  if (asked.clamp_indirect > 0 && s.integrator != IntegratorKind::path)
    throw InputError("a limit of indirect light needs the integrator 'path', and this is '" + to_string(s.integrator) +
                     "': leave out --clamp-indirect, or give --integrator path");
}

bool AovSet::*layer_named(const std::string& name) {
  std::string choices;
  for (const NamedLayer& layer : layers) {
    if (name == layer.name) return layer.is_wanted;
    choices += (choices.empty() ? "" : ", ") + std::string(layer.name);
  }
  throw InputError("unknown layer '" + name + "': it may be " + choices);
}

void resolve_background(const Settings& asked, RenderSettings& s) {
  s.has_alpha = asked.transparent_background;
  if (asked.transparent_glass && s.integrator != IntegratorKind::path)
    throw InputError("transparent glass needs the integrator 'path', and this is '" + to_string(s.integrator) +
                     "': leave out --transparent-glass, or give --integrator path");
  if (asked.transparent_glass && s.guiding != GuidingMode::off)
    throw InputError(
        "transparent glass cannot be combined with path guiding: leave out --transparent-glass or --guiding");
}

/// Needs to know the layers and the denoiser.
void resolve_aov_surface(const std::string& name, RenderSettings& s) {
  const bool is_path = s.integrator == IntegratorKind::path;
  if (!name.empty() && name != "first" && name != "diffuse")
    throw InputError("unknown surface of layers '" + name + "': it may be first, diffuse");
  if (name == "diffuse" && !is_path)
    throw InputError("layers of what is seen through glass and in mirrors need the integrator 'path', and this is '" +
                     to_string(s.integrator) + "': leave out --aov-surface, or give --integrator path");
  const bool has_layers = s.aovs.albedo || s.aovs.normal || s.aovs.camera_normal || s.aovs.distance;
  const bool denoises = !s.denoiser.empty();
  s.records_through_specular =
      name.empty() ? is_path && denoises && !has_layers : name == "diffuse" && (denoises || has_layers);
}

CoatModel parse_coats(const std::string& text) {
  if (text == "lossless") return CoatModel::lossless;
  if (text == "pbrt") return CoatModel::pbrt;
  throw InputError("unknown coats '" + text + "'; use lossless or pbrt");
}

/// A name, which has the radius and the shape of pbrt-v4's defaults, and optionally a comma and another radius.
Filter parse_filter(const std::string& text) {
  const size_t comma = text.find(',');
  const auto named = named_filters().find(text.substr(0, comma));
  if (named == named_filters().end()) {
    std::string names;
    for (const auto& [name, filter] : named_filters()) names += (names.empty() ? "" : ", ") + name;
    throw InputError("unknown pixel filter '" + text + "': it may be " + names +
                     ", with a radius in pixels after a comma if you like");
  }
  Filter filter = named->second;
  if (comma == std::string::npos) return filter;
  const char *const begin = text.data() + comma + 1, *const end = text.data() + text.size();
  double radius = 0;
  const auto [parsed, error] = std::from_chars(begin, end, radius);
  if (error != std::errc() || parsed != end || !(radius > 0 && radius <= max_filter_radius))
    throw InputError("the radius of a pixel filter must be a number above 0 and at most " +
                     std::to_string(static_cast<int>(max_filter_radius)) + " pixels, not '" + std::string(begin, end) +
                     "'");
  filter.x_radius = filter.y_radius = radius;
  return filter;
}

}  // namespace

void apply_settings(const Settings& asked, Scene& scene) {
  if (!asked.coats.empty()) scene.coats = parse_coats(asked.coats);
  if (!asked.filter.empty()) scene.filter = parse_filter(asked.filter);
}

Schedule parse_schedule(const std::string& text) {
  const size_t comma = text.find(',');
  Schedule schedule;
  schedule.kind = by_name(schedules, text.substr(0, comma), "schedule");
  if (comma == std::string::npos) return schedule;
  const std::string chunk = text.substr(comma + 1);
  const auto [end, error] = std::from_chars(chunk.data(), chunk.data() + chunk.size(), schedule.chunk);
  if (error != std::errc() || end != chunk.data() + chunk.size() || schedule.chunk < 1)
    throw InputError("the chunk of a schedule must be a whole number of at least 1, not '" + chunk + "'");
  return schedule;
}

RenderSettings resolve_settings(const Settings& user, const Scene& scene) {
  RenderSettings s;
  s.asked = with_quality(user, scene);
  const Settings& asked = s.asked;
  resolve_image(asked, scene, s);
  s.precision = by_name(precisions, asked.precision, "precision");
  s.integrator = asked.integrator.empty() ? scene.integrator : by_name(integrators, asked.integrator, "integrator");
  s.sampler = asked.sampler.empty() ? scene.sampler : by_name(samplers, asked.sampler, "sampler");
  s.samples_per_pixel =
      static_cast<uint32_t>(in_range(asked.samples_per_pixel ? asked.samples_per_pixel : scene.samples_per_pixel, 1,
                                     max_samples_per_pixel, "the number of samples per pixel"));
  const int64_t depth = in_range(asked.max_depth >= 0 ? asked.max_depth : scene.max_depth, 0, max_bounces, "the depth");
  s.max_segments = static_cast<uint32_t>(depth + 1);
  if ((s.integrator == IntegratorKind::recursive || s.integrator == IntegratorKind::branching) && depth > 1000)
    throw InputError(
        "the integrators 'recursive' and 'branching' call themselves for each bounce: give a depth of at "
        "most 1000, or use 'iterative'");
  s.seed = asked.seed.value_or(scene.seed);
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  s.threads =
      asked.threads == 0 ? processors : static_cast<int>(in_range(asked.threads, 1, 4096, "the number of threads"));
  for (const std::string& layer : asked.aovs) s.aovs.*layer_named(layer) = true;
  if (s.aovs.motion && scene.camera.kind != CameraKind::perspective && scene.camera.kind != CameraKind::orthographic)
    throw InputError("motion vectors need a perspective or orthographic camera: leave out the layer 'motion'");
  s.light_groups = parse_light_groups(asked.light_groups);
  if (!s.light_groups.empty()) s.aovs.light_groups = true;
  if (s.aovs.light_groups && s.integrator != IntegratorKind::path)
    throw InputError("light groups need the integrator 'path', and this is '" + to_string(s.integrator) +
                     "': leave them out, or give --integrator path");
  if (s.aovs.components && s.integrator != IntegratorKind::path)
    throw InputError("components of the light need the integrator 'path', and this is '" + to_string(s.integrator) +
                     "': leave out the layer 'components', or give --integrator path");
  if (asked.time_limit < 0 || !std::isfinite(asked.time_limit)) throw InputError("the time limit must not be negative");
  if (!(asked.checkpoint_seconds >= 0) || !std::isfinite(asked.checkpoint_seconds))
    throw InputError("the time between checkpoints must be a finite number of seconds, not negative");
  resolve_noise(asked, scene, s);
  resolve_guiding(asked, s);
  resolve_background(asked, s);
  check_clamp(asked, s);
  s.texture_budget =
      static_cast<uint64_t>(in_range(asked.texture_budget, 0, int64_t{1} << 30, "the budget of textures")) << 20;
  if (asked.resume && asked.checkpoint.empty())
    throw InputError("to resume, name the file to continue from: --checkpoint FILE");
  if (asked.overwrite && asked.checkpoint.empty())
    throw InputError("--overwrite is for checkpoints: name the file with --checkpoint FILE");
  if (asked.resume && asked.overwrite) throw InputError("give --resume or --overwrite, not both");
  if (!asked.checkpoint.empty()) check_checkpoint(s);
  resolve_denoiser(asked.denoiser, s);
  resolve_aov_surface(asked.aov_surface, s);
  s.schedule = parse_schedule(asked.schedule.empty() ? "dynamic" : asked.schedule);
  choose_backend(asked, s);
  check_threads(asked.threads, s);
  return s;
}

SampleSeed sample_seed(const RenderSettings& settings) {
  if (settings.sampler != SamplerType::zsobol) return settings.seed;
  return {settings.seed, 1 + static_cast<uint32_t>(std::bit_width(settings.samples_per_pixel - 1))};
}

std::span<const NamedLayer> layer_table() { return layers; }

std::string to_string(Precision precision) { return name_of(precisions, precision); }
std::string to_string(GuidingMode mode) { return name_of(guiding_modes, mode); }
std::string to_string(IntegratorKind integrator) { return name_of(integrators, integrator); }
std::string to_string(SamplerType sampler) { return name_of(samplers, sampler); }
std::string to_string(const Schedule& schedule) {
  return name_of(schedules, schedule.kind) + (schedule.chunk > 0 ? "," + std::to_string(schedule.chunk) : "");
}

}  // namespace alhazen::impl
