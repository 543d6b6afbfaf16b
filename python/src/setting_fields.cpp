#include "setting_fields.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "convert.h"

namespace alhazen::python {

namespace {

using Settings = alhazen::Settings;

int64_t integer_from(const char* name, const py::handle& value, int64_t low, int64_t high) {
  return integer(name, value, low, high);
}

double real_from(const char* name, const py::handle& value) {
  const double real = number(name, value);
  if (!std::isfinite(real)) refuse(name, "must be finite");
  return real;
}

py::sequence sequence_from(const char* name, const char* wanted, const py::handle& value) {
  if (!is_sequence(value)) refuse_given(name, wanted, value);
  return py::reinterpret_borrow<py::sequence>(value);
}

/// Numbers; sequences within are flattened, so that points may be given as such.
void append_reals(const char* name, const py::handle& value, std::vector<double>& numbers) {
  for (const py::handle each : sequence_from(name, "a sequence of numbers", value))
    is_sequence(each) ? append_reals(name, each, numbers) : numbers.push_back(real_from(name, each));
}

std::vector<std::string> texts_from(const char* name, const py::handle& value) {
  std::vector<std::string> texts;
  for (const py::handle each : sequence_from(name, "a sequence of str", value)) texts.push_back(text(name, each));
  return texts;
}

py::tuple tuple_of(const std::vector<std::string>& texts) {
  py::tuple tuple(texts.size());
  for (size_t i = 0; i < texts.size(); ++i) tuple[i] = texts[i];
  return tuple;
}

/// Sets the member to its default for None, else by `from`.
template <class Member, class From>
std::function<void(Settings&, const py::handle&)> setter(Member Settings::*member, From from) {
  return [member, from = std::move(from)](Settings& settings, const py::handle& value) {
    settings.*member = value.is_none() ? Settings().*member : from(value);
  };
}

SettingField text_field(const char* name, std::string Settings::*member, const char* help) {
  return {name, "str", help, [=](const Settings& s) { return py::cast(s.*member); },
          setter(member, [=](const py::handle& value) { return text(name, value); })};
}

/// A name, or a number as one.
SettingField name_or_number_field(const char* name, std::string Settings::*member, const char* help) {
  return {name, "str | int", help, [=](const Settings& s) { return py::cast(s.*member); },
          setter(member, [=](const py::handle& value) {
            return py::isinstance<py::str>(value)
                       ? text(name, value)
                       : std::to_string(integer_from(name, value, 0, std::numeric_limits<int32_t>::max()));
          })};
}

SettingField path_field(const char* name, std::string Settings::*member, const char* help) {
  return {name, "str | os.PathLike", help, [=](const Settings& s) { return py::object(path_text(s.*member)); },
          setter(member, [=](const py::handle& value) { return file_name(name, value); })};
}

SettingField flag_field(const char* name, bool Settings::*member, const char* help) {
  return {name, "bool", help, [=](const Settings& s) { return py::object(py::bool_(s.*member)); },
          setter(member, [=](const py::handle& value) { return flag(name, value); })};
}

template <class Integer>
SettingField integer_field(const char* name, Integer Settings::*member, const char* help, int64_t low = 0) {
  const int64_t high = std::numeric_limits<Integer>::max();
  return {name, "int", help, [=](const Settings& s) { return py::object(py::int_(s.*member)); },
          setter(member,
                 [=](const py::handle& value) { return static_cast<Integer>(integer_from(name, value, low, high)); })};
}

SettingField real_field(const char* name, double Settings::*member, const char* help) {
  return {name, "float", help, [=](const Settings& s) { return py::object(py::float_(s.*member)); },
          setter(member, [=](const py::handle& value) { return real_from(name, value); })};
}

SettingField optional_real_field(const char* name, std::optional<double> Settings::*member, const char* help) {
  return {name, "float | None", help,
          [=](const Settings& s) { return s.*member ? py::object(py::float_(*(s.*member))) : py::none(); },
          setter(member, [=](const py::handle& value) { return std::optional(real_from(name, value)); })};
}

SettingField reals_field(const char* name, const char* type, std::vector<double> Settings::*member, const char* help) {
  return {name, type, help,
          [=](const Settings& s) {
            py::tuple tuple((s.*member).size());
            for (size_t i = 0; i < tuple.size(); ++i) tuple[i] = (s.*member)[i];
            return py::object(std::move(tuple));
          },
          setter(member, [=](const py::handle& value) {
            std::vector<double> numbers;
            append_reals(name, value, numbers);
            return numbers;
          })};
}

SettingField texts_field(const char* name, std::vector<std::string> Settings::*member, const char* help) {
  return {name, "Sequence[str]", help, [=](const Settings& s) { return py::object(tuple_of(s.*member)); },
          setter(member, [=](const py::handle& value) { return texts_from(name, value); })};
}

/// Texts of the form NAME=VALUE; also a dict, whose values may be sequences, which are joined by commas.
SettingField assignments_field(const char* name, std::vector<std::string> Settings::*member, const char* help) {
  return {name, "Mapping[str, object] | Sequence[str]", help,
          [=](const Settings& s) { return py::object(tuple_of(s.*member)); },
          setter(member, [=](const py::handle& value) {
            if (!py::isinstance<py::dict>(value)) return texts_from(name, value);
            std::vector<std::string> texts;
            for (const auto& [key, each] : py::reinterpret_borrow<py::dict>(value)) {
              std::string joined;
              if (py::isinstance<py::list>(each) || py::isinstance<py::tuple>(each)) {
                for (const std::string& part : texts_from(name, each)) joined += (joined.empty() ? "" : ",") + part;
              } else {
                joined = py::cast<std::string>(py::str(each));
              }
              texts.push_back(text(name, key) + "=" + joined);
            }
            return texts;
          })};
}

SettingField paths_field(const char* name, std::vector<std::string> Settings::*member, const char* help) {
  return {name, "Sequence[str | os.PathLike]", help, [=](const Settings& s) { return py::object(tuple_of(s.*member)); },
          setter(member, [=](const py::handle& value) {
            std::vector<std::string> folders;
            if (is_file_name(value)) return std::vector{file_name(name, value)};
            for (const py::handle each : sequence_from(name, "a sequence of paths", value))
              folders.push_back(file_name(name, each));
            return folders;
          })};
}

/// Four numbers.
template <class Number>
SettingField bounds_field(const char* name, std::optional<std::array<Number, 4>> Settings::*member, const char* type,
                          const char* help) {
  return {name, type, help,
          [=](const Settings& s) -> py::object {
            if (!(s.*member)) return py::none();
            const auto& b = *(s.*member);
            return py::make_tuple(b[0], b[1], b[2], b[3]);
          },
          setter(member, [=](const py::handle& value) {
            const py::sequence four = sequence_from(name, "four numbers x0, x1, y0, y1", value);
            if (four.size() != 4) refuse_given(name, "four numbers x0, x1, y0, y1", value);
            std::array<Number, 4> values;
            for (size_t i = 0; i < 4; ++i) {
              if constexpr (std::is_integral_v<Number>)
                values[i] =
                    integer_from(name, four[i], std::numeric_limits<Number>::min(), std::numeric_limits<Number>::max());
              else
                values[i] = real_from(name, four[i]);
            }
            return std::optional(values);
          })};
}

SettingField seed_field() {
  return {"seed", "int | None", "Seed of the random numbers; None: that of the scene.",
          [](const Settings& s) { return s.seed ? py::object(py::int_(*s.seed)) : py::none(); },
          setter(&Settings::seed, [](const py::handle& value) {
            return std::optional(static_cast<uint32_t>(integer_from("seed", value, 0, 0xffffffff)));
          })};
}

SettingField size_field() {
  SettingField field{"size", "tuple[int, int]", "`width` and `height` at once.",
                     [](const Settings& s) { return py::object(py::make_tuple(s.width, s.height)); },
                     [](Settings& s, const py::handle& value) {
                       s.width = s.height = 0;
                       if (value.is_none()) return;
                       const py::sequence two = sequence_from("size", "two whole numbers: width, height", value);
                       if (two.size() != 2) refuse_given("size", "two whole numbers: width, height", value);
                       const int64_t high = std::numeric_limits<int32_t>::max();
                       s.width = integer_from("size", two[0], 1, high);
                       s.height = integer_from("size", two[1], 1, high);
                     }};
  field.is_alias = true;
  return field;
}

SettingField alias(const char* name, SettingField field) {
  field.name = name;
  field.is_alias = true;
  return field;
}

}  // namespace

const std::vector<SettingField>& setting_fields() {
  using S = Settings;
  constexpr const char* spp_help =
      "Samples per pixel; with a noise target, the most that a pixel gets. 0: as the scene says.";
  constexpr const char* aovs_help =
      "Additional layers: alpha, albedo, normal, camera_normal, depth, distance, position, uv, motion, object, "
      "material, cryptomatte, components, light_groups, bounces, samples, variance, noisy.";
  static const std::vector<SettingField> fields{
      integer_field("samples_per_pixel", &S::samples_per_pixel, spp_help),
      alias("spp", integer_field("spp", &S::samples_per_pixel, spp_help)),
      integer_field("width", &S::width, "Pixels. 0: as the scene says, or by `height` and the scene's aspect ratio."),
      integer_field("height", &S::height, "Pixels. 0: as the scene says, or by `width` and the scene's aspect ratio."),
      size_field(),
      text_field("quality", &S::quality,
                 "draft, good or final: sets those of spp, noise and denoiser that are left open."),
      real_field("noise", &S::noise,
                 "Noise target, above 0 and at most 1: pixels below it get no more samples. 0: none."),
      text_field("noise_measure", &S::noise_measure, "What `noise` is of: relative, display, or none for no target."),
      optional_real_field("noise_exposure", &S::noise_exposure, "Stops at which a displayed noise target is measured."),
      flag_field("noise_auto_exposure", &S::noise_auto_exposure, "`noise_exposure` is metered from the image so far."),
      text_field("noise_tone_map", &S::noise_tone_map,
                 "Tone map of a displayed noise target: none, reinhard, filmic, aces, agx."),
      text_field("denoiser", &S::denoiser, "none, auto, builtin, oidn or optix."),
      integer_field("max_depth", &S::max_depth,
                    "Bounces: a path has at most max_depth + 1 segments. -1: as the scene says.", -1),
      text_field("integrator", &S::integrator, "path, or BSDF sampling alone: iterative, recursive, branching."),
      text_field("sampler", &S::sampler, "sobol, zsobol or independent."),
      seed_field(),
      text_field("filter", &S::filter,
                 "Pixel filter: box, triangle, gaussian, mitchell or sinc, and its radius: 'box,0.5'."),
      text_field("guiding", &S::guiding, "Path guiding: off, on or auto."),
      integer_field("guiding_memory", &S::guiding_memory, "MiB that guiding may take."),
      real_field("clamp_indirect", &S::clamp_indirect, "Most that a vertex may add of indirect light; 0: no limit."),
      texts_field("aovs", &S::aovs, aovs_help),
      alias("layers", texts_field("layers", &S::aovs, aovs_help)),
      assignments_field("light_groups", &S::light_groups,
                        "Groups of lights, each with a layer: {'key': ['lamp*', 'sun']}, by names with * and ?."),
      text_field("aov_surface", &S::aov_surface,
                 "The surface that albedo, normals and distance are of: first or diffuse."),
      flag_field("transparent_background", &S::transparent_background,
                 "Leaves the background out, and adds a channel A."),
      flag_field("transparent_glass", &S::transparent_glass,
                 "The background is transparent through specular glass, too."),
      bounds_field("crop_window", &S::crop_window, "tuple[float, float, float, float] | None",
                   "Part of the image: x0, x1, y0, y1, fractions of it from 0 to 1."),
      bounds_field("pixel_bounds", &S::pixel_bounds, "tuple[int, int, int, int] | None",
                   "Part of the image: x0, x1, y0, y1, in pixels, half open."),
      name_or_number_field("camera", &S::camera, "glTF: a camera by name, or by number from 0."),
      reals_field("look_at", "Sequence[float]", &S::look_at,
                  "Position of the camera, what it looks at, and perhaps the way up: six or nine numbers, or two or "
                  "three points."),
      reals_field(
          "orbit", "Sequence[float]", &S::orbit,
          "Turns the camera about the middle of the scene: azimuth, elevation (degrees), perhaps the distance."),
      flag_field("fit", &S::fit, "Moves the camera so that it sees the whole scene."),
      optional_real_field("fov", &S::fov, "Degrees over the shorter side of the image."),
      optional_real_field("aperture", &S::aperture, "Radius of the lens in scene units; 0: all is sharp."),
      optional_real_field("focus", &S::focus, "Distance of what is sharp, in scene units."),
      path_field("environment", &S::environment, "Environment map that replaces the infinite lights of the scene."),
      real_field("environment_rotation", &S::environment_rotation,
                 "Of maps about their zeniths: degrees, counter-clockwise."),
      real_field("environment_strength", &S::environment_strength, "Factor on infinite lights."),
      real_field("light_scale", &S::light_scale, "Factor on all other lights."),
      name_or_number_field("variant", &S::variant, "glTF: a variant of materials, by name or number."),
      name_or_number_field("animation", &S::animation, "glTF: an animation, by name or number."),
      optional_real_field("animation_time", &S::animation_time, "Seconds: the scene at this time of its animation."),
      optional_real_field("shutter", &S::shutter,
                          "Motion blur: the fraction of a frame for which the shutter is open, 0 to 1."),
      real_field("frames_per_second", &S::frames_per_second, "Of animations."),
      assignments_field("definitions", &S::definitions, "Mitsuba: {'name': value} for $name in the scene."),
      text_field("coats", &S::coats, "pbrt: lossless, or pbrt to lose as much light as pbrt-v4 does."),
      paths_field("search_paths", &S::search_paths, "Folders in which files are looked for after the scene's own."),
      flag_field("confine", &S::confine, "Reads no files outside the folder of the scene file: for untrusted scenes."),
      flag_field("strict", &S::strict, "A texture image that is missing is an error, not a warning."),
      text_field("backend", &S::backend,
                 "auto, serial, openmp, embree, cuda or optix; alhazen.devices() says what is here."),
      text_field("strategy", &S::strategy, "How the backend divides its work; alhazen.devices() lists them."),
      text_field("schedule", &S::schedule, "openmp, embree: static, dynamic or guided, perhaps with ',CHUNK'."),
      text_field("precision", &S::precision, "float or double."),
      integer_field("threads", &S::threads, "0: all processors."),
      name_or_number_field("device", &S::device, "cuda, optix: number of the GPU, or all; cuda: host for the CPU."),
      text_field("block", &S::block, "cuda, pixel and chunk: threads per block, 'WxH'."),
      text_field("chunk", &S::chunk, "cuda, chunk: chunks in each direction, 'WxH'."),
      integer_field("texture_budget", &S::texture_budget, "MiB that texture images may take; 0: no limit."),
      real_field("time_limit", &S::time_limit, "Seconds of rendering; 0: none."),
      path_field("checkpoint", &S::checkpoint, "File in which to save the state, and from which `resume` continues."),
      real_field("checkpoint_seconds", &S::checkpoint_seconds, "Time between two saves of the checkpoint."),
      flag_field("resume", &S::resume, "Continues from the checkpoint."),
      flag_field("overwrite", &S::overwrite, "Replaces an existing file of `checkpoint`."),
  };
  return fields;
}

}  // namespace alhazen::python
