#include "render/setting_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "render/engine_help.h"
#include "render/quality.h"
#include "scene/limits.h"
#include "util/diagnostics.h"
#include "util/parse_numbers.h"

namespace alhazen::impl {

namespace {

using Text = std::function<std::string(const Settings&)>;
using Set = std::function<void(Settings&, const std::string&)>;

struct Codec {
  Text text;
  Set set;
};

std::string text_of(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

template <class Integer>
std::string text_of(Integer value) {
  return std::to_string(value);
}

[[noreturn]] void refuse(const char* option, const std::string& text, const std::string& wanted) {
  throw InputError("--" + std::string(option) + " must be " + wanted + ", not '" + text + "'");
}

Codec name(std::string Settings::*field) {
  return {[=](const Settings& s) { return s.*field; }, [=](Settings& s, const std::string& text) { s.*field = text; }};
}

Codec flag(bool Settings::*field) {
  return {[=](const Settings& s) { return s.*field ? "true" : ""; },
          [=](Settings& s, const std::string&) { s.*field = true; }};
}

/// A number from `low` to `high`; `open` stands for none.
template <class Number>
Codec number(const char* option, Number Settings::*field, Number open, Number low, Number high) {
  return {[=](const Settings& s) { return s.*field == open ? std::string() : text_of(s.*field); },
          [=](Settings& s, const std::string& text) {
            Number value{};
            if (!parse_number(text, value) || !(value >= low && value <= high))
              refuse(option, text,
                     (std::is_integral_v<Number> ? "a whole number from " : "a number from ") + text_of(low) + " to " +
                         text_of(high));
            s.*field = value;
          }};
}

template <class Number>
Codec optional_number(const char* option, std::optional<Number> Settings::*field, Number low, Number high) {
  return {[=](const Settings& s) { return s.*field ? text_of(*(s.*field)) : std::string(); },
          [=](Settings& s, const std::string& text) {
            Number value{};
            if (!parse_number(text, value) || !(value >= low && value <= high))
              refuse(option, text,
                     (std::is_integral_v<Number> ? "a whole number from " : "a number from ") + text_of(low) + " to " +
                         text_of(high));
            s.*field = value;
          }};
}

/// A time; 0 for none.
Codec seconds(const char* option, double Settings::*field, double high) {
  return {[=](const Settings& s) { return s.*field == 0 ? std::string() : text_of(s.*field); },
          [=](Settings& s, const std::string& text) {
            double value = 0;
            if (!parse_seconds(text, value) || !(value >= 0 && value <= high))
              refuse(option, text, "a time from 0 to " + text_of(high) + " seconds, for example 90, 90s, 1.5min or 2h");
            s.*field = value;
          }};
}

/// Four numbers with commas between them.
template <class Number>
Codec bounds(const char* option, std::optional<std::array<Number, 4>> Settings::*field, const char* wanted) {
  return {[=](const Settings& s) {
            std::string text;
            if (s.*field)
              for (const Number value : *(s.*field)) text += (text.empty() ? "" : ",") + text_of(value);
            return text;
          },
          [=](Settings& s, const std::string& text) {
            std::array<Number, 4> values;
            if (!parse_numbers(text, ',', values)) refuse(option, text, wanted);
            s.*field = values;
          }};
}

/// So many numbers with commas between them, or so many others.
Codec numbers(const char* option, std::vector<double> Settings::*field, size_t few, size_t many, const char* wanted) {
  return {[=](const Settings& s) {
            std::string text;
            for (const double value : s.*field) text += (text.empty() ? "" : ",") + text_of(value);
            return text;
          },
          [=](Settings& s, const std::string& text) {
            std::vector<double> values;
            for (size_t begin = 0; begin <= text.size();) {
              const size_t end = std::min(text.find(',', begin), text.size());
              double value = 0;
              if (!parse_number(std::string_view(text).substr(begin, end - begin), value) || !std::isfinite(value))
                refuse(option, text, wanted);
              values.push_back(value);
              begin = end + 1;
            }
            if (values.size() != few && values.size() != many) refuse(option, text, wanted);
            s.*field = std::move(values);
          }};
}

Codec orbit() {
  constexpr const char* wanted = "AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,DISTANCE, degrees and a distance above 0";
  const Codec plain = numbers("orbit", &Settings::orbit, 2, 3, wanted);
  return {plain.text, [=](Settings& s, const std::string& text) {
            plain.set(s, text);
            if (!(std::abs(s.orbit[1]) <= 90) || (s.orbit.size() == 3 && !(s.orbit[2] > 0)))
              refuse("orbit", text, wanted);
          }};
}

Codec size() {
  return {[](const Settings& s) {
            return s.width > 0 ? std::to_string(s.width) + "x" + std::to_string(s.height) : std::string();
          },
          [](Settings& s, const std::string& text) {
            std::array<int64_t, 2> sides;
            if ((!parse_numbers(text, 'x', sides) && !parse_numbers(text, 'X', sides)) || sides[0] < 1 || sides[1] < 1)
              refuse("size", text, "WIDTHxHEIGHT, each at least 1 pixel, for example 800x600");
            s.width = sides[0];
            s.height = sides[1];
          }};
}

Codec checkpoint() {
  return {[](const Settings& s) {
            return s.checkpoint.empty() ? std::string() : s.checkpoint + "," + text_of(s.checkpoint_seconds);
          },
          [](Settings& s, const std::string& text) {
            const size_t comma = text.rfind(',');
            s.checkpoint = text.substr(0, comma);
            const bool has_seconds = comma != std::string::npos;
            if (s.checkpoint.empty() || (has_seconds && !parse_seconds(text.substr(comma + 1), s.checkpoint_seconds)))
              refuse("checkpoint", text, "FILE or FILE,SECONDS");
          }};
}

/// A number, and optionally a comma and what it measures.
Codec noise() {
  return {[](const Settings& s) {
            if (s.noise == 0) return std::string(s.noise_measure == "none" ? "none" : "");
            return text_of(s.noise) + (s.noise_measure.empty() ? "" : "," + s.noise_measure);
          },
          [](Settings& s, const std::string& text) {
            if (text == "none") {
              s.noise = 0;
              s.noise_measure = "none";
              return;
            }
            const size_t comma = text.find(',');
            std::array<double, 1> value;
            const bool has_measure = comma != std::string::npos;
            const std::string measure = has_measure ? text.substr(comma + 1) : "";
            if (!parse_numbers(text.substr(0, comma), ' ', value) || !(value[0] > 0 && value[0] <= 1) ||
                (has_measure && measure != "relative" && measure != "display"))
              refuse("noise", text,
                     "a number above 0 and at most 1, or such a number with ',relative' or ',display' after it, or "
                     "none");
            s.noise = value[0];
            s.noise_measure = measure;
          }};
}

Codec quality() {
  return {[](const Settings& s) { return s.quality; },
          [](Settings& s, const std::string& text) {
            std::string names;
            for (const Quality& each : qualities()) {
              if (text == each.name) s.quality = text;
              names += (names.empty() ? "" : ", ") + std::string(each.name);
            }
            if (s.quality != text || text.empty()) refuse("quality", text, "one of " + names);
          }};
}

/// Folders with colons between them.
Codec folder_list() {
  return {[](const Settings& s) {
            std::string text;
            for (const std::string& folder : s.search_paths) text += (text.empty() ? "" : ":") + folder;
            return text;
          },
          [](Settings& s, const std::string& text) {
            for (size_t begin = 0; begin <= text.size();) {
              const size_t end = std::min(text.find(':', begin), text.size());
              if (begin == end) refuse("search-path", text, "the name of a folder, or several with colons between");
              s.search_paths.push_back(text.substr(begin, end - begin));
              begin = end + 1;
            }
          }};
}

Codec layer_list() {
  return {[](const Settings& s) {
            std::string text;
            for (const std::string& layer : s.aovs) text += (text.empty() ? "" : ",") + layer;
            return text;
          },
          [](Settings& s, const std::string& text) {
            for (size_t begin = 0; begin <= text.size();) {
              const size_t end = std::min(text.find(',', begin), text.size());
              s.aovs.push_back(text.substr(begin, end - begin));
              begin = end + 1;
            }
          }};
}

/// Texts of the form NAME=VALUE, separated by semicolons, since their values may have commas.
Codec definition_list(const char* option, std::vector<std::string> Settings::*field, const char* wanted) {
  return {[=](const Settings& s) {
            std::string text;
            for (const std::string& definition : s.*field) text += (text.empty() ? "" : ";") + definition;
            return text;
          },
          [=](Settings& s, const std::string& text) {
            for (size_t begin = 0; begin <= text.size();) {
              const size_t end = std::min(text.find(';', begin), text.size());
              const std::string definition = text.substr(begin, end - begin);
              const size_t equals = definition.find('=');
              if (equals == std::string::npos || equals == 0) refuse(option, text, wanted);
              (s.*field).push_back(definition);
              begin = end + 1;
            }
          }};
}

SettingEntry entry(SettingGroup group, const char* name, const char* other_flags, const char* value_name,
                   std::string help, Codec codec, bool is_list = false) {
  return {group, name, other_flags, value_name, std::move(help), is_list, std::move(codec.text), std::move(codec.set)};
}

/// An entry whose value changes the samples.
SettingEntry of_samples(std::function<std::string(const RenderSettings&)> text, SettingEntry entry,
                        const char* name = "") {
  entry.of_samples = std::move(text);
  entry.of_samples_name = name;
  return entry;
}

/// An entry whose value may be left out.
SettingEntry with_implied(const char* value, SettingEntry entry) {
  entry.implied = value;
  return entry;
}

/// An entry that --help lists, too.
SettingEntry common(SettingEntry entry) {
  entry.is_common = true;
  return entry;
}

std::string layer_help() {
  std::string names;
  for (const NamedLayer& layer : layer_table()) names += (names.empty() ? "" : ", ") + std::string(layer.name);
  return names + " (before denoising)";
}

std::string layer_names(const RenderSettings& s) {
  std::string names;
  for (const NamedLayer& layer : layer_table())
    if (s.aovs.*layer.is_wanted && layer.is_wanted != &AovSet::noisy)
      names += std::string(names.empty() ? "" : "+") + layer.name;
  return names.empty() ? "none" : names;
}

/// Any denoiser wants the same sums. Empty without one, as in checkpoints of renders that have none.
std::string denoising(const RenderSettings& s) { return s.denoiser.empty() ? "" : "on"; }

std::string window_bounds(const RenderSettings& s) {
  const auto range = [](int from, int to) { return std::to_string(from) + " to " + std::to_string(to); };
  return "pixels " + range(s.window.x0, s.window.x1) + " by " + range(s.window.y0, s.window.y1);
}

std::vector<SettingEntry> output_settings() {
  constexpr SettingGroup group = SettingGroup::output;
  return {
      common(of_samples(layer_names,
                        entry(group, "aov", "", "NAMES",
                              "Layers to add to the EXR, separated by commas: " + layer_help(), layer_list(), true))),
      of_samples(
          [](const RenderSettings& s) { return setting_text(s.asked, "light-group"); },
          entry(
              group, "light-group", "", "NAME=LIGHTS",
              "Layer light_NAME of what these lights give: names of lights and emissive objects (alhazen info), * and "
              "? in them, with commas; repeatable. --aov light_groups alone: a layer for each name",
              definition_list("light-group", &Settings::light_groups,
                              "NAME=LIGHT or NAME=LIGHT,LIGHT, for example key=sun,lamp*"),
              true),
          "light-group"),
      common(with_implied(
          "auto",
          of_samples(denoising,
                     entry(group, "denoise", "", "[NAME]",
                           "Denoise the image by optix (NVIDIA GPUs), oidn (if its library is here), builtin (any "
                           "machine), or none; without a name by the best that is here",
                           name(&Settings::denoiser)),
                     "denoising"))),
      of_samples([](const RenderSettings& s) { return s.records_through_specular ? "diffuse" : ""; },
                 entry(group, "aov-surface", "", "NAME",
                       "Whose albedo, normals and distance: the first surface's, or those of the first that is not "
                       "perfectly specular, through glass and in mirrors (diffuse); denoising uses diffuse unless one "
                       "of these layers is asked for",
                       name(&Settings::aov_surface)),
                 "aov-surface"),
      common(of_samples([](const RenderSettings& s) { return s.has_alpha ? "on" : ""; },
                        entry(group, "transparent-background", "", "",
                              "Leave the background out: EXR gets a channel A (premultiplied), PNG straight alpha",
                              flag(&Settings::transparent_background)),
                        "transparent-background")),
      of_samples(
          [](const RenderSettings& s) { return s.asked.transparent_glass ? "on" : ""; },
          entry(group, "transparent-glass", "", "", "See the transparent background through specular glass as well",
                flag(&Settings::transparent_glass)),
          "transparent-glass"),
  };
}

std::string order_of_samples(const RenderSettings& s) {
  const uint32_t order = sample_seed(s).screen_order;
  return to_string(s.sampler) + (order > 0 ? " for up to " + std::to_string(1u << (order - 1)) + " samples" : "");
}

/// Empty without a target, as in checkpoints of renders that have none.
std::string noise_target(const RenderSettings& s) {
  if (s.asked.noise == 0) return {};
  if (!s.noise_curve) return text_of(s.asked.noise) + " relative";
  return text_of(s.asked.noise) + " displayed at " +
         (s.noise_exposure == ExposureRule::given     ? "exposure " + text_of(s.asked.noise_exposure.value_or(0))
          : s.noise_exposure == ExposureRule::fitting ? "the image's exposure"
                                                      : "automatic exposure") +
         " by tone map " + (s.asked.noise_tone_map.empty() ? "none" : s.asked.noise_tone_map);
}

std::string quality_help() {
  std::string text = "Samples, noise threshold and denoiser at once: draft, good or final";
  for (const Quality& quality : qualities()) {
    text += "; " + std::string(quality.name) + " (" + quality.help + "): --spp " +
            std::to_string(quality.samples_per_pixel) +
            (quality.noise > 0 ? " --noise " + text_of(quality.noise) + ",display" : "") + " --denoise " +
            quality.denoiser;
  }
  return text + ". Options beside it count. glTF: good, unless --spp, --noise or --denoise is given";
}

/// Empty without guiding, as in checkpoints of renders that have none.
std::string guiding_of(const RenderSettings& s) {
  if (s.guiding == GuidingMode::off) return {};
  return to_string(s.guiding) + " with " + std::to_string(s.guiding_memory >> 20) + " MiB";
}

std::vector<SettingEntry> image_settings() {
  constexpr SettingGroup group = SettingGroup::image;
  return {
      common(entry(group, "quality", "", "NAME", quality_help(), quality())),
      common(entry(group, "spp", "", "N", "Samples per pixel; with --noise, the most (max samples)",
                   number<int64_t>("spp", &Settings::samples_per_pixel, 0, 1, max_samples_per_pixel))),
      common(of_samples(
          noise_target,
          entry(group, "noise", "", "X[,MEASURE]",
                "Noise threshold (adaptive sampling): take no more samples of pixels whose estimated error is "
                "below X: relative (0.05 is 5 percent; the default), or of the displayed value from 0 to 1: "
                "0.01,display; none for no threshold",
                noise()))),
      of_samples(
          guiding_of,
          entry(group, "guiding", "", "NAME",
                "Learn where light comes from while rendering, for scenes lit by way of other surfaces: off, on, or "
                "auto to stop where it does not pay",
                name(&Settings::guiding))),
      entry(group, "guiding-memory", "", "MIB", "What --guiding may take (256)",
            number<int64_t>("guiding-memory", &Settings::guiding_memory, 256, 1, 1 << 20)),
      of_samples(
          [](const RenderSettings& s) { return s.asked.clamp_indirect > 0 ? text_of(s.asked.clamp_indirect) : ""; },
          entry(group, "clamp-indirect", "", "X",
                "Limit each contribution of indirect light to X, against bright dots: the image gets darker than it "
                "should be; 0: no limit, the default",
                number("clamp-indirect", &Settings::clamp_indirect, 0.0, 0.0, 1e30))),
      common(of_samples([](const RenderSettings& s) { return std::to_string(s.max_segments - 1); },
                        entry(group, "max-depth", "--maxdepth", "N", "Bounces: a path has at most N + 1 segments",
                              number<int64_t>("max-depth", &Settings::max_depth, -1, 0, max_bounces)))),
      common(
          of_samples([](const RenderSettings& s) { return std::to_string(s.width) + "x" + std::to_string(s.height); },
                     entry(group, "size", "", "WxH", "Pixels of the whole image", size()))),

      of_samples(window_bounds,
                 entry(group, "crop", "--cropwindow", "X0,X1,Y0,Y1", "Render this part only, fractions from 0 to 1",
                       bounds("crop", &Settings::crop_window, "x0,x1,y0,y1, fractions of the image from 0 to 1"))),
      entry(group, "pixelbounds", "", "X0,X1,Y0,Y1", "Render these pixels only",
            bounds("pixelbounds", &Settings::pixel_bounds, "x0,x1,y0,y1, in pixels")),
      of_samples([](const RenderSettings& s) { return to_string(s.integrator); },
                 entry(group, "integrator", "", "NAME",
                       "path (next-event estimation), or BSDF sampling alone: iterative, recursive, branching",
                       name(&Settings::integrator))),
      common(
          entry(SettingGroup::camera, "look-at", "", "EX,EY,EZ,LX,LY,LZ[,UX,UY,UZ]",
                "Put the camera at E, looking at L, with U upwards",
                numbers("look-at", &Settings::look_at, 6, 9, "six or nine numbers: position, target and the way up"))),
      common(entry(
          SettingGroup::camera, "orbit", "", "AZIMUTH,ELEVATION[,DISTANCE]",
          "Look at the middle of the scene from there, in degrees from the front and upwards; without a distance from "
          "where the whole scene is seen",
          orbit())),
      common(entry(SettingGroup::camera, "fit", "", "", "Move the camera to where the whole scene is seen",
                   flag(&Settings::fit))),
      common(entry(SettingGroup::camera, "fov", "", "DEGREES", "Field of view over the shorter side of the image",
                   optional_number("fov", &Settings::fov, 1e-3, 179.0))),
      entry(SettingGroup::camera, "aperture", "", "RADIUS", "Radius of the lens in scene units; 0: all is sharp",
            optional_number("aperture", &Settings::aperture, 0.0, 1e9)),
      entry(SettingGroup::camera, "focus", "", "DISTANCE", "Distance of what is sharp",
            optional_number("focus", &Settings::focus, 1e-9, 1e12)),
      entry(group, "filter", "", "NAME[,RADIUS]",
            "Pixel filter: box, triangle, gaussian, mitchell or sinc, and its radius in pixels: box,0.5",
            name(&Settings::filter)),
      common(
          entry(SettingGroup::light, "environment", "", "FILE",
                "Light the scene by this map (EXR, HDR, ...) instead of its infinite lights: 2:1 (equirectangular) or "
                "square (octahedral), +y up, its centre towards -z",
                name(&Settings::environment))),
      entry(SettingGroup::light, "environment-rotate", "", "DEGREES",
            "Turn environment maps about their zeniths, counter-clockwise from above",
            number("environment-rotate", &Settings::environment_rotation, 0.0, -1e6, 1e6)),
      entry(SettingGroup::light, "environment-strength", "", "X",
            "Multiply environment maps and the light of skies by X",
            number("environment-strength", &Settings::environment_strength, 1.0, 0.0, 1e9)),
      entry(SettingGroup::light, "light-scale", "", "X", "Multiply all other lights by X",
            number("light-scale", &Settings::light_scale, 1.0, 0.0, 1e9)),
      entry(SettingGroup::scene, "coats", "", "NAME",
            "pbrt: lossless coats (the default), or ones that lose as much light as in pbrt-v4: pbrt",
            name(&Settings::coats)),
      common(entry(SettingGroup::camera, "camera", "", "NAME", "glTF: the camera of this name or number; see --list",
                   name(&Settings::camera))),
      common(entry(SettingGroup::scene, "variant", "", "NAME",
                   "glTF: the materials of this variant, by name or number; without it each mesh's own",
                   name(&Settings::variant))),
      entry(SettingGroup::scene, "define", "-D", "NAME=VALUE",
            "Mitsuba: what $NAME stands for in the scene; may be repeated",
            definition_list("define", &Settings::definitions, "NAME=VALUE, for example spp=64"), true),
      common(entry(SettingGroup::scene, "confine", "", "",
                   "Read no files outside the folder of the scene: for untrusted scenes", flag(&Settings::confine))),
      common(
          entry(SettingGroup::scene, "search-path", "", "DIR[:DIR]",
                "Look for files that the scene names in these folders too, after its own; may be given more than once",
                folder_list(), true)),
      entry(SettingGroup::scene, "strict", "", "",
            "A texture image that is not there is an error, instead of magenta and a warning", flag(&Settings::strict)),
      of_samples(order_of_samples, entry(group, "sampler", "", "NAME",
                                         "sobol, zsobol (noise that looks finer; plans for --spp samples, which a "
                                         "checkpoint cannot change) or independent",
                                         name(&Settings::sampler))),
      common(of_samples([](const RenderSettings& s) { return std::to_string(s.seed); },
                        entry(group, "seed", "", "N", "Seed of the random numbers",
                              optional_number("seed", &Settings::seed, uint32_t{0}, ~uint32_t{0})))),
  };
}

std::vector<SettingEntry> animation_settings() {
  constexpr SettingGroup group = SettingGroup::animation;
  return {
      common(entry(group, "time", "", "SECONDS", "The scene at this time of its animation or motion",
                   optional_number("time", &Settings::animation_time, -1e9, 1e9))),
      entry(group, "animation", "", "NAME", "glTF: the animation of this name or number, for --time and --frames",
            name(&Settings::animation)),
      entry(group, "fps", "", "F", "Frames per second (24)",
            number("fps", &Settings::frames_per_second, 24.0, 1e-3, 1e6)),
      entry(group, "shutter", "", "S",
            "Motion blur: the fraction of a frame's time for which the shutter is open, 0 to 1; glTF: 0 unless given",
            optional_number("shutter", &Settings::shutter, 0.0, 1.0)),
  };
}

/// Backends that have the same kind give the same bits.
std::string kind_of_bits(const RenderSettings& s) {
  if (s.backend == "serial" || s.backend == "openmp") return "serial or openmp";
  return s.backend == "cuda" && s.device == host_device ? "cuda on the host" : s.backend;
}

std::vector<SettingEntry> engine_settings() {
  constexpr SettingGroup group = SettingGroup::engine;
  return {
      common(of_samples(kind_of_bits, entry(group, "backend", "", "NAME", backend_help(), name(&Settings::backend)))),
      entry(group, "strategy", "", "NAME", strategy_help(), name(&Settings::strategy)),
      entry(group, "schedule", "", "KIND[,CHUNK]", "openmp, embree: static, dynamic or guided, and a chunk: dynamic,4",
            name(&Settings::schedule)),
      entry(group, "device", "", "N", "cuda, optix: number of the GPU, or all; cuda: host runs the kernels on the CPU",
            name(&Settings::device)),
      entry(group, "block", "", "WxH", "cuda, pixel and chunk: threads per block (16x16)", name(&Settings::block)),
      entry(group, "chunk", "", "WxH", "cuda, chunk: chunks in each direction (4x4)", name(&Settings::chunk)),
      common(entry(group, "threads", "-t,--nthreads", "N", "Threads; 0 for all",
                   number("threads", &Settings::threads, 0, 0, 4096))),
      of_samples([](const RenderSettings& s) { return to_string(s.precision); },
                 entry(group, "precision", "", "NAME", "float or double", name(&Settings::precision))),
  };
}

std::vector<SettingEntry> running_settings() {
  constexpr SettingGroup group = SettingGroup::running;
  return {
      common(entry(group, "time-limit", "", "SECONDS",
                   "Stop rendering an image after this time at most (90, 1.5min, 2h), and write the samples so far",
                   seconds("time-limit", &Settings::time_limit, 1e9))),
      entry(group, "texture-budget", "", "MIB", "Halve the largest texture images until all fit; 0: no limit (16384)",
            number<int64_t>("texture-budget", &Settings::texture_budget, -1, 0, 1 << 30)),
      entry(group, "checkpoint", "", "FILE[,SECONDS]", "Save the state at this interval (60)", checkpoint()),
      entry(group, "resume", "", "", "Continue from the checkpoint file", flag(&Settings::resume)),
      entry(group, "overwrite", "", "",
            "Replace the file of --checkpoint, whatever it contains; render frames again that are there",
            flag(&Settings::overwrite)),
  };
}

}  // namespace

const std::vector<SettingEntry>& setting_table() {
  static const std::vector<SettingEntry> table = [] {
    std::vector<SettingEntry> all;
    for (auto* part : {output_settings, image_settings, animation_settings, engine_settings, running_settings})
      for (SettingEntry& each : part()) all.push_back(std::move(each));
    return all;
  }();
  return table;
}

const SettingEntry& setting_entry(std::string_view name) {
  for (const SettingEntry& each : setting_table())
    if (each.name == name) return each;
  throw std::logic_error("there is no setting '" + std::string(name) + "'");
}

void check_setting(const Settings& settings, std::string_view name) {
  const SettingEntry& entry = setting_entry(name);
  Settings checked;
  if (const std::string text = entry.text(settings); !text.empty()) entry.set(checked, text);
}

}  // namespace alhazen::impl
