#pragma once

// alhazen.Mesh: arrays that have been checked, and are not yet in a scene.

#include <pybind11/numpy.h>

#include <optional>
#include <string>

#include "alhazen/scene.h"
#include "bindings.h"

namespace alhazen::python {

struct PythonMesh {
  py::array vertices, faces;
  std::optional<py::array> normals, uvs, second_uvs, colors, tangents;
  std::string name;

  /// Views of the arrays. What they hold is checked once more, since it may have changed.
  MeshArrays arrays() const;
};

/// Takes the arguments of alhazen.Mesh.
PythonMesh mesh_of(const py::object& vertices, const py::object& faces, const py::object& normals,
                   const py::object& uvs, const py::object& second_uvs, const py::object& colors,
                   const py::object& tangents, const py::object& name);
/// A Mesh, or an object with `vertices` and `faces`, such as one of trimesh. Null: neither.
std::optional<PythonMesh> mesh_like(py::handle given);

}  // namespace alhazen::python
