// The directives Camera and Film.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "io/pbrt/options.h"
#include "io/pbrt/suggestions.h"
#include "util/quoted.h"

namespace alhazen::impl::pbrt {

namespace {

constexpr int32_t max_side = 100'000;
constexpr int64_t max_pixels = 1'000'000'000;

int64_t read_side(ParameterList& list, std::string_view name, int32_t fallback) {
  const int32_t side = list.integer(name, fallback);
  if (side < 1 || side > max_side)
    fail(list.place_of(name),
         "\"" + std::string(name) + "\" is " + std::to_string(side) + "; an image has from 1 to 100000 pixels a side");
  return side;
}

std::array<int64_t, 4> read_pixel_bounds(Build& build, ParameterList& list, const FilmSettings& film) {
  const Place place = list.place_of("pixelbounds");
  const Integers values = list.take_integers("pixelbounds");
  if (values.size() != 4) fail(place, "\"pixelbounds\" takes four values: x0 x1 y0 y1");
  std::array<int64_t, 4> bounds{};
  for (size_t i = 0; i < 4; ++i) bounds[i] = static_cast<int32_t>(values[i]);
  const std::array<int64_t, 4> inside{
      std::clamp<int64_t>(bounds[0], 0, film.width), std::clamp<int64_t>(bounds[1], 0, film.width),
      std::clamp<int64_t>(bounds[2], 0, film.height), std::clamp<int64_t>(bounds[3], 0, film.height)};
  if (inside[0] >= inside[1] || inside[2] >= inside[3])
    fail(place, "\"pixelbounds\" leaves no pixel of the image; it takes x0 x1 y0 y1");
  if (inside != bounds) build.warn(place, "\"pixelbounds\" reaches past the image; it is clipped to it");
  return inside;
}

std::array<int64_t, 4> read_crop_window(ParameterList& list, const FilmSettings& film) {
  const Place place = list.place_of("cropwindow");
  const Numbers values = list.take_numbers("cropwindow");
  if (values.size() != 4) fail(place, "\"cropwindow\" takes four values: x0 x1 y0 y1, from 0 to 1");
  const auto pixel = [](double part, int64_t side) {
    return static_cast<int64_t>(std::ceil(std::clamp(part, 0.0, 1.0) * static_cast<double>(side)));
  };
  const auto [x0, x1] = std::minmax(values[0], values[1]);
  const auto [y0, y1] = std::minmax(values[2], values[3]);
  const std::array<int64_t, 4> bounds{pixel(x0, film.width), pixel(x1, film.width), pixel(y0, film.height),
                                      pixel(y1, film.height)};
  if (bounds[0] >= bounds[1] || bounds[2] >= bounds[3]) fail(place, "\"cropwindow\" leaves no pixel of the image");
  return bounds;
}

/// Reads the scale of the radiance; the simulated sensors are not supported.
void read_sensor(Build& build, ParameterList& list) {
  build.iso = list.positive("iso", 100);
  build.exposure_time.reset();
  if (list.has("exposuretime")) build.exposure_time = list.positive("exposuretime", 1);
  const std::string sensor = list.string("sensor", "cie1931");
  if (sensor != "cie1931")
    build.warn(list.place_of("sensor"),
               "the sensor \"" + sensor + "\" is not supported; the image is as bright, in linear sRGB");
  if (list.number("whitebalance", 0) != 0)
    build.warn(list.place_of("whitebalance"), "\"whitebalance\" is not supported; it is ignored");
  if (list.has("maxcomponentvalue"))
    build.warn(list.place_of("maxcomponentvalue"), "\"maxcomponentvalue\" is not supported; samples are not clamped");
}

void read_window(ParameterList& list, Camera& camera) {
  if (list.has("frameaspectratio")) camera.frame_aspect_ratio = list.positive("frameaspectratio", 1);
  if (!list.has("screenwindow")) return;
  const Place place = list.place_of("screenwindow");
  const Numbers window = list.take_numbers("screenwindow");
  if (window.size() != 4) fail(place, "\"screenwindow\" takes four values: x0 x1 y0 y1");
  if (window[0] == window[1] || window[2] == window[3]) fail(place, "\"screenwindow\" has no area");
  camera.screen_window = {window[0], window[1], window[2], window[3]};
}

void read_lens(ParameterList& list, Camera& camera) {
  camera.lens_radius = list.number("lensradius", 0);
  if (camera.lens_radius < 0) fail(list.place_of("lensradius"), "\"lensradius\" cannot be negative");
  camera.focal_distance = list.positive("focaldistance", 1e6);
}

void read_perspective(Build&, ParameterList& list, Camera& camera) {
  camera.fov = list.number("fov", 90);
  if (!(camera.fov > 0 && camera.fov < 180)) fail(list.place_of("fov"), "\"fov\" must be over 0 and under 180 degrees");
  read_window(list, camera);
  read_lens(list, camera);
}

void read_orthographic(Build&, ParameterList& list, Camera& camera) {
  camera.kind = CameraKind::orthographic;
  read_window(list, camera);
  read_lens(list, camera);
}

void read_spherical(Build&, ParameterList& list, Camera& camera) {
  const std::string mapping = list.string("mapping", "equalarea");
  if (mapping != "equalarea" && mapping != "equirectangular")
    fail(list.place_of("mapping"), "unknown mapping of a camera \"" + mapping + "\"; use equalarea or equirectangular");
  camera.kind = mapping == "equalarea" ? CameraKind::equal_area : CameraKind::equirectangular;
  list.ignore({"frameaspectratio", "screenwindow", "lensradius", "focaldistance"});
}

/// Reads a lens file, which has four numbers per interface, from the front of the lens to the film: radius of curvature
/// and distance to the next interface in millimetres, index of refraction behind it, and diameter.
std::vector<double> read_lens_file(const InputPath& input) {
  const std::string& path = input.name;
  const std::vector<uint8_t> bytes = read_short_text(input);
  std::istringstream file(std::string(bytes.begin(), bytes.end()));
  std::vector<double> values;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      size_t used = 0;
      double value = 0;
      try {
        value = std::stod(word, &used);
      } catch (const std::exception&) {
        used = 0;
      }
      if (used != word.size() || !std::isfinite(value))
        throw InputError({path}, "a lens file holds four numbers per interface, not " + impl::quoted(word));
      values.push_back(value);
    }
  }
  if (values.empty() || values.size() % 4 != 0)
    throw InputError({path}, "a lens file holds four numbers per interface: radius, thickness, index, diameter");
  return values;
}

/// Traces a paraxial ray, parallel to the axis, through all interfaces (an aperture stop has radius 0).
double focal_length(const std::vector<double>& lens) {
  double height = 1, slope = 0, index = 1;
  for (size_t i = 0; i < lens.size(); i += 4) {
    const double radius = lens[i], behind = lens[i + 2] > 0 ? lens[i + 2] : 1;
    if (radius != 0) {
      slope = (index * slope - height * (behind - index) / radius) / behind;
      index = behind;
    }
    height += lens[i + 1] * slope;
  }
  return slope == 0 ? 0 : -1 / (slope * index);
}

void read_realistic(Build& build, ParameterList& list, Camera& camera) {
  build.warn_replaced(list, "a perspective camera with the focal length of its lens is used instead");
  const double distance = list.positive("focusdistance", 10);
  if (list.has("lensfile")) {
    const double f =
        focal_length(read_lens_file(build.existing_file(list.place_of("lensfile"), list.string("lensfile", ""))));
    // Image distance of a thin lens of that focal length, in millimetres for scenes in metres.
    if (f > 0 && 1000 * distance > f) build.lens_image_distance = f * 1000 * distance / (1000 * distance - f);
  }
  const double diameter = list.positive("aperturediameter", 1);
  camera.lens_radius = diameter / 2000;
  if (build.lens_image_distance) {
    const double ratio = diameter / (2 * *build.lens_image_distance);
    build.lens_exposure = std::numbers::pi * ratio * ratio;
  }
  camera.focal_distance = distance;
  list.ignore({"aperture", "simpleweighting", "frameaspectratio", "screenwindow", "scale"});
}

using CameraReader = void (*)(Build&, ParameterList&, Camera&);
const std::map<std::string, CameraReader> camera_readers{{"perspective", read_perspective},
                                                         {"orthographic", read_orthographic},
                                                         {"spherical", read_spherical},
                                                         {"realistic", read_realistic}};

}  // namespace

void set_film(Build& build, const std::string& kind, ParameterList& list) {
  if (kind == "spectral")
    build.warn_replaced(list, "linear sRGB is written instead");
  else if (kind != "rgb" && kind != "gbuffer")
    fail(list.place(), "unknown film \"" + kind + "\"" + or_upgrade(kind, "; use rgb"));
  FilmSettings film;
  film.width = read_side(list, "xresolution", 1280);
  film.height = read_side(list, "yresolution", 720);
  if (film.width * film.height >= max_pixels)
    fail(list.place_of("yresolution"), "the image has 10^9 pixels or more; lower xresolution or yresolution");
  film.filename = list.string("filename", "");
  if (list.has("pixelbounds")) film.pixel_bounds = read_pixel_bounds(build, list, film);
  if (list.has("cropwindow")) {
    if (film.pixel_bounds)
      build.warn(list.place_of("cropwindow"),
                 "both \"pixelbounds\" and \"cropwindow\" are given; the crop window is used");
    film.pixel_bounds = read_crop_window(list, film);
  }
  read_sensor(build, list);
  if (build.state.rgb_space != "srgb")
    build.warn(list.place(), "the image is written in linear sRGB, not in the colour space of the film");
  build.film_diagonal = list.positive("diagonal", 35);
  list.ignore({"savefp16", "coordinatesystem", "nbuckets", "lambdamin", "lambdamax"});
  list.reject_unknown();
  build.scene.film = film;
}

void set_camera(Build& build, const std::string& kind, ParameterList& list) {
  const auto reader = camera_readers.find(kind);
  if (reader == camera_readers.end())
    fail(list.place(), "unknown camera \"" + kind + "\"; use perspective, orthographic, spherical or realistic");
  Camera camera;
  camera.world_from_camera = {build.state.ctm_start.inverse(), build.state.ctm_end.inverse()};
  // What follows a LookAt is done to the world before it.
  build.scene.up = (camera.world_from_camera.start * build.after_look_at).direction(build.look_at_up);
  build.coordinate_systems["camera"] = camera.world_from_camera;
  build.lens_image_distance.reset();
  build.lens_exposure = 1;
  reader->second(build, list, camera);
  camera.shutter_open = list.number("shutteropen", 0);
  camera.shutter_close = list.number("shutterclose", 1);
  if (!(camera.shutter_open < camera.shutter_close))
    fail(list.place_of("shutterclose"), "\"shutterclose\" must be later than \"shutteropen\", or no light is recorded");
  list.reject_unknown();
  build.scene.camera = camera;
}

double realistic_fov(const Build& build) {
  const double width = static_cast<double>(build.scene.film.width),
               height = static_cast<double>(build.scene.film.height);
  const double shorter = build.film_diagonal * std::min(width, height) / std::hypot(width, height);
  return 2 * std::atan(shorter / (2 * *build.lens_image_distance)) * 180 / std::numbers::pi;
}

}  // namespace alhazen::impl::pbrt
