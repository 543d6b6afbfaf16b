#include "io/mitsuba/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "io/mitsuba/bsdfs.h"
#include "io/mitsuba/meshes.h"
#include "io/mitsuba/textures.h"
#include "util/quoted.h"
#include "util/suggestion.h"

namespace alhazen::impl::mitsuba {

namespace {

/// A shape being read, and the shapes of the scene that it becomes.
struct ShapeRequest {
  Build& build;
  ObjectReader& reader;
  std::vector<Shape> shapes;
  bool is_open = false;   ///< has an inside that can be seen
  bool in_group = false;  ///< within a group of shapes
  bool emits = false;
};

constexpr uint64_t max_shapes = 10'000'000;

MovingTransform at_rest(const Transform& transform) { return {transform, transform}; }

Shape& add(ShapeRequest& request, const Transform& world_from_object) {
  Shape shape;
  shape.world_from_object = at_rest(world_from_object);
  shape.where = request.reader.place().location();
  return request.shapes.emplace_back(std::move(shape));
}

Shape& add_mesh(ShapeRequest& request, uint32_t mesh, const Transform& world_from_object) {
  Shape& shape = add(request, world_from_object);
  shape.mesh = mesh;
  return shape;
}

void read_sphere(ShapeRequest& request) {
  ObjectReader& reader = request.reader;
  const double radius = reader.positive("radius", 1);
  const Transform world = reader.transform("to_world") * Transform::translate(reader.vector("center", {})) *
                          Transform::scale(splat(radius));
  double scale = 1;
  if (!world.is_similarity(scale)) {
    add_mesh(request, sphere_mesh(request.build), world);
    return;
  }
  // v is 0 at +z in the format, and at -z here.
  add(request, world * Transform::scale({1, 1, -1})).type = ShapeType::sphere;
}

/// Whether a cylinder stays a round one, neither thin as a wire nor flat as a coin.
bool is_exact_cylinder(const Transform& world) {
  const Vec3d x = world.direction({1, 0, 0}), y = world.direction({0, 1, 0}), z = world.direction({0, 0, 1});
  const double radius = length(x), height = length(z);
  const bool is_straight = std::abs(dot(x, z)) < 1e-6 * radius * height && std::abs(dot(y, z)) < 1e-6 * radius * height;
  const bool is_round = std::abs(length(y) - radius) < 1e-6 * radius && std::abs(dot(x, y)) < 1e-6 * radius * radius;
  return is_straight && is_round && height < 1000 * radius && radius < 1000 * height;
}

void read_cylinder(ShapeRequest& request) {
  ObjectReader& reader = request.reader;
  const Vec3d from = reader.vector("p0", {}), axis = reader.vector("p1", {0, 0, 1}) - from;
  const double radius = reader.positive("radius", 1), height = length(axis);
  if (!(height > 0)) fail(reader.place_of("p1"), "'p0' and 'p1' of a cylinder must be two points apart");
  const Frame<double> frame = frame_about(axis / height);
  Matrix4 local = Transform().matrix();
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<size_t>(i);
    local[row] = {frame.tangent[i] * radius, frame.bitangent[i] * radius, axis[i], from[i]};
  }
  const Transform world = reader.transform("to_world") * Transform(local);
  request.is_open = true;
  if (request.emits || request.in_group || !is_exact_cylinder(world)) {
    add_mesh(request, cylinder_mesh(request.build), world);
    return;
  }
  Shape& shape = add(request, world);
  shape.type = ShapeType::cylinder;
  shape.z_min = 0, shape.z_max = 1;
}

void read_rectangle(ShapeRequest& request) {
  request.is_open = true;
  add_mesh(request, rectangle_mesh(request.build), request.reader.transform("to_world"));
}

void read_disk(ShapeRequest& request) {
  request.is_open = true;
  add_mesh(request, disk_mesh(request.build), request.reader.transform("to_world"));
}

void read_cube(ShapeRequest& request) {
  add_mesh(request, cube_mesh(request.build), request.reader.transform("to_world"));
  request.reader.ignore({"face_normals"});
}

void read_mesh(ShapeRequest& request) {
  const Transform world = request.reader.transform("to_world");
  for (const ReadMesh& read : read_mesh_file(request.build, request.reader)) {
    Shape& shape = add_mesh(request, read.mesh, world);
    // Winding counts in world space, but is that in the space of the object here.
    shape.reverse_orientation = !read.has_own_normals && world.swaps_handedness();
    if (!request.build.has_warned_of_backs && !request.is_open)
      request.is_open = is_open(request.build.scene.meshes[read.mesh]);
  }
}

using ShapeReader = void (*)(ShapeRequest&);
const std::map<std::string, ShapeReader> shape_readers{
    {"sphere", read_sphere}, {"cylinder", read_cylinder}, {"rectangle", read_rectangle},
    {"disk", read_disk},     {"cube", read_cube},         {"obj", read_mesh},
    {"ply", read_mesh},      {"serialized", read_mesh}};

const std::set<std::string_view> omitted_shapes{"bsplinecurve",   "linearcurve", "sdfgrid",    "ellipsoids",
                                                "ellipsoidsmesh", "hair",        "heightfield"};

std::optional<Emission> read_emission(Build& build, uint32_t object, bool in_group) {
  ObjectReader reader(build.document, object);
  const std::string& type = reader.object().type;
  if (type == "directionalarea") {
    build.warn(reader.place(), "the emitter 'directionalarea' is not supported; its shape does not emit");
    return {};
  }
  if (type != "area") fail(reader.place(), "the emitter of a shape must be 'area', not " + quoted(type));
  if (reader.has("to_world")) fail(reader.place_of("to_world"), "an area light has the transform of its shape");
  if (in_group) fail(reader.place(), "shapes of a group cannot emit, as they are placed by instances");
  Emission emission;
  emission.radiance = {1, 1, 1};
  const uint32_t radiance = colour_texture(build, reader, "radiance", ColourUse::unbounded, {1, 1, 1});
  if (const std::optional<Vec3d> constant = constant_value(build, radiance))
    emission.radiance = *constant;
  else
    emission.texture = radiance;
  reader.ignore({"sampling_weight"});
  reader.reject_unknown();
  return emission;
}

ReadBsdf bsdf_of(Build& build, ObjectReader& reader) {
  const std::vector<const Property*> found = reader.objects("bsdf");
  if (found.size() > 1) fail(found[1]->place, "a shape has one BSDF; here is another");
  return found.empty() ? default_bsdf(build) : read_bsdf(build, *found[0]);
}

void warn_of_media(Build& build, ObjectReader& reader) {
  for (const Property* medium : reader.objects("medium"))
    build.warn(medium->place, "participating media are not supported; they are omitted");
}

/// How many shapes an object makes, itself included, in steps of the reader: merges may name others twice each.
uint64_t shapes_made(Build& build, uint32_t object) {
  if (build.document.objects[object].type != "merge") return 1;
  const auto [entry, is_new] = build.merged_shapes.try_emplace(object, 1u);
  if (!is_new) return entry->second;
  for (const Property& property : build.document.objects[object].properties)
    if (property.kind == ValueKind::object && build.object(property).tag == "shape")
      entry->second = std::min(entry->second + shapes_made(build, property.object), max_shapes + 1);
  return entry->second;
}

void add_to_group(Build& build, uint32_t object, uint32_t group);

/// Adds a shape of the scene or of a group of shapes, unless there are too many.
void add_limited(Build& build, const Property& property, uint32_t group) {
  build.shape_count += shapes_made(build, property.object);
  if (build.shape_count > max_shapes)
    fail(property.place,
         "the scene has over 10 million shapes, as shapes of type 'merge' repeat others: use instances");
  add_to_group(build, property.object, group);
}

/// The group of an instance, whose shapes are read when the first instance names it.
uint32_t group_of(Build& build, uint32_t object) {
  const auto [entry, is_new] = build.groups.try_emplace(object, 0u);
  if (!is_new) return entry->second;
  ObjectReader reader(build.document, object);
  const auto group = static_cast<uint32_t>(build.scene.groups.size());
  entry->second = group;
  build.scene.groups.emplace_back().name = reader.object().id;
  for (const Property* shape : reader.objects("shape")) add_limited(build, *shape, group);
  reader.reject_unknown();
  return group;
}

void add_instance(Build& build, ObjectReader& reader) {
  const std::vector<const Property*> found = reader.objects("shape");
  if (found.size() != 1 || build.object(*found[0]).type != "shapegroup")
    fail(reader.place(), "an instance takes one shape of type 'shapegroup', by <ref id=\"...\"/>");
  Instance instance;
  instance.group = group_of(build, found[0]->object);
  instance.world_from_group = at_rest(reader.transform("to_world"));
  instance.where = reader.place().location();
  reader.reject_unknown();
  build.scene.instances.push_back(instance);
}

void add_to_group(Build& build, uint32_t object, uint32_t group) {
  ObjectReader reader(build.document, object);
  const std::string& type = reader.object().type;
  if (type == "shapegroup" || type == "instance") {
    if (group != 0) fail(reader.place(), "a group of shapes cannot contain " + reader.name());
    if (type == "instance") add_instance(build, reader);
    return;
  }
  if (type == "merge") {
    for (const Property* shape : reader.objects("shape")) add_to_group(build, shape->object, group);
    reader.reject_unknown();
    return;
  }
  if (omitted_shapes.contains(type)) {
    build.warn(reader.place(), "shapes of type " + quoted(type) + " are not supported; they are omitted");
    return;
  }
  const auto known = shape_readers.find(type);
  if (known == shape_readers.end()) {
    std::vector<std::string> types{"instance", "shapegroup", "merge"};
    for (const auto& [name, each] : shape_readers) types.push_back(name);
    fail(reader.place(), "unknown shape " + quoted(type) + suggestion(type, types));
  }
  ShapeRequest request{build, reader, {}, false, group != 0, false};
  ReadBsdf bsdf = bsdf_of(build, reader);
  std::optional<Emission> emission;
  const std::vector<const Property*> emitters = reader.objects("emitter");
  if (emitters.size() > 1) fail(emitters[1]->place, "a shape has one emitter; here is another");
  if (!emitters.empty()) emission = read_emission(build, emitters[0]->object, group != 0);
  request.emits = emission.has_value();
  known->second(request);
  const bool flips = reader.boolean("flip_normals", false);
  warn_of_media(build, reader);
  for (const Property* sensor : reader.objects("sensor"))
    build.warn(sensor->place, "sensors that are shapes are not supported; they are omitted");
  reader.ignore({"silhouette_sampling_weight"});
  if (reader.object().is_of_version_1 && reader.find("max_smooth_angle"))
    build.warn(reader.place_of("max_smooth_angle"), "'maxSmoothAngle' is not supported; it is ignored");
  reader.reject_unknown();
  if (emission && bsdf.material == no_index) {
    build.warn(reader.place(), "an emitter whose BSDF is 'null' is not supported; its surface stops light");
    Material black;
    black.reflectance = build.constant_texture({});
    build.scene.materials.push_back(black);
    bsdf = {static_cast<uint32_t>(build.scene.materials.size() - 1), false};
  }
  if (bsdf.material == no_index) return;
  if (bsdf.is_black_behind && request.is_open && !emission && !build.has_warned_of_backs) {
    build.has_warned_of_backs = true;
    build.warn(reader.place(), "the back of a surface without 'twosided' is black in Mitsuba; here both sides reflect");
  }
  for (Shape& shape : request.shapes) {
    if (!reader.object().id.empty()) shape.name = reader.object().id;
    shape.material = bsdf.material;
    shape.emission = emission;
    shape.reverse_orientation = shape.reverse_orientation != flips;
    build.scene.groups[group].shapes.push_back(std::move(shape));
  }
}

}  // namespace

void add_shape(Build& build, const Property& property) { add_limited(build, property, 0); }

void tessellate_for_instances(Build& build) {
  for (const Instance& instance : build.scene.instances) {
    double scale = 1;
    if (instance.world_from_group.start.is_similarity(scale)) continue;
    for (Shape& shape : build.scene.groups[instance.group].shapes) {
      if (shape.type != ShapeType::sphere) continue;
      shape.type = ShapeType::mesh;
      shape.mesh = sphere_mesh(build);
      shape.world_from_object = at_rest(shape.world_from_object.start * Transform::scale({1, 1, -1}));
    }
  }
}

}  // namespace alhazen::impl::mitsuba
