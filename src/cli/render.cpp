// `alhazen render`: renders a scene file to images.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/display_options.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/listing.h"
#include "cli/live_options.h"
#include "cli/render_options.h"
#include "cli/sequence.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "cli/video.h"
#include "io/read_scene.h"
#include "pipeline/load_scene.h"
#include "render/backend.h"
#include "render/counter_lines.h"
#include "render/renderer.h"
#include "render/setting_table.h"
#include "study/tuned.h"
#include "util/parse_numbers.h"
#include "util/printable.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

ExrCompression parse_compression(const std::string& text) {
  constexpr std::pair<const char*, ExrCompression> names[] = {
      {"zip", ExrCompression::zip},   {"zips", ExrCompression::zips}, {"piz", ExrCompression::piz},
      {"rle", ExrCompression::rle},   {"none", ExrCompression::none}, {"dwaa", ExrCompression::dwaa},
      {"dwab", ExrCompression::dwab},
  };
  std::string choices;
  for (const auto& [name, compression] : names) {
    if (text == name || (text.empty() && compression == ExrCompression::zip)) return compression;
    choices += (choices.empty() ? "" : ", ") + std::string(name);
  }
  throw InputError("unknown compression '" + text + "': it may be " + choices);
}

void check_pixel_type(const std::string& text) {
  if (text != "half" && text != "float") throw InputError("unknown pixel type '" + text + "': it may be half, float");
}

void check_tile_size(const std::string& text) {
  int size = 0;
  if (!parse_number(text, size) || (size != 0 && (size < 8 || size > 1024)))
    throw InputError("--exr-tiles must be a whole number from 8 to 1024 pixels, or 0 for none, not " + quoted(text));
}

void check_statistics(const std::string& text) {
  if (text != "text" && text != "json") throw InputError("unknown statistics '" + text + "': it may be text, json");
}

void check_format(const std::string& text) {
  if (!has_written_extension("image." + text))
    throw InputError("unknown --format '" + text + "': it may be the extension of " + written_extensions());
}

void parse_exr_options(RenderOptions& o) {
  WriteOptions& how = o.output.how;
  how.pixel_type = o.exr_type == "float" ? ExrPixelType::single : ExrPixelType::half;
  how.compression = parse_compression(o.exr_compression);
  const bool loses = how.compression == ExrCompression::dwaa || how.compression == ExrCompression::dwab;
  if (!loses || how.has_parts) return;
  for (const std::string& layer : o.settings.aovs)
    if (layer != "albedo" && layer != "components" && layer != "light_groups" && layer != "noisy")
      throw InputError(
          "the compression '" + o.exr_compression + "' would change the layer '" + layer +
          "', which is data: give --exr-parts as well, and it is stored without loss, or --exr-compression zip");
}

void parse_output_options(RenderOptions& o) {
  parse_display_options(o.display, o.output, o.settings);
  parse_exr_options(o);
}

}  // namespace

void warn_of_options_without_effect(const RenderOptions& o, const RenderSettings& settings, Diagnostics& diagnostics) {
  const std::vector<std::string> formats = o.output.format_names();
  const auto writes = [&](const char* extension) {
    return std::any_of(formats.begin(), formats.end(),
                       [&](const std::string& name) { return extension_of(name) == extension; });
  };
  const auto warn = [&](const std::string& option, const std::string& reason) {
    diagnostics.warn({}, "--" + option + " has no effect: " + reason);
  };
  if (!writes("exr") && !settings.asked.aovs.empty() && settings.denoiser.empty() && settings.asked.checkpoint.empty())
    warn("aov", "only EXR has layers; give -o FILE.exr as well");
  if (!writes("exr") && !settings.light_groups.empty() && settings.asked.checkpoint.empty())
    warn("light-group", "only EXR has layers; give -o FILE.exr as well");
  const WriteOptions& how = o.output.how;
  const std::pair<bool, const char*> of_exr[] = {{!o.exr_type.empty(), "exr-type"},
                                                 {!o.exr_compression.empty(), "exr-compression"},
                                                 {how.has_parts, "exr-parts"},
                                                 {how.tile_size > 0, "exr-tiles"}};
  for (const auto& [is_given, option] : of_exr)
    if (is_given && !writes("exr")) warn(option, "no EXR is written");
  if (settings.asked.transparent_glass && !settings.has_alpha && !settings.aovs.alpha)
    warn("transparent-glass", "the background is not transparent; give --transparent-background as well");
  if (settings.has_alpha && !writes("exr") && !writes("png") && settings.asked.checkpoint.empty())
    diagnostics.warn({}, "only EXR and PNG hold the alpha of --transparent-background; the background becomes black");
  warn_of_display_options(o.display, formats, settings.noise_curve.has_value(), warn);
  if (settings.backend == "serial" && settings.asked.threads > 1)
    warn("threads", "the backend 'serial' takes samples on one; give --backend openmp for more");
}

void WarningPrinter::show() {
  std::string lines;
  for (; shown_ < diagnostics_.warnings().size(); ++shown_)
    lines += "warning: " + diagnostics_.warnings()[shown_].to_string() + "\n";
  if (!lines.empty()) printer_.tell_lines(lines);
}

namespace {

std::string engine_of(const RenderSettings& r) {
  if (!r.runs_on_device) return fmt::format("{} thread{}", r.threads, r.threads == 1 ? "" : "s");
  if (r.device == host_device) return "the host";
  return r.device == all_devices ? fmt::format("{} GPUs", r.threads) : fmt::format("GPU {}", r.device);
}

}  // namespace

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

namespace {

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

}  // namespace

void print_end(const RenderOptions& options, const OutputReport& outputs, const RenderStatistics& statistics,
               const std::string& head, std::optional<int64_t> frame) {
  for (const std::string& failure : outputs.failures) tell("alhazen: {}\n", failure);
  if (!options.quiet) {
    const std::string& quality = statistics.settings.asked.quality;
    std::string line = head + (quality.empty() ? "" : "quality " + quality + ": ") + samples_taken(statistics) +
                       " in " + format_seconds(statistics.render_seconds);
    if (statistics.settings.guiding != GuidingMode::off)
      line += statistics.guiding.is_used          ? "; guided"
              : statistics.guiding.iterations > 0 ? "; guiding ended, as it did not pay"
                                                  : "; not guided: too few samples, or no light";
    if (!statistics.denoiser.empty())
      line += fmt::format("; denoised with {} in {}", statistics.denoiser, format_seconds(statistics.denoise_seconds));
    for (const std::string& path : outputs.written)
      line += (&path == &outputs.written[0] ? "; wrote " : ", ") +
              (path == standard_output_name ? "standard output" : printable(path));
    if (statistics.display && !frame) tell("{}", display_lines(*statistics.display));
    tell("{}\n", line);
  }
  const std::string json = options.stats == "json" ? statistics.to_json() : "";
  if (!json.empty()) print_out("{}\n", frame ? fmt::format("{{\"frame\":{},{}", *frame, json.substr(1)) : json);
  if (options.stats == "text")
    print_out("{}{}", frame ? fmt::format("frame   {}\n", *frame) : "", text_statistics(statistics));
}

namespace {

/// Writes the images and reports the result. An image without samples is not written, since an older one is better.
int finish(RenderOptions& options, Rendering& rendering) {
  const bool is_empty = !rendering.has_samples();
  const std::vector<std::string> formats = options.output.format_names();
  if (!is_empty && std::any_of(formats.begin(), formats.end(), is_displayed_format))
    rendering.statistics.display = choose_display(rendering, options.output.display, options.output.how);
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

/// Standard output can take one image, and nothing beside it.
void check_standard_output(RenderOptions& o) {
  const std::vector<std::string>& paths = o.output.paths;
  const bool is_used = std::find(paths.begin(), paths.end(), standard_output_name) != paths.end();
  if (!o.format.empty()) o.output.standard_output_format = extension_of("image." + o.format);
  if (o.output.standard_output_format == "jpeg") o.output.standard_output_format = "jpg";
  if (!is_used) {
    if (!o.format.empty()) throw InputError("--format is for -o -, and other files have it in their names");
    return;
  }
  if (!o.stats.empty()) throw InputError("-o - and --stats both write to standard output: give one of them a file");
  if (::isatty(STDOUT_FILENO)) throw InputError("-o - writes an image to standard output, which is a terminal");
}

void refuse_video(const std::string& path) {
  if (is_video(path))
    throw InputError({path}, "a video needs more than one frame: give --turntable N, or --frames A..B of an animation");
}

void warn_of_patterns(const RenderOptions& o, Diagnostics& diagnostics) {
  for (const std::string& path : o.output.paths)
    if (FramePattern::is_likely(path))
      diagnostics.warn({path},
                       "one image is rendered, and its name is taken as it is: --frames or --turntable put the "
                       "numbers of frames into names");
}

int run(RenderOptions& options) {
  if (options.list) {
    print_listing(options.scene, options.settings, false);
    return exit_done;
  }
  parse_output_options(options);
  check_standard_output(options);
  check_live_options(options);
  if (options.is_sequence()) return render_sequence(options);
  for (const std::string& path : options.output.paths) refuse_video(path);
  const ProgressStyle style = parse_progress_style(options.progress);
  ProgressPrinter printer(options.quiet ? ProgressStyle::none : style);
  Diagnostics diagnostics;
  ActivityPrinter activity(diagnostics.activity(), printer);
  LoadedScene loaded = load_scene(options.scene, options.settings, diagnostics);
  Scene& scene = loaded.scene;
  const RenderSettings settings = study::resolve_with_tuned(options.settings, scene, options.scene, diagnostics);
  options.output.paths = choose_outputs(options.output.paths, scene.film.filename, options.scene, diagnostics);
  check_sizes(options.output.format_names(), settings.window);
  warn_of_options_without_effect(options, settings, diagnostics);
  warn_of_patterns(options, diagnostics);
  const std::string scene_file = options.scene == standard_input_name ? "" : options.scene;
  check_files(options.output.paths, options.settings.checkpoint,
              {{scene_file, "the scene"}, {options.settings.environment, "the environment map"}}, *loaded.inputs);

  if (scene.film.fits_exposure && options.display.exposure.empty())
    options.output.display.exposure = ExposureRule::fitting;
  WarningPrinter warnings(diagnostics, printer);
  LiveRender live(options, printer, [&](const std::string& warning) {
    diagnostics.warn({}, warning);
    warnings.show();
  });
  RenderEvents events;
  events.watcher = live.begin(shown_name(options.output.paths, options.scene));
  events.progress = [&](const Progress& progress) {
    printer.show(progress);
    live.draw();
    return !is_interrupted();
  };
  events.started = [&](const RenderStatistics& statistics) {
    activity.finish();
    catch_interrupts();
    warnings.show();
    if (options.verbose) print_start(statistics);
  };
  events.warned = [&] { warnings.show(); };
  Rendering rendering = render_scene(std::move(scene), settings, loaded.seconds, events, diagnostics);
  live.finish(rendering);
  printer.finish();
  warnings.show();
  return finish(options, rendering);
}

void add_output_options(Command& command, RenderOptions& o, const char* group) {
  command
      .add_option("-o,--output,--outfile", o.output.paths,
                  "Image to write, " + written_extensions() +
                      ", or - for standard output; of frames NAME_####.png, .mp4 or "
                      ".gif; may be given more than once. Default: as the scene says")
      .repeatable()
      .value_name("FILE")
      .group(group)
      .common();
  command.add_option("--format", o.format, "What -o - writes: png (the default), exr, jpg, hdr or pfm")
      .checked(check_format)
      .value_name("NAME")
      .group(group);
  command.add_option("--exr-type", o.exr_type, "half or float")
      .checked(check_pixel_type)
      .value_name("NAME")
      .group(group);
  command
      .add_option("--exr-compression", o.exr_compression,
                  "zip, zips, piz, rle or none; dwaa and dwab change colours a little")
      .checked([](const std::string& text) { parse_compression(text); })
      .value_name("NAME")
      .group(group);
  command.add_flag("--exr-parts", o.output.how.has_parts, "EXR: write each layer to a part of its own").group(group);
  command.add_option("--exr-tiles", o.output.how.tile_size, "EXR: write tiles with sides of this many pixels")
      .checked(check_tile_size)
      .value_name("N")
      .group(group);
  add_display_options(command, o.display, group);
}

void add_animation_options(Command& command, RenderOptions& o, const char* group) {
  command
      .add_option(
          "--frames",
          [&o](const std::string& text) {
            parse_frame_range(text);  // also an empty one is refused
            o.frames = text;
          },
          "Render these frames, at the times A / fps to B / fps; those that are there are left as they are")
      .value_name("A..B[:STEP]")
      .group(group)
      .common();
  command.add_option("--turntable", o.turntable, "N frames of the camera going round the middle of the scene once")
      .within(int64_t{1}, max_frames)
      .value_name("N")
      .group(group)
      .common();
}

void add_running_options(Command& command, RenderOptions& o, const char* group) {
  command.add_option("--progress", o.progress, "auto (a bar on a terminal), plain, json or none")
      .checked([](const std::string& text) { parse_progress_style(text); })
      .value_name("NAME")
      .group(group);
  command.add_flag("-q,--quiet", o.quiet, "Say nothing but warnings and errors").group(group).common();
  command.add_flag("-v,--verbose", o.verbose, "Say what is rendered and how").group(group);
  command.add_option("--stats", o.stats, "Print what it cost to stdout, as text or as one object (json)")
      .checked(check_statistics)
      .implied("text")
      .value_name("[NAME]")
      .group(group)
      .common();
}

}  // namespace

void register_render(Command& program, int& exit_code) {
  Command command = program.add_subcommand("render", "Render a scene to images");
  auto options = std::make_shared<RenderOptions>();
  command
      .add_option("SCENE", options->scene,
                  "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl); - for pbrt on standard input")
      .required()
      .value_name("");
  Settings& settings = options->settings;
  add_output_options(command, *options, "Output");
  add_setting_options(command, settings, SettingGroup::output, "Output");
  add_setting_options(command, settings, SettingGroup::image, "Image");
  add_setting_options(command, settings, SettingGroup::camera, "Camera");
  add_setting_options(command, settings, SettingGroup::light, "Light");
  add_setting_options(command, settings, SettingGroup::scene, "Scene");
  command.add_flag("--list", options->list, "Print cameras, variants, animations and lights, and render nothing")
      .group("Scene")
      .common();
  add_animation_options(command, *options, "Animation");
  add_setting_options(command, settings, SettingGroup::animation, "Animation");
  add_setting_options(command, settings, SettingGroup::engine, "Engine");
  command.add_option("--config", options->config, "Take options from this file, one a line: spp = 64")
      .value_name("FILE")
      .group("While it runs");
  add_running_options(command, *options, "While it runs");
  add_live_options(command, *options, "While it runs");
  add_setting_options(command, settings, SettingGroup::running, "While it runs");
  command.on_run([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace alhazen::impl
