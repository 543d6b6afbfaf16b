// The values of spheres, cylinders, disks and the emission of shapes.

#include "alhazen/scene.h"
#include "alhazen/shapes.h"
#include "described.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

template <class Quadric>
void check_quadric(const void* data) {
  alhazen::Scene().add(Shape{.geometry = *static_cast<const Quadric*>(data)});
}

}  // namespace

void bind_shape_values(py::module_& m) {
  bind_value<Sphere>(m, {"Sphere", "A sphere about the origin of object space.", 1},
                     {field("radius", &Sphere::radius, "scene units, over 0")}, &check_quadric<Sphere>);
  bind_value<Cylinder>(m, {"Cylinder", "A cylinder about the z axis of object space, open at its ends.", 3},
                       {field("radius", &Cylinder::radius, "scene units, over 0"),
                        field("z_min", &Cylinder::z_min, "lower end"), field("z_max", &Cylinder::z_max, "upper end"),
                        field("phi_max", &Cylinder::phi_max, "degrees of azimuth from x, over 0 to 360")},
                       &check_quadric<Cylinder>);
  bind_value<Disk>(
      m, {"Disk", "A disk about the z axis of object space, with its normal along z.", 1},
      {field("radius", &Disk::radius, "scene units, over 0"),
       field("inner_radius", &Disk::inner_radius, "of a hole, under radius"), field("height", &Disk::height, "its z"),
       field("phi_max", &Disk::phi_max, "degrees of azimuth from x, over 0 to 360")},
      &check_quadric<Disk>);
  bind_value<Emission>(
      m, {"Emission", "Makes a shape a light.", 1},
      {field("radiance", &Emission::radiance, "W / (m^2 sr): a number or three numbers"),
       field("two_sided", &Emission::two_sided, "light from both sides; otherwise from that of the normal"),
       field("texture", &Emission::texture, "factor on the radiance; None: 1")},
      [](const void* data) { alhazen::Scene().add(Shape{.emission = *static_cast<const Emission*>(data)}); });
}

}  // namespace alhazen::python
