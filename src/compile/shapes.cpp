#include "compile/shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/shapes/cylinder.h"
#include "core/shapes/disk.h"
#include "core/shapes/instance.h"
#include "core/shapes/triangle.h"

namespace alhazen::impl {

namespace {

/// Intersection multiplies three coordinates, normals four: beyond this they overflow.
template <class Real>
constexpr double max_coordinate = sizeof(Real) == sizeof(float) ? 1e12 : 1e75;

/// The error for a shape whose coordinates or areas overflow.
template <class Real>
InputError precision_error(const Shape& shape, const std::string& what) {
  const std::string remedy =
      sizeof(Real) == sizeof(float) ? "use --precision double, or scale the scene down" : "scale the scene down";
  return InputError(shape.where, what + " for this precision: " + remedy);
}

/// `farthest` bounds the coordinates of the centre.
template <class Real>
void check_sphere_range(const Shape& shape, const Vec3d& farthest, double radius) {
  if (!(max_component(farthest) + radius <= max_coordinate<Real>))
    throw precision_error<Real>(shape, "the sphere is too large or too far away");
}

/// Returns whether intersection tests find a sphere in this precision; they divide by the square of the radius.
template <class Real>
bool is_resolved(double radius) {
  const Real squared = sqr(static_cast<Real>(radius));
  return squared > 0 && std::isfinite(1 / squared);
}

/// The centre of a sphere when the shutter opens, and its displacement until the shutter closes.
std::pair<Vec3d, Vec3d> motion_of(const Scene& scene, const MovingTransform& transform) {
  const Vec3d start = transform.start.point({}), end = transform.end.point({});
  const auto at = [&](double time) { return lerp(start, end, fraction_of_motion(scene, transform, time)); };
  const Vec3d open = at(scene.camera.shutter_open);
  return {open, at(scene.camera.shutter_close) - open};
}

const char* name_of(const Shape& shape) { return shape.type == ShapeType::disk ? "disk" : "cylinder"; }

/// Sets the object space of a cylinder or disk, and the part of it within phimax. `z_axis(x, y)` returns the z axis of
/// object space in world space, given the other two.
template <class Real, class ZAxis>
void set_object_space(const Shape& shape, const Transform& transform, const Vec3d& anchor, const ZAxis& z_axis,
                      QuadricRecord<Real>& record) {
  const bool is_whole = shape.phi_max >= 360;
  const double half = is_whole ? pi<double> : shape.phi_max / 2 * (pi<double> / 180);
  const Vec3d x{is_whole ? -1 : std::cos(half), is_whole ? 0 : std::sin(half), 0};
  record.cosine = static_cast<Real>(x.x);
  record.sine = static_cast<Real>(x.y);
  record.phi_max = static_cast<Real>(2 * half);
  Vec3d axes[3] = {transform.direction(x * shape.radius), transform.direction(Vec3d{-x.y, x.x, 0} * shape.radius)};
  axes[2] = z_axis(axes[0], axes[1]);
  if (!(max_component(abs(anchor) + 2 * (abs(axes[0]) + abs(axes[1]) + abs(axes[2]))) <= max_coordinate<Real>))
    throw precision_error<Real>(shape, std::string("the ") + name_of(shape) + " is too large or too far away");
  record.anchor = convert<Real>(anchor);
  long double columns[3][4]{}, rows[3][4];
  for (int i = 0; i < 3; ++i) {
    record.world_from_object[i] = convert<Real>(axes[i]);
    for (int j = 0; j < 3; ++j) columns[j][i] = static_cast<long double>(record.world_from_object[i][j]);
  }
  invert(columns, rows);  // the rounded one: error_of_point counts no rounding of it
  for (int i = 0; i < 3; ++i)
    record.object_from_world[i] = convert<Real>(Vec3<long double>{rows[i][0], rows[i][1], rows[i][2]});
}

/// Tests along the axes of object space err by this number of roundings of the way from the origin of the ray.
constexpr int roundings_of_tests = 6;

/// Far from the origin of the world, rounding may be as large as a shape. It does not grow by more than this fraction.
template <class Real>
constexpr Real max_rim_error = Real(1) / 16;

template <class Real>
CylinderRecord<Real> cylinder_record(const Shape& shape, const Transform& transform) {
  CylinderRecord<Real> record{};
  const Vec3d low = transform.point({0, 0, shape.z_min}), high = transform.point({0, 0, shape.z_max});
  const bool is_low_nearer = length_squared(low) <= length_squared(high);
  record.anchor_z = is_low_nearer ? Real(-1) : Real(1);
  const auto half_length = [&](const Vec3d&, const Vec3d&) {
    return transform.direction({0, 0, (shape.z_max - shape.z_min) / 2});
  };
  set_object_space(shape, transform, is_low_nearer ? low : high, half_length, record);
  const Vec3<Real> row = abs(record.object_from_world[2]);
  record.rim = 1 + min(dot(row, error_of_point(record, {1, 1, -record.anchor_z})), max_rim_error<Real>);
  record.rim_growth = dot(row, splat(rounding_bound<Real>(roundings_of_tests)));
  return record;
}

template <class Real>
DiskRecord<Real> disk_record(const Shape& shape, const Transform& transform) {
  DiskRecord<Real> record{};
  const auto normal = [&](const Vec3d& x, const Vec3d& y) {
    const double size = max_component(max(abs(x), abs(y)));
    const Vec3d n = cross(x / size, y / size);
    const double side = dot(n, transform.direction({0, 0, 1})) < 0 ? -1 : 1;
    return n * (side * size / std::sqrt(length(n)));  // about as long as x and y
  };
  set_object_space(shape, transform, transform.point({0, 0, shape.z_min}), normal, record);
  // The errors along x and y, together.
  const auto radial = [&](const Vec3<Real>& error) {
    return std::hypot(dot(abs(record.object_from_world[0]), error), dot(abs(record.object_from_world[1]), error));
  };
  const Real error = min(radial(error_of_point(record, {1, 1, 0})), max_rim_error<Real>);
  record.rim = 1 + error;
  record.rim_growth = radial(splat(rounding_bound<Real>(roundings_of_tests)));
  record.inner_radius = min(static_cast<Real>(shape.inner_radius / shape.radius), one_minus_epsilon<Real>);
  record.inner_rim = record.inner_radius - error;
  return record;
}

/// Returns whether lengths in both spaces can be squared in this precision.
template <class Real>
bool is_resolved(const QuadricRecord<Real>& quadric) {
  for (const auto& vectors : {quadric.world_from_object, quadric.object_from_world})
    for (int i = 0; i < 3; ++i)
      if (const Real squared = length_squared(vectors[i]);
          !(squared > 0 && std::isfinite(1 / squared) && std::isfinite(squared)))
        return false;
  return true;
}

void check_mesh(const Shape& shape, const Mesh& mesh) {
  const size_t vertices = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0)
    throw InputError(shape.where, "the number of the mesh's indices is not a multiple of 3");
  for (const uint32_t index : mesh.indices)
    if (index >= vertices)
      throw InputError(shape.where, "vertex index " + std::to_string(index) + " is out of range: the mesh has " +
                                        std::to_string(vertices) + " vertices");
  const auto fits = [&](const auto& values) { return values.empty() || values.size() == vertices; };
  if (!fits(mesh.normals) || !fits(mesh.uvs))
    throw InputError(shape.where, "the mesh has a different number of normals or uvs than of vertices");
  if (!fits(mesh.second_uvs) || !fits(mesh.colours) || !fits(mesh.tangents))
    throw InputError(shape.where,
                     "the mesh has a different number of second uvs, colours or tangents than of vertices");
}

/// Makes the longest edge of a narrow triangle the one opposite to vertex 0. The normal and the area are computed
/// from the other two, whose product loses nothing if one of them is short. Returns by how many vertices it was turned.
template <class Real>
uint32_t turn_if_narrow(const std::vector<Vec3<Real>>& positions, TriangleRecord& triangle) {
  uint32_t(&v)[3] = triangle.vertex;
  const Vec3<Real> p[3] = {positions[v[0]], positions[v[1]], positions[v[2]]};
  if (!is_narrow(p[0], p[1], p[2])) return 0;
  const Real opposite[3] = {length_squared(p[2] - p[1]), length_squared(p[0] - p[2]), length_squared(p[1] - p[0])};
  const ptrdiff_t turn = std::max_element(opposite, opposite + 3) - opposite;
  std::rotate(v, v + turn, v + 3);
  return static_cast<uint32_t>(turn);
}

/// Index into `materials`, where the default material follows those of the scene.
uint32_t material_of(const Scene& scene, const Shape& shape) {
  if (shape.material == no_index) return static_cast<uint32_t>(scene.materials.size());
  if (shape.material >= scene.materials.size()) throw InputError(shape.where, "the shape names no material");
  return shape.material;
}

}  // namespace

template <class Real>
ShapeBuilder<Real>::ShapeBuilder(Scene& scene, const CompiledMaterials& materials, SceneArrays<Real>& out,
                                 std::vector<double>& light_measures, Diagnostics& diagnostics, SceneNames* names,
                                 std::vector<ShapeOrigin>* origins)
    : scene_(scene),
      materials_(materials),
      out_(out),
      light_measures_(light_measures),
      diagnostics_(diagnostics),
      names_(names),
      origins_(origins) {}

template <class Real>
void ShapeBuilder<Real>::count(const std::vector<ShapePlacement>& placements) {
  uses_.resize(scene_.meshes.size());
  for (const ShapePlacement& p : placements) {
    if (p.shape->type != ShapeType::mesh) continue;
    const Mesh& mesh = mesh_of(scene_, *p.shape);
    ++uses_[p.shape->mesh];
    sizes_.triangles += mesh.triangle_count();
    sizes_.vertices += mesh.positions.size();
    sizes_.normals += mesh.normals.size();
    sizes_.uvs += mesh.uvs.size() + mesh.second_uvs.size();
  }
}

template <class Real>
void ShapeBuilder<Real>::reserve() {
  out_.triangles.reserve(sizes_.triangles);
  if (origins_) out_.triangle_origins.reserve(sizes_.triangles);
  out_.positions.reserve(sizes_.vertices);
  out_.normals.reserve(sizes_.normals);
  out_.uvs.reserve(sizes_.uvs);
}

template <class Real>
void ShapeBuilder<Real>::place(const ShapePlacement& p) {
  if (names_) {
    object_id_ = names_->object_id(*p.shape, p.instance);
    if (emits(*p.shape)) emissive_objects_.push_back(object_id_);
  }
  origin_ = p.origin;
  if (p.shape->type == ShapeType::sphere) return place_sphere(p);
  if (p.shape->type == ShapeType::cylinder) return place_quadric(p, cylinder_record<Real>, out_.cylinders);
  if (p.shape->type == ShapeType::disk) return place_quadric(p, disk_record<Real>, out_.disks);
  Mesh& mesh = scene_.meshes[p.shape->mesh];
  place_mesh(p, mesh);
  if (--uses_[p.shape->mesh] == 0) mesh = Mesh{};
}

template <class Real>
void ShapeBuilder<Real>::place_sphere(const ShapePlacement& p) {
  const Shape& shape = *p.shape;
  if (!(shape.radius > 0) || !std::isfinite(shape.radius))
    throw InputError(shape.where, "the radius of a sphere must be above 0, not " + std::to_string(shape.radius));
  double scale = 1;
  if (!p.world_from_object.start.is_similarity(scale))
    diagnostics_.warn(shape.where,
                      "a sphere is stretched by an instance; it is rendered as a sphere of the same volume");
  const double radius = shape.radius * scale;
  const auto [centre, motion] = motion_of(scene_, p.world_from_object);
  check_sphere_range<Real>(shape, abs(centre) + abs(motion), radius);
  if (!is_resolved<Real>(radius)) {
    diagnostics_.warn(shape.where, "a sphere is too small for this precision and is left out: scale the scene up");
    return;
  }
  const bool moves = !is_zero(motion);
  const size_t index = moves ? out_.moving_spheres.size() : out_.spheres.size();
  uint32_t light = no_light;
  if (emits(shape))
    light =
        add_light(shape, moves ? LightKind::moving_sphere : LightKind::sphere, index, 4 * pi<double> * radius * radius);
  const uint32_t surface = add_surface(shape, light, no_offset, no_offset, p.reverse_orientation);
  const uint32_t frame = add_sphere_frame(shape, p.world_from_object.start);
  if (moves)
    out_.moving_spheres.push_back(
        {convert<Real>(centre), static_cast<Real>(radius), convert<Real>(motion), surface, frame});
  else
    out_.spheres.push_back({convert<Real>(centre), static_cast<Real>(radius), surface, frame});
}

template <class Real>
uint32_t ShapeBuilder<Real>::add_sphere_frame(const Shape& shape, const Transform& world_from_object) {
  if (!needs_uv(shape) && !origins_) return no_sphere_frame;
  const auto axis = [&](const Vec3d& a) { return convert<Real>(normalize(world_from_object.direction(a))); };
  out_.sphere_frames.push_back({axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})});
  return static_cast<uint32_t>(out_.sphere_frames.size() - 1);
}

template <class Real>
template <class Record>
void ShapeBuilder<Real>::place_quadric(const ShapePlacement& p, Record (*record_of)(const Shape&, const Transform&),
                                       std::vector<Record>& records) {
  const Shape& shape = *p.shape;
  const std::string name = std::string("a ") + name_of(shape);
  const bool has_area =
      shape.type == ShapeType::disk ? shape.inner_radius < shape.radius : shape.z_min < shape.z_max && shape.radius > 0;
  if (!(has_area && shape.inner_radius >= 0 && shape.phi_max > 0))
    throw InputError(shape.where, name + " must have a radius, a height or width, and an angle above 0");
  if (emits(shape)) diagnostics_.warn(shape.where, name + " that is no mesh does not emit");
  if (p.world_from_object.is_moving())
    diagnostics_.warn(shape.where, name + " moves; it is rendered at rest, where it is at the start");
  Record record = record_of(shape, p.world_from_object.start);
  if (!is_resolved(record)) {
    diagnostics_.warn(shape.where, name + " is too small or too thin for this precision and is left out");
    return;
  }
  record.surface = add_surface(shape, no_light, no_offset, no_offset, p.reverse_orientation);
  records.push_back(record);
}

template <class Real>
void ShapeBuilder<Real>::place_mesh(const ShapePlacement& p, const Mesh& mesh) {
  const Shape& shape = *p.shape;
  check_mesh(shape, mesh);
  if (p.world_from_object.is_moving())
    diagnostics_.warn(shape.where, "an emissive mesh moves; it is rendered at rest, where it is at the start");
  const Transform& transform = p.world_from_object.start;
  const uint32_t base = static_cast<uint32_t>(out_.positions.size());
  const auto offset_to = [&](size_t count) { return static_cast<uint32_t>(count) - base; };
  for (const Vec3d& position : mesh.positions) {
    const Vec3<Real> moved = convert<Real>(transform.point(position));
    if (!is_finite(moved)) throw InputError(shape.where, "a vertex of the mesh is not finite");
    if (static_cast<double>(max_component(abs(moved))) > max_coordinate<Real>)
      throw precision_error<Real>(shape, "a vertex of the mesh is too far away");
    out_.positions.push_back(moved);
  }
  const uint32_t normal_offset = mesh.normals.empty() ? no_offset : offset_to(out_.normals.size());
  for (const Vec3f& normal : mesh.normals) {
    const Vec3d n = transform.normal(convert<double>(normal));
    out_.normals.push_back(length_squared(n) > 0 ? convert<Real>(normalize(n)) : Vec3<Real>{});
  }
  const uint32_t uv_offset = mesh.uvs.empty() ? no_offset : offset_to(out_.uvs.size());
  for (const Vec2f& uv : mesh.uvs) out_.uvs.push_back({static_cast<Real>(uv.x), static_cast<Real>(uv.y)});
  // Shading normals define the front if there are any; otherwise the winding in object space does.
  const bool flip =
      mesh.normals.empty() ? p.reverse_orientation != transform.swaps_handedness() : p.reverse_orientation;
  add_triangles(shape, mesh, base, normal_offset, uv_offset, flip, add_attributes(p, mesh, base));
}

/// Adds the vertex attributes other than normals and uvs.
template <class Real>
uint32_t ShapeBuilder<Real>::add_attributes(const ShapePlacement& p, const Mesh& mesh, uint32_t base) {
  const Transform& transform = p.world_from_object.start;
  // Flipping a normal changes the handedness, as a mirror transform does.
  const bool swaps_handedness = transform.swaps_handedness() != p.reverse_orientation;
  if (mesh.second_uvs.empty() && mesh.colours.empty() && mesh.tangents.empty()) return no_offset;
  const auto offset_to = [&](const auto& values, size_t count) {
    return values.empty() ? no_offset : static_cast<uint32_t>(count) - base;
  };
  const AttributesRecord record{offset_to(mesh.second_uvs, out_.uvs.size()),
                                offset_to(mesh.colours, out_.vertex_colours.size()),
                                offset_to(mesh.tangents, out_.vertex_tangents.size())};
  for (const Vec2f& uv : mesh.second_uvs) out_.uvs.push_back({static_cast<Real>(uv.x), static_cast<Real>(uv.y)});
  for (const auto& c : mesh.colours) out_.vertex_colours.push_back({c[0], c[1], c[2], c[3]});
  for (const auto& t : mesh.tangents) {
    const Vec3d along = transform.direction(convert<double>(Vec3f{t[0], t[1], t[2]}));
    const double size = length(along);
    const Vec3f unit = size > 0 ? convert<float>(along / size) : Vec3f{};
    const float handedness = (t[3] < 0) != swaps_handedness ? -1.0f : 1.0f;
    out_.vertex_tangents.push_back({unit.x, unit.y, unit.z, handedness});
  }
  out_.vertex_attributes.push_back(record);
  return static_cast<uint32_t>(out_.vertex_attributes.size() - 1);
}

template <class Real>
void ShapeBuilder<Real>::add_triangles(const Shape& shape, const Mesh& mesh, uint32_t base, uint32_t normal_offset,
                                       uint32_t uv_offset, bool flip, uint32_t attributes) {
  const uint32_t shared = emits(shape) ? 0 : add_surface(shape, no_light, normal_offset, uv_offset, flip, attributes);
  const bool has_default_uv = uv_offset == no_offset && needs_uv(shape);  // by the order of the vertices
  size_t without_area = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    TriangleRecord triangle{{base + mesh.indices[i], base + mesh.indices[i + 1], base + mesh.indices[i + 2]}, shared};
    const uint32_t turn = has_default_uv ? 0 : turn_if_narrow(out_.positions, triangle);
    const Vec3<Real> p0 = out_.positions[triangle.vertex[0]];
    const Real twice_area =
        length(cross(out_.positions[triangle.vertex[1]] - p0, out_.positions[triangle.vertex[2]] - p0));
    if (!std::isfinite(twice_area)) throw precision_error<Real>(shape, "a triangle of the mesh is too large");
    if (!(twice_area > 0) || !std::isfinite(1 / twice_area)) {
      ++without_area;
      continue;
    }
    if (emits(shape)) {
      const uint32_t light =
          add_light(shape, LightKind::triangle, out_.triangles.size(), 0.5 * static_cast<double>(twice_area));
      triangle.surface = add_surface(shape, light, normal_offset, uv_offset, flip, attributes);
    }
    out_.triangles.push_back(triangle);
    if (origins_) out_.triangle_origins.push_back({static_cast<uint32_t>(i / 3) & max_primitives_of_a_kind, turn & 3});
  }
  if (without_area > 0 && without_area_ == 0) without_area_place_ = shape.where;
  without_area_ += without_area;
}

template <class Real>
void ShapeBuilder<Real>::warn_of_dropped_triangles() const {
  if (without_area_ == 0) return;
  const char* const what = sizeof(Real) == sizeof(float)
                               ? " triangles have no area, or less than --precision float resolves, and are left out "
                                 "(the first of them here)"
                               : " triangles have no area and are left out (the first of them here)";
  diagnostics_.warn(without_area_place_, std::to_string(without_area_) + " of " +
                                             std::to_string(without_area_ + out_.triangles.size()) + what);
}

template <class Real>
uint32_t ShapeBuilder<Real>::add_surface(const Shape& shape, uint32_t light, uint32_t normal_offset, uint32_t uv_offset,
                                         bool flip, uint32_t attributes) {
  out_.surfaces.push_back({material_of(scene_, shape), light, normal_offset, uv_offset, flip ? 1u : 0u, attributes});
  if (names_) {
    out_.surfaces.back().object_id = object_id_;
    out_.surfaces.back().material_id = names_->material_id(shape.material);
  }
  if (origins_) origins_->push_back(origin_);
  surface_shapes_.push_back(&shape);
  return static_cast<uint32_t>(out_.surfaces.size() - 1);
}

template <class Real>
LightRecord<Real> shape_light(const Shape& shape, const Scene& scene, const CompiledMaterials& materials) {
  const Emission& emission = *shape.emission;
  LightRecord<Real> light{};
  light.radiance = convert<Real>(emission.radiance);
  if (!is_finite(light.radiance))
    throw InputError(shape.where, "the radiance of the light is not finite in this precision: reduce it");
  const bool has_back = shape.material == no_index || scene.materials[material_of(scene, shape)].double_sided;
  light.two_sided = emission.two_sided && has_back ? 1 : 0;
  if (emission.texture != no_index) light.texture = materials.emission.at(emission.texture);
  return light;
}

/// Transparent emitters are found by BSDF sampling alone: light samples do not account for their transparency.
template <class Real>
uint32_t ShapeBuilder<Real>::add_light(const Shape& shape, LightKind kind, size_t primitive, double area) {
  LightRecord<Real> light = shape_light<Real>(shape, scene_, materials_);
  light.kind = kind;
  light.primitive = static_cast<uint32_t>(primitive);
  out_.lights.push_back(light);
  if (names_) light_objects_.push_back(object_id_);
  const bool is_opaque = shape.material == no_index || scene_.materials[material_of(scene_, shape)].alpha == no_index;
  light_measures_.push_back(is_opaque ? area : 0);
  return static_cast<uint32_t>(out_.lights.size() - 1);
}

template <class Real>
bool ShapeBuilder<Real>::needs_uv(const Shape& shape) const {
  const bool has_emission_texture = shape.emission && shape.emission->texture != no_index;
  return has_emission_texture || (shape.material != no_index && materials_.needs_uv[shape.material]);
}

template LightRecord<float> shape_light(const Shape&, const Scene&, const CompiledMaterials&);
template LightRecord<double> shape_light(const Shape&, const Scene&, const CompiledMaterials&);
template class ShapeBuilder<float>;
template class ShapeBuilder<double>;

}  // namespace alhazen::impl
