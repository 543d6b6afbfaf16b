#pragma once

// The files that bind classes of values.

#include <memory>

#include "alhazen/lights.h"
#include "alhazen/materials.h"
#include "alhazen/textures.h"
#include "value.h"

namespace alhazen::python {

void bind_geometry(py::module_& m);
void bind_textures(py::module_& m);
void bind_materials(py::module_& m);
void bind_lights(py::module_& m);
void bind_cameras(py::module_& m);
void bind_shape_values(py::module_& m);
void bind_images(py::module_& m);
void bind_meshes(py::module_& m);

/// What a scene has, as a value that refers to parts of it.
std::shared_ptr<Value> texture_value(const std::shared_ptr<PythonScene>& scene, Texture texture);
std::shared_ptr<Value> material_value(const std::shared_ptr<PythonScene>& scene, Material material);
std::shared_ptr<Value> light_value(const std::shared_ptr<PythonScene>& scene, Light light);

}  // namespace alhazen::python
