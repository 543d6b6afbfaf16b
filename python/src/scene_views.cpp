// scene.camera, scene.film, scene.pixel_filter and scene.defaults: live views, which write back to the scene.

#include "convert.h"
#include "described.h"
#include "parts.h"

namespace alhazen::python {

namespace {

template <class Struct>
struct Access;

template <>
struct Access<Camera> {
  static constexpr const char* class_name = "SceneCamera";
  static Camera get(const alhazen::Scene& scene) { return scene.camera(); }
  static void set(alhazen::Scene& scene, const Camera& value) { scene.set_camera(value); }
};
template <>
struct Access<Film> {
  static constexpr const char* class_name = "SceneFilm";
  static Film get(const alhazen::Scene& scene) { return scene.film(); }
  static void set(alhazen::Scene& scene, const Film& value) { scene.set_film(value); }
};
template <>
struct Access<PixelFilter> {
  static constexpr const char* class_name = "ScenePixelFilter";
  static PixelFilter get(const alhazen::Scene& scene) { return scene.pixel_filter(); }
  static void set(alhazen::Scene& scene, const PixelFilter& value) { scene.set_pixel_filter(value); }
};
template <>
struct Access<RenderDefaults> {
  static constexpr const char* class_name = "SceneDefaults";
  static RenderDefaults get(const alhazen::Scene& scene) { return scene.render_defaults(); }
  static void set(alhazen::Scene& scene, const RenderDefaults& value) { scene.set_render_defaults(value); }
};

template <class Struct>
struct View : Live {
  explicit View(std::shared_ptr<PythonScene> of_scene) : scene(std::move(of_scene)) {}

  std::shared_ptr<Value> value() const override {
    return std::make_shared<Described<Struct>>(Access<Struct>::get(scene->read()));
  }
  void set_value(const Value& value) const override {
    const auto* described = dynamic_cast<const Described<Struct>*>(&value);
    if (described == nullptr)
      refuse("value", "must be a " + Described<Struct>::the_class().name + ", not a " + value.value_class().name);
    Access<Struct>::set(scene->change(), described->whole());
  }

  std::shared_ptr<PythonScene> scene;
};

/// Properties, so that help() and editors show them.
template <class Struct>
void add_properties(py::object bound) {
  const py::object property = py::module_::import("builtins").attr("property");
  for (const Field& field : Described<Struct>::the_class().fields) {
    const Field* f = &field;
    const py::cpp_function get([f](const View<Struct>& self) { return self.value()->get(*f); }, py::is_method(bound));
    const py::cpp_function set(
        [f](const View<Struct>& self, const py::object& given) {
          const std::shared_ptr<Value> value = self.value();
          value->set(*f, given);
          self.set_value(*value);
        },
        py::is_method(bound));
    bound.attr(field.name.c_str()) = property(get, set, py::none(), field.type + ": " + field.doc);
  }
}

template <class Struct>
py::class_<View<Struct>, Live> bind_view(py::module_& m, const char* doc) {
  py::class_<View<Struct>, Live> bound(m, Access<Struct>::class_name, doc);
  add_properties<Struct>(bound);
  bound.def("__repr__", [](const View<Struct>& self) {
    return "<alhazen." + std::string(Access<Struct>::class_name) + ": " + self.value()->repr() + ">";
  });
  return bound;
}

using CameraView = View<Camera>;

void look_at(const CameraView& self, const py::object& eye, const py::object& target, const py::object& up,
             const py::object& origin) {
  if (eye.is_none() == origin.is_none()) throw py::type_error("look_at() needs 'eye', or 'origin', which is the same");
  if (target.is_none()) throw py::type_error("look_at() needs 'target'");
  const Vec3 from = eye.is_none() ? vector3("origin", origin) : vector3("eye", eye), to = vector3("target", target);
  std::optional<Vec3> upwards;
  if (!up.is_none()) upwards = vector3("up", up);
  self.scene->change().look_at(from, to, upwards);
}

void orbit(const CameraView& self, const py::object& azimuth, const py::object& elevation, const py::object& distance) {
  const double turn = number("azimuth", azimuth), lift = number("elevation", elevation);
  std::optional<double> from;
  if (!distance.is_none()) from = number("distance", distance);
  self.scene->change().orbit(turn, lift, from);
}

void bind_camera_view(py::module_& m) {
  auto bound = bind_view<Camera>(
      m,
      "The camera of a scene: setting an attribute changes the scene. A scene without a camera of its own is seen as "
      "a\n"
      "whole, from the front, the side and above; reading shows that camera, and setting an attribute makes it the\n"
      "scene's own, which no longer follows what is added.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def("look_at", &look_at, py::arg("eye") = py::none(), py::arg("target") = py::none(), py::arg("up") = py::none(),
           py::kw_only(), py::arg("origin") = py::none(),
           "look_at(eye: 3 numbers = None, target: 3 numbers = None, up: 3 numbers | None = None, *, origin: 3 numbers "
           "= "
           "None) -> None\n\n"
           "Places the camera, and focuses it on the target if its lens has a radius; the rest stays. World space.\n"
           "Without `up` the scene's axis that was upwards stays so. `origin` is another name for `eye`.")
      .def(
          "orbit", &orbit, py::arg("azimuth"), py::arg("elevation") = 0.0, py::arg("distance") = py::none(),
          "orbit(azimuth: float, elevation: float = 0, distance: float | None = None) -> None\n\n"
          "Turns the camera about the middle of the scene: azimuth from the front and elevation in degrees. Without a\n"
          "distance (scene units) all of the scene is seen. Surroundings far larger than the rest do not count.")
      .def(
          "fit", [](const CameraView& self) { self.scene->change().fit(); },
          "fit() -> None\n\nMoves the camera so that it sees the whole scene in the direction in which it looks.")
      .def_property(
          "end_transform", [](const CameraView& self) { return shown(self.scene->read().camera().transform.end); },
          [](const CameraView& self, const py::object& given) {
            const Transform end = transform("end_transform", given);
            Camera camera = self.scene->read().camera();
            camera.transform.end = end;
            self.scene->change().set_camera(camera);
          },
          "The transform when the shutter closes: a read-only array of the shape (4, 4).");
}

template <class Struct>
void add_view(SceneClass& scene, const char* name, const char* doc) {
  scene.def_property(
      name, [](const std::shared_ptr<PythonScene>& self) { return View<Struct>(self); },
      [name](const std::shared_ptr<PythonScene>& self, const py::object& given) {
        const View<Struct> view(self);
        if (py::isinstance<View<Struct>>(given)) return view.set_value(*given.cast<const View<Struct>&>().value());
        if (!py::isinstance<Described<Struct>>(given))
          refuse_given(name, "a " + Described<Struct>::the_class().name, given);
        view.set_value(given.cast<const Value&>());
      },
      doc);
}

}  // namespace

void bind_scene_views(py::module_& m) {
  bind_camera_view(m);
  bind_view<Film>(m, "The film of a scene: setting an attribute changes the scene.");
  bind_view<PixelFilter>(m, "The pixel filter of a scene: setting an attribute changes the scene.");
  bind_view<RenderDefaults>(
      m,
      "How a scene is rendered where the arguments of render leave it open: setting an attribute changes the scene.");
}

void bind_views_of(SceneClass& scene) {
  add_view<Camera>(
      scene, "camera",
      "The camera: scene.camera.fov = 40, scene.camera.look_at((0, 1, 4), (0, 0, 0)). A Camera can be set.");
  add_view<Film>(scene, "film", "The size of the image: scene.film.width = 640. A Film can be set.");
  add_view<PixelFilter>(scene, "pixel_filter", "How samples are weighted around a pixel. A PixelFilter can be set.");
  add_view<RenderDefaults>(scene, "defaults",
                           "What renders take where their arguments leave it open: scene.defaults.max_depth = 4. A\n"
                           "RenderDefaults can be set.");
}

}  // namespace alhazen::python
