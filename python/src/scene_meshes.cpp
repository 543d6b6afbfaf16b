// The meshes and images of a scene.

#include "arrays.h"
#include "bind_part.h"
#include "enums.h"
#include "image.h"
#include "mesh.h"

namespace alhazen::python {

namespace {

MeshView view_of(const SceneMesh& mesh) { return mesh.scene->read().mesh(mesh.id); }

std::string mesh_repr(const SceneMesh& mesh) {
  std::string counts;
  try {
    const MeshView view = view_of(mesh);
    counts = ": " + std::to_string(view.positions.size() / 3) + " vertices, " +
             std::to_string(view.indices.size() / 3) + " triangles";
  } catch (const Error&) {
  }
  return part_repr(mesh, "SceneMesh", counts);
}

void set_vertices(const SceneMesh& mesh, const py::object& vertices, const py::object& normals) {
  const auto count = static_cast<py::ssize_t>(view_of(mesh).positions.size() / 3);
  const py::array moved = real_rows("vertices", vertices, {3}, "(n, 3)", count);
  py::array turned;
  if (!normals.is_none()) turned = real_rows("normals", normals, {3}, "(n, 3)", count);
  mesh.scene->change().set_positions(mesh.id, reals_of(moved), normals.is_none() ? Reals() : reals_of(turned));
}

void bind_mesh(py::module_& m) {
  py::class_<SceneMesh> bound(
      m, "SceneMesh",
      "A mesh of a scene, of which any number of shapes can be made: scene.add(mesh, transform=...).\n"
      "Arrays are read-only copies of what the scene has: to move vertices, assign all of them.");
  bind_part<SceneMesh>(bound, {});
  bound
      .def_property(
          "vertices", [](const SceneMesh& self) { return copied_rows(view_of(self).positions, 3); },
          [](const SceneMesh& self, const py::object& given) { set_vertices(self, given, py::none()); },
          "(n, 3) array of float64, object space. Another array of the same shape moves them; normals stay as they "
          "are.")
      .def_property_readonly(
          "faces", [](const SceneMesh& self) { return copied_rows(view_of(self).indices, 3); },
          "(m, 3) array of uint32: three vertices of each triangle.")
      .def_property_readonly(
          "normals", [](const SceneMesh& self) { return copied_rows(view_of(self).normals, 3); },
          "(n, 3) array of float32, or None.")
      .def_property_readonly(
          "uvs", [](const SceneMesh& self) { return copied_rows(view_of(self).uvs, 2); },
          "(n, 2) array of float32, or None.")
      .def_property_readonly(
          "second_uvs", [](const SceneMesh& self) { return copied_rows(view_of(self).second_uvs, 2); },
          "(n, 2) array of float32, or None.")
      .def_property_readonly(
          "colors", [](const SceneMesh& self) { return copied_rows(view_of(self).colours, 4); },
          "(n, 4) array of float32, or None: linear red, green, blue and alpha.")
      .def_property_readonly(
          "tangents", [](const SceneMesh& self) { return copied_rows(view_of(self).tangents, 4); },
          "(n, 4) array of float32, or None.")
      .def("__repr__", &mesh_repr);
  py::options options;
  options.disable_function_signatures();
  bound
      .def("set_vertices", &set_vertices, py::arg("vertices"), py::arg("normals") = py::none(),
           "set_vertices(vertices: array, normals: array | None = None) -> None\n\n"
           "Moves the vertices, whose number stays. Without normals the mesh keeps those it has.")
      .def(
          "replace",
          [](const SceneMesh& self, const py::object& mesh) {
            const auto given = mesh_like(mesh);
            if (!given) refuse_given("mesh", "a Mesh", mesh);
            self.scene->change().set_mesh(self.id, given->arrays());
          },
          py::arg("mesh"),
          "replace(mesh: Mesh) -> None\n\nPuts another mesh in its place, for all shapes that have it.");
}

void bind_image(py::module_& m) {
  const auto encoding = [](const SceneImage& self) { return enum_name(self.scene->read().image(self.id).encoding); };
  py::class_<SceneImage> bound(m, "SceneImage", "An image of a scene, which textures refer to.");
  bind_part<SceneImage>(bound, {});
  bound
      .def_property(
          "pixels", [](const SceneImage& self) { return copied_pixels(self.scene->read().image(self.id)); },
          [encoding](const SceneImage& self, const py::object& given) {
            PythonImage image = image_of("pixels", given);
            if (!py::isinstance<PythonImage>(given)) {
              image.encoding = enum_value<Encoding>("encoding", encoding(self));
              image.name = self.scene->read().name(self.id);
            }
            self.scene->change().set_image(self.id, image.view("pixels"));
          },
          "A read-only copy, (h, w) or (h, w, 3), of uint8 or float32. An array, which keeps the encoding, or an Image "
          "of\n"
          "pixels replaces it, for all textures that have it.")
      .def_property_readonly("encoding", encoding, "'srgb' or 'linear'.")
      .def("__repr__", [](const SceneImage& self) {
        std::string size;
        try {
          const Pixels pixels = self.scene->read().image(self.id);
          size = ": " + std::to_string(pixels.width) + " x " + std::to_string(pixels.height);
        } catch (const Error&) {
        }
        return part_repr(self, "SceneImage", size);
      });
}

}  // namespace

void bind_scene_meshes(py::module_& m) {
  bind_mesh(m);
  bind_image(m);
}

}  // namespace alhazen::python
