#include "mesh.h"

#include "arrays.h"
#include "convert.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

std::optional<py::array> optional_rows(const char* name, const py::object& given,
                                       const std::vector<py::ssize_t>& columns, const char* shape, py::ssize_t rows) {
  if (given.is_none()) return {};
  return real_rows(name, given, columns, shape, rows);
}

std::optional<py::array> checked_again(const char* name, const std::optional<py::array>& rows) {
  if (!rows) return {};
  return real_rows(name, *rows, {rows->shape(1)}, "of before", rows->shape(0));
}

py::object shown(const std::optional<py::array>& array) { return array ? py::object(*array) : py::none(); }

std::string mesh_text(const PythonMesh& mesh) {
  std::string text = "<alhazen.Mesh";
  if (!mesh.name.empty()) text += " " + std::string(py::str(py::repr(path_text(mesh.name))));
  text += ": " + std::to_string(mesh.vertices.shape(0)) + " vertices, " + std::to_string(mesh.faces.shape(0)) +
          " triangles";
  if (mesh.normals) text += ", normals";
  if (mesh.uvs) text += ", uvs";
  if (mesh.second_uvs) text += ", second uvs";
  if (mesh.colors) text += ", colors";
  if (mesh.tangents) text += ", tangents";
  return text + ">";
}

}  // namespace

MeshArrays PythonMesh::arrays() const {
  real_rows("vertices", vertices, {3}, "(n, 3)");
  index_rows("faces", faces, vertices.shape(0));
  checked_again("normals", normals);
  checked_again("uvs", uvs);
  checked_again("second_uvs", second_uvs);
  checked_again("colors", colors);
  checked_again("tangents", tangents);
  const auto reals = [](const std::optional<py::array>& rows) { return rows ? reals_of(*rows) : Reals(); };
  return {.positions = reals_of(vertices),
          .indices = indices_of(faces),
          .normals = reals(normals),
          .uvs = reals(uvs),
          .second_uvs = reals(second_uvs),
          .colours = reals(colors),
          .tangents = reals(tangents),
          .name = name};
}

PythonMesh mesh_of(const py::object& vertices, const py::object& faces, const py::object& normals,
                   const py::object& uvs, const py::object& second_uvs, const py::object& colors,
                   const py::object& tangents, const py::object& name) {
  PythonMesh mesh;
  mesh.vertices = real_rows("vertices", vertices, {3}, "(n, 3)");
  const py::ssize_t count = mesh.vertices.shape(0);
  mesh.faces = index_rows("faces", faces, count);
  mesh.normals = optional_rows("normals", normals, {3}, "(n, 3)", count);
  mesh.uvs = optional_rows("uvs", uvs, {2}, "(n, 2)", count);
  mesh.second_uvs = optional_rows("second_uvs", second_uvs, {2}, "(n, 2)", count);
  mesh.colors = optional_rows("colors", colors, {3, 4}, "(n, 3) or (n, 4)", count);
  mesh.tangents = optional_rows("tangents", tangents, {4}, "(n, 4)", count);
  mesh.name = text("name", name);
  return mesh;
}

std::optional<PythonMesh> mesh_like(py::handle given) {
  if (py::isinstance<PythonMesh>(given)) return given.cast<const PythonMesh&>();
  if (!py::hasattr(given, "vertices") || !py::hasattr(given, "faces")) return {};
  const py::object none = py::none();
  return mesh_of(given.attr("vertices"), given.attr("faces"), none, none, none, none, none, py::str(""));
}

void bind_meshes(py::module_& m) {
  py::class_<PythonMesh> bound(
      m, "Mesh",
      "A triangle mesh in object space, from arrays.\n\n"
      "Shapes for n vertices and m triangles: vertices (n, 3); faces (m, 3), three vertices of each triangle,\n"
      "counter-clockwise seen from outside; normals (n, 3), need not be normalized, without them triangles are flat;\n"
      "uvs and second_uvs (n, 2); colors (n, 3) or (n, 4), linear red, green, blue and alpha, for VertexColorTexture "
      "and\n"
      "VertexAlphaTexture; tangents (n, 4), the direction of increasing u, and 1 or -1, the handedness of the\n"
      "bitangent.\n\n"
      "Arrays of float32, float64 and, of faces, uint32, that are contiguous in the order of C, are held without a "
      "copy\n"
      "until the mesh is added to a scene, which copies them. All others (other integers and floats, transposed,\n"
      "strided, lists) are converted to such.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def(py::init(&mesh_of), py::arg("vertices"), py::arg("faces"), py::arg("normals") = py::none(),
           py::arg("uvs") = py::none(), py::arg("second_uvs") = py::none(), py::arg("colors") = py::none(),
           py::arg("tangents") = py::none(), py::arg("name") = "",
           "__init__(self, vertices: array, faces: array, normals: array | None = None, uvs: array | None = None, "
           "second_uvs: array | None = None, colors: array | None = None, tangents: array | None = None, "
           "name: str = '')\n\n"
           "InputError names the argument that has another shape or dtype, no rows, values that are infinite or NaN, "
           "or\n"
           "indices below 0 or beyond the vertices.")
      .def_property_readonly(
          "vertices", [](const PythonMesh& self) { return self.vertices; }, "(n, 3) array of float32 or float64.")
      .def_property_readonly(
          "faces", [](const PythonMesh& self) { return self.faces; }, "(m, 3) array of uint32.")
      .def_property_readonly(
          "normals", [](const PythonMesh& self) { return shown(self.normals); }, "(n, 3) array, or None.")
      .def_property_readonly(
          "uvs", [](const PythonMesh& self) { return shown(self.uvs); }, "(n, 2) array, or None.")
      .def_property_readonly(
          "second_uvs", [](const PythonMesh& self) { return shown(self.second_uvs); }, "(n, 2) array, or None.")
      .def_property_readonly(
          "colors", [](const PythonMesh& self) { return shown(self.colors); }, "(n, 3) or (n, 4) array, or None.")
      .def_property_readonly(
          "tangents", [](const PythonMesh& self) { return shown(self.tangents); }, "(n, 4) array, or None.")
      .def_property(
          "name", [](const PythonMesh& self) { return path_text(self.name); },
          [](PythonMesh& self, const py::object& name) { self.name = text("name", name); },
          "str: by which scene.meshes finds it.")
      .def("__repr__", &mesh_text);
}

}  // namespace alhazen::python
