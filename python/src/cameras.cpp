// The values of cameras, films, pixel filters and what renders take as defaults.

#include "alhazen/camera.h"

#include "alhazen/scene.h"
#include "described.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

void bind_camera(py::module_& m) {
  bind_value<Camera>(
      m,
      {"Camera",
       "A camera: scene.camera = alhazen.Camera(transform=alhazen.Transform.look_at((0, 1, 4), (0, 0, 0)), fov=40).\n"
       "Lengths are in scene units, angles in degrees."},
      {field("kind", &Camera::kind,
             "'perspective', 'orthographic' (rays are parallel to z), 'equirectangular' or 'equal_area' (the whole "
             "sphere; the camera's y is up)"),
       field("transform", &Camera::transform,
             "from camera space (x right, y up, z into the scene) to world space, as Transform.look_at makes it"),
       field("fov", &Camera::fov, "perspective: degrees over the shorter side of the image, over 0 and under 180"),
       field("screen_window", &Camera::screen_window,
             "x0, x1, y0, y1 of what is seen, of orthographic cameras in camera space, of perspective ones relative to "
             "fov; None: from -1 to 1 over the shorter side"),
       field("frame_aspect_ratio", &Camera::frame_aspect_ratio, "width / height; None: that of the image"),
       field("aperture", &Camera::lens_radius, "radius of the lens in camera space; 0: all is sharp"),
       field("focus", &Camera::focal_distance, "distance of what is sharp, if the lens has a radius"),
       field("shutter_open", &Camera::shutter_open, "time at which motion begins to be seen"),
       field("shutter_close", &Camera::shutter_close, "time at which it ends")},
      [](const void* data) { alhazen::Scene().set_camera(*static_cast<const Camera*>(data)); });
}

void bind_film(py::module_& m) {
  bind_value<Film>(
      m, {"Film", "The size of the image."},
      {field("width", &Film::width, "pixels, 1 to 100000"), field("height", &Film::height, "pixels, 1 to 100000"),
       field("pixel_bounds", &Film::pixel_bounds, "x0, x1, y0, y1 of what is rendered, half open; None: all of it"),
       field("exposure", &Film::exposure, "factor on the radiance")},
      [](const void* data) { alhazen::Scene().set_film(*static_cast<const Film*>(data)); });
}

void bind_filter(py::module_& m) {
  bind_value<PixelFilter>(
      m, {"PixelFilter", "How samples are weighted around a pixel.", 1},
      {field("kind", &PixelFilter::kind, "'box', 'triangle', 'gaussian', 'mitchell' or 'sinc'"),
       field("x_radius", &PixelFilter::x_radius, "pixels, over 0 and at most 64"),
       field("y_radius", &PixelFilter::y_radius, "pixels, over 0 and at most 64"),
       field("sigma", &PixelFilter::sigma, "gaussian"), field("b", &PixelFilter::b, "mitchell"),
       field("c", &PixelFilter::c, "mitchell"), field("tau", &PixelFilter::tau, "sinc")},
      [](const void* data) { alhazen::Scene().set_pixel_filter(*static_cast<const PixelFilter*>(data)); });
}

void bind_defaults(py::module_& m) {
  bind_value<RenderDefaults>(
      m, {"RenderDefaults", "How a scene is rendered where the arguments of render leave it open."},
      {field("samples_per_pixel", &RenderDefaults::samples_per_pixel, "1 or more"),
       field("seed", &RenderDefaults::seed, "of the random numbers, 0 to 2^32 - 1"),
       field("max_depth", &RenderDefaults::max_depth, "bounces"),
       field("integrator", &RenderDefaults::integrator, "'path', 'iterative', 'recursive' or 'branching'"),
       field("sampler", &RenderDefaults::sampler, "'sobol', 'zsobol' or 'independent'"),
       field("quality", &RenderDefaults::quality, "'draft', 'good', 'final' or '' for none"),
       field("pbrt_coats", &RenderDefaults::pbrt_coats, "coated materials lose as much light as pbrt-v4's")},
      [](const void* data) { alhazen::Scene().set_render_defaults(*static_cast<const RenderDefaults*>(data)); });
}

}  // namespace

void bind_cameras(py::module_& m) {
  bind_camera(m);
  bind_film(m);
  bind_filter(m);
  bind_defaults(m);
}

}  // namespace alhazen::python
