#include "render/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "render/backend.h"
#include "render/counter_lines.h"

namespace alhazen::impl {

namespace {

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

nlohmann::ordered_json light_samples_json(const std::vector<LightSampleLine>& lines) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const auto& [kind, counts] : lines)
    j[kind] = {{"drawn", counts.drawn},
               {"unlit", counts.unlit},
               {"black", counts.black},
               {"shadow_rays", counts.shadow_rays()},
               {"blocked", counts.blocked}};
  return j;
}

nlohmann::ordered_json counters_json(const SampleCounters& counters) {
  const CounterLines lines = counter_lines(counters);
  nlohmann::ordered_json bsdf = nlohmann::ordered_json::object();
  for (const auto& [kind, counts] : lines.bsdf)
    bsdf[kind] = {{"drawn", counts.drawn}, {"black", counts.black}, {"roulette", counts.roulette}};
  return {{"light_samples_by_light", light_samples_json(lines.by_light)},
          {"light_samples_by_closure", light_samples_json(lines.by_closure)},
          {"bsdf_samples", bsdf}};
}

}  // namespace

uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

double RenderStatistics::mean_segments() const {
  return ratio(static_cast<double>(rays), static_cast<double>(camera_samples));
}

double RenderStatistics::msamples_per_second() const {
  return ratio(static_cast<double>(camera_samples) * 1e-6, render_seconds);
}

double RenderStatistics::mrays_per_second() const {
  return ratio(static_cast<double>(rays + shadow_rays) * 1e-6, render_seconds);
}

std::string RenderStatistics::to_json() const {
  nlohmann::ordered_json j;
  j["scene"] = scene;
  j["backend"] = settings.backend;
  j["strategy"] = strategy_name(settings);
  j["precision"] = to_string(settings.precision);
  for (const auto& [name, value] : make_backend(settings.backend)->named_settings(settings)) j[name] = value;
  j["threads"] = settings.threads;
  j["integrator"] = to_string(settings.integrator);
  j["sampler"] = to_string(settings.sampler);
  j["seed"] = settings.seed;
  j["width"] = settings.window.width();
  j["height"] = settings.window.height();
  j["quality"] = settings.asked.quality.empty() ? "none" : settings.asked.quality;
  j["spp"] = samples_per_pixel;
  j["mean_spp"] = mean_samples;
  if (settings.asked.noise > 0)
    j["noise"] = {{"target", settings.asked.noise}, {"measure", settings.noise_curve ? "display" : "relative"},
                  {"reached", noise.noise},         {"pixels_below", noise.below},
                  {"mean_spp", noise.mean_samples}, {"most_spp", settings.samples_per_pixel}};
  if (settings.asked.clamp_indirect > 0) j["clamp_indirect"] = settings.asked.clamp_indirect;
  if (settings.guiding != GuidingMode::off)
    j["guiding"] = {
        {"mode", to_string(settings.guiding)}, {"used", guiding.is_used}, {"iterations", guiding.iterations},
        {"regions", guiding.regions},          {"bytes", guiding.bytes},  {"variance_ratio", guiding.gain}};
  j["max_depth"] = settings.max_segments - 1;
  j["triangles"] = scene_sizes.triangles;
  j["spheres"] = scene_sizes.spheres;
  for (const auto& [name, count] : scene_sizes.others) j[name] = count;
  j["lights"] = scene_sizes.lights;
  j["nodes"] = scene_sizes.nodes;
  j["scene_bytes"] = scene_sizes.bytes;
  j["load_seconds"] = load_seconds;
  j["build_seconds"] = build_seconds;
  j["render_seconds"] = render_seconds;
  j["denoiser"] = denoiser.empty() ? "none" : denoiser;
  if (!settings.denoiser.empty()) j["denoise_seconds"] = denoise_seconds;
  if (display)
    j["display"] = {{"exposure", display->exposure},
                    {"exposure_is_metered", display->exposure_is_metered},
                    {"white_temperature", display->white_temperature},
                    {"white_is_estimated", display->white_is_estimated},
                    {"tone_map", display->tone_map}};
  j["complete"] = complete;
  j["camera_samples"] = camera_samples;
  j["rays"] = rays;
  j["shadow_rays"] = shadow_rays;
  j["nonfinite_samples"] = nonfinite_samples;
  j["msamples_per_s"] = msamples_per_second();
  j["mrays_per_s"] = mrays_per_second();
  j["mean_segments"] = mean_segments();
  j["peak_rss_bytes"] = peak_rss_bytes;
  if (counts_samples) j["counters"] = counters_json(counters);
  j["thread_statistics"] = nlohmann::ordered_json::array();
  for (const ThreadStatistics& t : threads)
    j["thread_statistics"].push_back({{"busy_seconds", t.busy_seconds}, {"samples", t.samples}});
  // The scene's path may be any bytes; JSON escapes keep them from the terminal.
  return j.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace alhazen::impl
