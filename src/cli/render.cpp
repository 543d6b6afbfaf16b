// `alhazen render`: renders a scene file to images.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/listing.h"
#include "cli/progress.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "pipeline/load_scene.h"
#include "pipeline/write_outputs.h"
#include "render/backend.h"
#include "render/counter_lines.h"
#include "render/renderer.h"
#include "render/setting_table.h"
#include "study/tuned.h"
#include "util/printable.h"

namespace alhazen {

namespace {

struct RenderOptions {
  std::string scene;
  Settings settings;
  OutputOptions output;
  std::string tone_map, exr_type;  ///< empty: none and half
  std::string progress = "auto", stats, config;
  bool quiet = false, verbose = false, list = false;
  std::optional<double> exposure;  ///< absent: may be chosen by the image's brightness
};

void parse_output_options(RenderOptions& o) {
  if (o.exposure) o.output.how.exposure = *o.exposure;
  if (!std::isfinite(o.output.how.exposure)) throw InputError("--exposure must be a finite number of stops");
  if (!o.exr_type.empty() && o.exr_type != "half" && o.exr_type != "float")
    throw InputError("unknown pixel type '" + o.exr_type + "': it may be half, float");
  o.output.how.pixel_type = o.exr_type == "float" ? ExrPixelType::single : ExrPixelType::half;
  if (!o.tone_map.empty() && o.tone_map != "none" && o.tone_map != "reinhard" && o.tone_map != "filmic")
    throw InputError("unknown tone map '" + o.tone_map + "': it may be none, reinhard, filmic");
  o.output.how.tone_map = o.tone_map == "reinhard" ? ToneMap::reinhard
                          : o.tone_map == "filmic" ? ToneMap::filmic
                                                   : ToneMap::none;
  o.settings.noise_exposure = o.exposure;
  o.settings.noise_tone_map = o.tone_map;
  if (!o.stats.empty() && o.stats != "text" && o.stats != "json")
    throw InputError("unknown statistics '" + o.stats + "': it may be text, json");
}

/// Options that change nothing: what they are about is not written, or not used.
void warn_of_options_without_effect(const RenderOptions& o, const RenderSettings& settings, Diagnostics& diagnostics) {
  const auto writes = [&](const char* extension) {
    return std::any_of(o.output.paths.begin(), o.output.paths.end(),
                       [&](const std::string& path) { return extension_of(path) == extension; });
  };
  const auto warn = [&](const std::string& option, const std::string& reason) {
    diagnostics.warn({}, "--" + option + " has no effect: " + reason);
  };
  if (!writes("exr") && !settings.asked.aovs.empty() && settings.denoiser.empty() && settings.asked.checkpoint.empty())
    warn("aov", "only EXR has layers; give -o FILE.exr as well");
  if (!writes("exr") && !o.exr_type.empty()) warn("exr-type", "no EXR is written");
  const bool is_seen = writes("png") || settings.noise_curve;
  if (!is_seen && o.exposure) warn("exposure", "it is for PNG, and the other formats keep the radiance as it is");
  if (!is_seen && !o.tone_map.empty())
    warn("tone-map", "it is for PNG, and the other formats keep the radiance as it is");
  if (settings.backend == "serial" && settings.asked.threads > 1)
    warn("threads", "the backend 'serial' takes samples on one; give --backend openmp for more");
}

/// Prints new warnings each time it is called.
class WarningPrinter {
 public:
  WarningPrinter(const Diagnostics& diagnostics, ProgressPrinter& printer)
      : diagnostics_(diagnostics), printer_(printer) {}

  void show() {
    std::string lines;
    for (; shown_ < diagnostics_.warnings().size(); ++shown_)
      lines += "warning: " + diagnostics_.warnings()[shown_].to_string() + "\n";
    if (!lines.empty()) printer_.tell_lines(lines);
  }

 private:
  const Diagnostics& diagnostics_;
  ProgressPrinter& printer_;
  size_t shown_ = 0;
};

std::string engine_of(const RenderSettings& r) {
  if (!r.runs_on_device) return fmt::format("{} thread{}", r.threads, r.threads == 1 ? "" : "s");
  if (r.device == host_device) return "the host";
  return r.device == all_devices ? fmt::format("{} GPUs", r.threads) : fmt::format("GPU {}", r.device);
}

void print_start(const RenderStatistics& s) {
  const RenderSettings& r = s.settings;
  const std::string strategy = strategy_name(r);
  std::string others;
  for (const auto& [name, count] : s.scene_sizes.others)
    if (count > 0) others += fmt::format(", {} {}", count, name);
  tell("{}: {} triangles, {} spheres{}, {} lights; read in {:.2f} s, BVH of {} nodes in {:.2f} s\n", printable(s.scene),
       s.scene_sizes.triangles, s.scene_sizes.spheres, others, s.scene_sizes.lights, s.load_seconds,
       s.scene_sizes.nodes, s.build_seconds);
  tell("{} x {} pixels, {}{} samples each, {} in {}, depth {}; {}{}{} on {}\n", r.window.width(), r.window.height(),
       r.asked.noise > 0 ? "at most " : "", r.samples_per_pixel, to_string(r.integrator), to_string(r.precision),
       r.max_segments - 1, r.backend, strategy.empty() ? "" : " ", strategy, engine_of(r));
}

std::string guiding_line(const RenderStatistics& s) {
  if (s.settings.guiding == GuidingMode::off) return {};
  const GuidingState& g = s.guiding;
  return fmt::format("guiding {}, {} guided iterations, {} regions, {:.1f} MB{}\n", g.is_used ? "used" : "not used",
                     g.iterations, g.regions, static_cast<double>(g.bytes) * 1e-6,
                     g.gain > 0 ? fmt::format(", variance without it {:.2f} times that with it", g.gain) : "");
}

std::string text_statistics(const RenderStatistics& s) {
  const std::string text = fmt::format(
      "load    {:.3f} s\nbuild   {:.3f} s\nrender  {:.3f} s\ndenoise {:.3f} s\nsamples {} ({:.3f} million per second)\n"
      "rays    {} and {} shadow rays ({:.3f} million per second)\nbounces {:.3f} segments per path\nmemory  {:.1f} MB "
      "at "
      "most, {:.1f} MB of it the scene\n",
      s.load_seconds, s.build_seconds, s.render_seconds, s.denoise_seconds, s.camera_samples, s.msamples_per_second(),
      s.rays, s.shadow_rays, s.mrays_per_second(), s.mean_segments(), static_cast<double>(s.peak_rss_bytes) * 1e-6,
      static_cast<double>(s.scene_sizes.bytes) * 1e-6);
  const std::string noise = s.settings.asked.noise > 0
                                ? fmt::format(
                                      "noise   {:.4g} of a target of {}; {:.2f} % of the pixels are below it, "
                                      "by {:.2f} samples on average, at most {}\n",
                                      s.noise.noise, setting_text(s.settings.asked, "noise"), 100 * s.noise.below,
                                      s.noise.mean_samples, s.samples_per_pixel)
                                : "";
  return text + noise + guiding_line(s) + (counts_samples ? counter_table(s.counters) : "");
}

std::string samples_taken(const RenderStatistics& s) {
  if (s.settings.asked.noise == 0)
    return s.mean_samples == s.samples_per_pixel ? fmt::format("{} samples per pixel", s.samples_per_pixel)
                                                 : fmt::format("{:.1f} samples per pixel on average", s.mean_samples);
  return fmt::format("{:.1f} samples per pixel, at most {}, noise {:.3g}, {:.1f} % of the pixels below {}",
                     s.noise.mean_samples, s.samples_per_pixel, s.noise.noise, 100 * s.noise.below,
                     setting_text(s.settings.asked, "noise"));
}

void print_end(const RenderOptions& options, const OutputReport& outputs, const RenderStatistics& statistics) {
  for (const std::string& failure : outputs.failures) tell("alhazen: {}\n", failure);
  if (!options.quiet) {
    const std::string& quality = statistics.settings.asked.quality;
    std::string line = (quality.empty() ? "" : "quality " + quality + ": ") + samples_taken(statistics) + " in " +
                       format_seconds(statistics.render_seconds);
    if (statistics.settings.guiding != GuidingMode::off)
      line += statistics.guiding.is_used          ? "; guided"
              : statistics.guiding.iterations > 0 ? "; guiding ended, as it did not pay"
                                                  : "; not guided: too few samples, or no light";
    if (!statistics.denoiser.empty())
      line += fmt::format("; denoised with {} in {}", statistics.denoiser, format_seconds(statistics.denoise_seconds));
    for (const std::string& path : outputs.written)
      line += (&path == &outputs.written[0] ? "; wrote " : ", ") + printable(path);
    if (!options.exposure && options.output.how.exposure < 0)
      line += fmt::format("; PNG with --exposure {}", options.output.how.exposure);
    tell("{}\n", line);
  }
  if (options.stats == "json") print_out("{}\n", statistics.to_json());
  if (options.stats == "text") print_out("{}", text_statistics(statistics));
}

/// Writes the images and reports the result. An image without samples is not written, since an older one is better.
int finish(RenderOptions& options, const Rendering& rendering, bool fits_exposure) {
  const bool is_empty = !rendering.has_samples();
  const auto is_png = [](const std::string& path) { return extension_of(path) == "png"; };
  if (fits_exposure && std::any_of(options.output.paths.begin(), options.output.paths.end(), is_png))
    options.output.how.exposure = fitting_exposure(rendering.source());
  const OutputReport outputs = is_empty ? OutputReport{} : write_outputs(options.output, rendering);
  print_end(options, outputs, rendering.statistics);
  if (!outputs.failures.empty()) return exit_failed;
  if (!is_interrupted() && is_empty)
    tell("alhazen: the time limit passed before the first sample: no image is written\n");
  if (!is_interrupted()) return is_empty ? exit_failed : exit_done;
  tell("interrupted{}\n", is_empty                        ? " before the first sample: no image is written"
                          : rendering.statistics.complete ? ", but the image is complete"
                                                          : ": the image has the samples so far");
  return exit_interrupted;
}

int run(RenderOptions& options) {
  if (options.list) {
    print_listing(options.scene, options.settings, false);
    return exit_done;
  }
  parse_output_options(options);
  const ProgressStyle style = parse_progress_style(options.progress);
  ProgressPrinter printer(options.quiet ? ProgressStyle::none : style);
  Diagnostics diagnostics;
  ActivityPrinter activity(diagnostics.activity(), printer);
  LoadedScene loaded = load_scene(options.scene, options.settings, diagnostics);
  Scene& scene = loaded.scene;
  const RenderSettings settings = study::resolve_with_tuned(options.settings, scene, options.scene, diagnostics);
  options.output.paths = choose_outputs(options.output.paths, scene.film.filename, options.scene, diagnostics);
  warn_of_options_without_effect(options, settings, diagnostics);
  check_files(options.output.paths, options.settings.checkpoint,
              {{options.scene, "the scene"}, {options.settings.environment, "the environment map"}}, *loaded.inputs);

  const bool fits_exposure = scene.film.fits_exposure && !options.exposure;
  WarningPrinter warnings(diagnostics, printer);
  RenderEvents events;
  events.progress = [&](const Progress& progress) {
    printer.show(progress);
    return !is_interrupted();
  };
  events.started = [&](const RenderStatistics& statistics) {
    activity.finish();
    catch_interrupts();
    warnings.show();
    if (options.verbose) print_start(statistics);
  };
  events.warned = [&] { warnings.show(); };
  const Rendering rendering = render_scene(std::move(scene), settings, loaded.seconds, events, diagnostics);
  printer.finish();
  warnings.show();
  return finish(options, rendering, fits_exposure);
}

void add_output_options(Command& command, RenderOptions& o, const char* group) {
  command
      .add_option(
          "-o,--output,--outfile", o.output.paths,
          "Image to write, " + written_extensions() + "; may be given more than once. Default: as the scene says")
      .repeatable()
      .value_name("FILE")
      .group(group);
  command.add_option("--exr-type", o.exr_type, "half or float").value_name("NAME").group(group);
  command.add_option("--exposure", o.exposure, "PNG: brightness; a stop doubles it").value_name("STOPS").group(group);
  command.add_option("--tone-map", o.tone_map, "PNG: none, reinhard or filmic").value_name("NAME").group(group);
}

void add_running_options(Command& command, RenderOptions& o, const char* group) {
  command.add_option("--progress", o.progress, "auto (a bar on a terminal), plain, json or none")
      .value_name("NAME")
      .group(group);
  command.add_flag("-q,--quiet", o.quiet, "Say nothing but warnings and errors").group(group);
  command.add_flag("-v,--verbose", o.verbose, "Say what is rendered and how").group(group);
  command.add_option("--stats", o.stats, "Print what it cost to stdout, as text or as one object (json)")
      .implied("text")
      .value_name("[NAME]")
      .group(group);
}

}  // namespace

void register_render(Command& program, int& exit_code) {
  Command command = program.add_subcommand("render", "Render a scene to images");
  auto options = std::make_shared<RenderOptions>();
  command.add_option("SCENE", options->scene, "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl)")
      .required()
      .value_name("");
  Settings& settings = options->settings;
  add_output_options(command, *options, "Output");
  add_setting_options(command, settings, SettingGroup::output, "Output");
  add_setting_options(command, settings, SettingGroup::image, "Image");
  command.add_flag("--list", options->list, "Print cameras, variants, animations and lights, and render nothing")
      .group("Image");
  add_setting_options(command, settings, SettingGroup::engine, "Engine");
  command.add_option("--config", options->config, "Take options from this file, one a line: spp = 64")
      .value_name("FILE")
      .group("While it runs");
  add_running_options(command, *options, "While it runs");
  add_setting_options(command, settings, SettingGroup::running, "While it runs");
  command.on_run([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace alhazen
