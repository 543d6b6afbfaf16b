#include "io/pbrt/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/quadrics.h"
#include "geometry/tessellate.h"
#include "io/pbrt/curves.h"
#include "io/pbrt/materials.h"
#include "io/pbrt/meshes.h"
#include "io/pbrt/suggestions.h"
#include "io/pbrt/textures.h"

namespace alhazen::impl::pbrt {

namespace {

using std::numbers::pi;

/// The part of a quadric within phimax, zmin and zmax.
struct Extent {
  double z_min = 0, z_max = 0, phi_max = 360;
};

double read_phi_max(ParameterList& list) {
  const double phi_max = std::min(list.number("phimax", 360), 360.0);
  if (!(phi_max > 0)) fail(list.place_of("phimax"), "\"phimax\" must be over 0 degrees");
  return phi_max;
}

Extent read_extent(ParameterList& list, double z_min, double z_max) {
  const double a = list.number("zmin", z_min), b = list.number("zmax", z_max);
  const Extent extent{std::min(a, b), std::max(a, b), read_phi_max(list)};
  if (!(extent.z_min < extent.z_max))
    fail(list.place_of("zmax"), "\"zmin\" and \"zmax\" of " + list.directive() + " leave nothing between them");
  return extent;
}

/// The mesh of a curved shape with these measures, made once for all equal shapes.
template <class Make>
uint32_t shared_mesh(Build& build, const ParameterList& list, const std::string& kind,
                     const std::array<double, 4>& measures, Make make) {
  std::string key = kind;
  for (const double measure : measures) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), " %.17g", measure);
    key += text.data();
  }
  const auto found = build.meshes_by_key.find(key);
  if (found != build.meshes_by_key.end()) return found->second;
  const uint32_t mesh = add_mesh(build, list, make(measures[0], measures[1], measures[2], measures[3]));
  build.meshes_by_key[key] = mesh;
  return mesh;
}

void become_mesh(Shape& shape, uint32_t mesh) {
  shape.type = ShapeType::mesh;
  shape.mesh = mesh;
}

uint32_t sphere_mesh(Build& build, const ParameterList& list, double radius, const Extent& extent) {
  return shared_mesh(build, list, "sphere", {radius, extent.z_min, extent.z_max, extent.phi_max}, tessellated_sphere);
}

void read_sphere(Build& build, ParameterList& list, Shape& shape) {
  shape.radius = list.positive("radius", 1);
  Extent extent = read_extent(list, -shape.radius, shape.radius);
  extent.z_min = std::max(extent.z_min, -shape.radius);
  extent.z_max = std::min(extent.z_max, shape.radius);
  if (!(extent.z_min < extent.z_max)) fail(list.place_of("zmin"), "\"zmin\" and \"zmax\" leave nothing of the sphere");
  const bool is_whole = extent.z_min == -shape.radius && extent.z_max == shape.radius && extent.phi_max == 360;
  shape.type = ShapeType::sphere;
  if (!is_whole || !is_similarity(shape.world_from_object))
    become_mesh(shape, sphere_mesh(build, list, shape.radius, extent));
}

uint32_t mesh_of_quadric(Build& build, const ParameterList& list, const Shape& shape) {
  if (shape.type == ShapeType::disk)
    return shared_mesh(build, list, "disk", {shape.radius, shape.inner_radius, shape.z_min, shape.phi_max},
                       tessellated_disk);
  return shared_mesh(build, list, "cylinder", {shape.radius, shape.z_min, shape.z_max, shape.phi_max},
                     tessellated_cylinder);
}

void become_mesh_unless_exact(Build& build, const ParameterList& list, Shape& shape) {
  if (build.state.area_light || !stays_exact(shape, shape.world_from_object))
    become_mesh(shape, mesh_of_quadric(build, list, shape));
}

void read_cylinder(Build& build, ParameterList& list, Shape& shape) {
  shape.radius = list.positive("radius", 1);
  const Extent extent = read_extent(list, -1, 1);
  shape.z_min = extent.z_min, shape.z_max = extent.z_max, shape.phi_max = extent.phi_max;
  shape.type = ShapeType::cylinder;
  become_mesh_unless_exact(build, list, shape);
}

void read_disk(Build& build, ParameterList& list, Shape& shape) {
  shape.radius = list.positive("radius", 1), shape.inner_radius = list.number("innerradius", 0);
  shape.z_min = shape.z_max = list.number("height", 0), shape.phi_max = read_phi_max(list);
  if (!(shape.inner_radius >= 0 && shape.inner_radius < shape.radius))
    fail(list.place_of("innerradius"), "\"innerradius\" must be at least 0 and under \"radius\"");
  shape.type = ShapeType::disk;
  become_mesh_unless_exact(build, list, shape);
}

template <uint32_t (*read)(Build&, ParameterList&)>
void read_as_mesh(Build& build, ParameterList& list, Shape& shape) {
  become_mesh(shape, read(build, list));
}

/// The object has the name of its file.
void read_ply_shape(Build& build, ParameterList& list, Shape& shape) {
  become_mesh(shape, read_ply_mesh(build, list));
  std::filesystem::path file = std::filesystem::path(build.scene.meshes[shape.mesh].name).filename();
  while (file.has_extension() && !file.stem().empty()) file = file.stem();
  shape.name = file.string();
}

using ShapeReader = void (*)(Build&, ParameterList&, Shape&);
const std::map<std::string, ShapeReader> shape_readers{{"sphere", read_sphere},
                                                       {"cylinder", read_cylinder},
                                                       {"disk", read_disk},
                                                       {"trianglemesh", read_as_mesh<read_triangle_mesh>},
                                                       {"bilinearmesh", read_as_mesh<read_bilinear_mesh>},
                                                       {"plymesh", read_ply_shape},
                                                       {"loopsubdiv", read_as_mesh<read_loop_subdivision>},
                                                       {"curve", read_as_mesh<read_curve>}};

/// Area in world space when the shutter opens.
double world_area(const Build& build, const Shape& shape) {
  const Transform& world = shape.world_from_object.start;
  if (shape.type == ShapeType::sphere) {
    double scale = 1;
    world.is_similarity(scale);
    return 4 * pi * shape.radius * shape.radius * scale * scale;
  }
  const Mesh& mesh = build.scene.meshes[shape.mesh];
  double area = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d p = world.point(mesh.positions[mesh.indices[i]]);
    area += length(cross(world.point(mesh.positions[mesh.indices[i + 1]]) - p,
                         world.point(mesh.positions[mesh.indices[i + 2]]) - p)) /
            2;
  }
  return area;
}

std::optional<Emission> emission_of(Build& build, const Shape& shape) {
  if (!build.state.area_light) return {};
  const AreaLight& light = *build.state.area_light;
  if (build.open_object != 0) {
    build.warn(light.place, "area lights of objects that are instanced are not supported; they do not emit");
    return {};
  }
  Emission emission{light.radiance, light.two_sided, light.texture};
  if (light.power > 0) {
    const double area = world_area(build, shape);
    if (!(area > 0)) fail(light.place, "\"power\" cannot be distributed over a shape without area");
    emission.radiance *= light.power / ((light.two_sided ? 2 : 1) * pi * area * light.image_mean);
    if (!is_finite(emission.radiance)) fail(light.place, "\"power\" is too large for the area of the shape");
  }
  return emission;
}

/// The texture of `alpha`, absent if the shape is opaque; `visible` is false if the shape is fully transparent.
uint32_t read_alpha(Build& build, ParameterList& list, bool& visible) {
  const uint32_t alpha = scalar_texture(build, list, "alpha");
  visible = true;
  if (alpha == no_index) return no_index;
  const auto constant = constant_value(build, alpha);
  visible = !constant || *constant > 0;
  return constant && *constant >= 1 ? no_index : alpha;
}

}  // namespace

void add_shape(Build& build, const std::string& kind, ParameterList& list) {
  list.inherit(build.state.defaults.shape);
  const auto reader = shape_readers.find(kind);
  if (reader == shape_readers.end()) {
    std::vector<std::string> kinds;
    for (const auto& [known, function] : shape_readers) kinds.push_back(known);
    fail(list.place(), "unknown shape \"" + kind + "\"" + upgrade_or_suggestion(kind, kinds));
  }
  Shape shape;
  shape.where = list.place().location();
  shape.world_from_object = build.state.ctm();
  shape.reverse_orientation = build.state.reverse_orientation;
  bool visible = true;
  shape.material = material_of_shape(build, read_alpha(build, list, visible), list.place());
  reader->second(build, list, shape);
  list.reject_unknown();
  const bool is_empty =
      shape.type == ShapeType::mesh && (shape.mesh == no_index || build.scene.meshes[shape.mesh].indices.empty());
  if (!visible || is_empty) return;
  shape.emission = emission_of(build, shape);
  build.shapes().push_back(std::move(shape));
}

void tessellate_for_instances(Build& build) {
  uint64_t copies = 0;
  for (const Instance& instance : build.scene.instances) {
    const std::vector<Shape>& shapes = build.scene.groups[instance.group].shapes;
    copies += static_cast<uint64_t>(std::count_if(shapes.begin(), shapes.end(), is_cylinder_or_disk));
  }
  for (const Instance& instance : build.scene.instances)
    for (Shape& shape : build.scene.groups[instance.group].shapes) {
      const MovingTransform &outer = instance.world_from_group, &inner = shape.world_from_object;
      if (shape.type == ShapeType::sphere && !is_similarity(outer))
        become_mesh(shape, sphere_mesh(build, {}, shape.radius, {-shape.radius, shape.radius, 360}));
      else if (is_cylinder_or_disk(shape) &&
               (copies > max_quadric_copies || !stays_exact(shape, {outer.start * inner.start, outer.end * inner.end})))
        become_mesh(shape, mesh_of_quadric(build, {}, shape));
    }
}

}  // namespace alhazen::impl::pbrt
