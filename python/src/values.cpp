#include "value_bindings.h"

namespace alhazen::python {

void bind_values(py::module_& m) {
  bind_geometry(m);
  bind_value_base(m);
  bind_images(m);
  bind_meshes(m);
  bind_textures(m);
  bind_materials(m);
  bind_lights(m);
  bind_cameras(m);
  bind_shape_values(m);
}

}  // namespace alhazen::python
