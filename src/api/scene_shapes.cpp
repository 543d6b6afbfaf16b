// The shapes, groups and instances of a public scene.

#include <utility>

#include "alhazen/scene.h"
#include "api/parts.h"
#include "scene/default_view.h"

namespace ALHAZEN_NAMESPACE {

namespace {

void set_geometry(const impl::SceneState& state, const Shape& given, impl::Shape& shape) {
  const auto phi_max = [](double degrees) {
    if (!(degrees > 0 && degrees <= 360)) impl::refuse_argument("phi_max", "must be over 0 and at most 360 degrees");
    return degrees;
  };
  if (const auto* sphere = std::get_if<Sphere>(&given.geometry)) {
    shape.type = impl::ShapeType::sphere;
    shape.radius = impl::positive_number("radius", sphere->radius);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&given.geometry)) {
    shape.type = impl::ShapeType::cylinder;
    shape.radius = impl::positive_number("radius", cylinder->radius);
    shape.z_min = impl::finite_number("z_min", cylinder->z_min);
    shape.z_max = impl::finite_number("z_max", cylinder->z_max);
    if (!(shape.z_min < shape.z_max)) impl::refuse_argument("z_min", "must be under 'z_max'");
    shape.phi_max = phi_max(cylinder->phi_max);
  } else if (const auto* disk = std::get_if<Disk>(&given.geometry)) {
    shape.type = impl::ShapeType::disk;
    shape.radius = impl::positive_number("radius", disk->radius);
    shape.inner_radius = impl::non_negative_number("inner_radius", disk->inner_radius);
    if (!(shape.inner_radius < shape.radius)) impl::refuse_argument("inner_radius", "must be under 'radius'");
    shape.z_min = shape.z_max = impl::finite_number("height", disk->height);
    shape.phi_max = phi_max(disk->phi_max);
  } else {
    shape.type = impl::ShapeType::mesh;
    shape.mesh = impl::index_of("geometry", std::get<MeshId>(given.geometry), state);
  }
}

/// Refuses what no image can show. Of shapes in groups the place in the world is not known, and points of meshes are
/// too many to be looked at.
void check_reach(const impl::Shape& shape, const impl::MovingTransform& world_from_object, uint32_t group,
                 const char* transform_name) {
  if (shape.type == impl::ShapeType::mesh || group != 0) return;
  const auto is_near = [](const impl::Vec3d& p) { return max_component(abs(p)) < impl::max_reach; };
  const impl::Scene no_meshes;
  for (const impl::Transform* transform : {&world_from_object.start, &world_from_object.end}) {
    bool fits = true;
    impl::for_each_point(no_meshes, shape, *transform, [&](const impl::Vec3d& p) { fits = fits && is_near(p); });
    if (fits) continue;
    const char* const size = shape.radius < impl::max_reach ? "z_max" : "radius";
    impl::refuse_argument(is_near(shape.reach()) ? transform_name : size,
                          "reaches farther than 1e18, which is too far for ray tracing: scale the scene down");
  }
}

/// `shape` is the one that is changed, or a new one.
impl::Shape described_shape(const impl::SceneState& state, const Shape& given, impl::Shape shape, uint32_t group) {
  set_geometry(state, given, shape);
  shape.material = given.material ? impl::index_of("material", given.material, state) : impl::no_index;
  shape.world_from_object = impl::moving_transform("transform", given.transform);
  check_reach(shape, shape.world_from_object, group, "transform");
  shape.emission.reset();
  if (given.emission) {
    impl::Emission& emission = shape.emission.emplace();
    emission.radiance = impl::light_colour("radiance", given.emission->radiance);
    emission.two_sided = given.emission->two_sided;
    if (given.emission->texture) emission.texture = impl::index_of("texture", given.emission->texture, state);
  }
  shape.reverse_orientation = given.reverse_orientation;
  shape.name = given.name;
  if (shape.where.file.empty()) shape.where.file = given.name;
  return shape;
}

Shape public_shape(const impl::SceneState& state, const impl::Shape& shape) {
  Shape result;
  switch (shape.type) {
    case impl::ShapeType::sphere:
      result.geometry = Sphere{shape.radius};
      break;
    case impl::ShapeType::cylinder:
      result.geometry = Cylinder{shape.radius, shape.z_min, shape.z_max, shape.phi_max};
      break;
    case impl::ShapeType::disk:
      result.geometry = Disk{shape.radius, shape.inner_radius, shape.z_min, shape.phi_max};
      break;
    case impl::ShapeType::mesh:
      result.geometry = impl::handle_of<MeshId>(shape.mesh, state.meshes);
      break;
  }
  result.material = impl::handle_of<MaterialId>(shape.material, state.materials);
  result.transform = impl::public_transform(shape.world_from_object);
  if (shape.emission)
    result.emission = Emission{impl::public_colour(shape.emission->radiance), shape.emission->two_sided,
                               impl::handle_of<TextureId>(shape.emission->texture, state.textures)};
  result.reverse_orientation = shape.reverse_orientation;
  result.name = shape.name;
  return result;
}

bool is_same(const impl::MovingTransform& a, const impl::MovingTransform& b) {
  return a.start == b.start && a.end == b.end;
}

bool is_same(const std::optional<impl::Emission>& a, const std::optional<impl::Emission>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->radiance == b->radiance && a->two_sided == b->two_sided && a->texture == b->texture;
}

bool has_same_geometry(const impl::Shape& a, const impl::Shape& b) {
  return a.type == b.type && a.radius == b.radius && a.inner_radius == b.inner_radius && a.z_min == b.z_min &&
         a.z_max == b.z_max && a.phi_max == b.phi_max && a.mesh == b.mesh && a.material == b.material &&
         a.reverse_orientation == b.reverse_orientation && a.name == b.name &&
         a.emission.has_value() == b.emission.has_value();
}

/// Replaces a shape and counts what changes.
void replace_shape(impl::SceneState& state, impl::Shape& shape, impl::Shape&& by) {
  if (!has_same_geometry(shape, by)) ++state.revisions.geometry;
  if (!is_same(shape.world_from_object, by.world_from_object)) ++state.revisions.transforms;
  if (!is_same(shape.emission, by.emission)) ++state.revisions.lights;
  shape = std::move(by);
}

impl::Shape& shape_at(impl::SceneState& state, ShapeId shape) {
  const impl::ShapePlace place = impl::index_of("shape", shape, state);
  return state.description.groups[place.group].shapes[place.index];
}

impl::Instance described_instance(const impl::SceneState& state, const Instance& given, impl::Instance instance) {
  instance.group = impl::index_of("group", given.group, state);
  instance.world_from_group = impl::moving_transform("transform", given.transform);
  instance.reverse_orientation = given.reverse_orientation;
  instance.name = given.name;
  if (instance.where.file.empty()) instance.where.file = given.name;
  return instance;
}

}  // namespace

ShapeId Scene::add(const Shape& shape, GroupId group) {
  impl::SceneState& s = state();
  const uint32_t in = group ? impl::index_of("group", group, s) : 0;
  impl::Shape described = described_shape(s, shape, {}, in);
  const auto handle = static_cast<uint32_t>(s.shape_places.size());
  std::vector<impl::Shape>& shapes = s.description.groups[in].shapes;
  s.shape_places.push_back({in, static_cast<uint32_t>(shapes.size())});
  if (described.emission) ++s.revisions.lights;
  shapes.push_back(std::move(described));
  s.shapes.add(handle, s.id);
  ++s.revisions.geometry;
  return impl::handle_of<ShapeId>(handle, s.shapes);
}

Shape Scene::shape(ShapeId shape) const {
  const impl::ShapePlace place = impl::index_of("shape", shape, state());
  return public_shape(state(), state().description.groups[place.group].shapes[place.index]);
}

void Scene::set(ShapeId id, const Shape& shape) {
  impl::Shape& present = shape_at(state(), id);
  const uint32_t group = impl::index_of("shape", id, state()).group;
  replace_shape(state(), present, described_shape(state(), shape, present, group));
}

void Scene::set_transform(ShapeId shape, const MovingTransform& world_from_object) {
  impl::Shape& present = shape_at(state(), shape);
  const impl::MovingTransform transform = impl::moving_transform("world_from_object", world_from_object);
  if (is_same(transform, present.world_from_object)) return;
  check_reach(present, transform, impl::index_of("shape", shape, state()).group, "world_from_object");
  present.world_from_object = transform;
  ++state().revisions.transforms;
}

void Scene::set_material(ShapeId shape, MaterialId material) {
  impl::Shape& present = shape_at(state(), shape);
  const uint32_t index = material ? impl::index_of("material", material, state()) : impl::no_index;
  if (present.material != index) ++state().revisions.geometry;
  present.material = index;
}

void Scene::remove(ShapeId shape) {
  impl::SceneState& s = state();
  const impl::ShapePlace place = impl::index_of("shape", shape, s);
  std::vector<impl::Shape>& shapes = s.description.groups[place.group].shapes;
  if (shapes[place.index].emission) ++s.revisions.lights;
  shapes.erase(shapes.begin() + place.index);
  for (impl::ShapePlace& other : s.shape_places)
    if (other.group == place.group && other.index > place.index) --other.index;
  s.shape_places[impl::HandleAccess::index(shape)].group = impl::no_index;
  ++s.revisions.geometry;
}

GroupId Scene::group_of(ShapeId shape) const {
  const uint32_t group = impl::index_of("shape", shape, state()).group;
  return group == 0 ? GroupId{} : impl::handle_of<GroupId>(group, state().groups);
}

GroupId Scene::add_group(const std::string& name) {
  impl::SceneState& s = state();
  const auto index = static_cast<uint32_t>(s.description.groups.size());
  s.description.groups.push_back({name, {}});
  s.groups.add(index, s.id);
  ++s.revisions.geometry;
  return impl::handle_of<GroupId>(index, s.groups);
}

InstanceId Scene::add(const Instance& instance) {
  impl::SceneState& s = state();
  impl::Instance described = described_instance(s, instance, {});
  const auto handle = static_cast<uint32_t>(s.instance_places.size());
  s.instance_places.push_back(static_cast<uint32_t>(s.description.instances.size()));
  s.description.instances.push_back(std::move(described));
  s.instances.add(handle, s.id);
  ++s.revisions.geometry;
  ++s.revisions.transforms;
  return impl::handle_of<InstanceId>(handle, s.instances);
}

Instance Scene::instance(InstanceId instance) const {
  const impl::Instance& i = state().description.instances[impl::index_of("instance", instance, state())];
  return {.group = impl::handle_of<GroupId>(i.group, state().groups),
          .transform = impl::public_transform(i.world_from_group),
          .reverse_orientation = i.reverse_orientation,
          .name = i.name};
}

void Scene::set(InstanceId id, const Instance& instance) {
  impl::Instance& present = state().description.instances[impl::index_of("instance", id, state())];
  impl::Instance described = described_instance(state(), instance, present);
  if (described.group != present.group || described.reverse_orientation != present.reverse_orientation ||
      described.name != present.name)
    ++state().revisions.geometry;
  if (!is_same(described.world_from_group, present.world_from_group)) ++state().revisions.transforms;
  present = std::move(described);
}

void Scene::set_transform(InstanceId instance, const MovingTransform& world_from_group) {
  impl::Instance& present = state().description.instances[impl::index_of("instance", instance, state())];
  const impl::MovingTransform transform = impl::moving_transform("world_from_group", world_from_group);
  if (is_same(transform, present.world_from_group)) return;
  present.world_from_group = transform;
  ++state().revisions.transforms;
}

void Scene::remove(InstanceId instance) {
  impl::SceneState& s = state();
  const uint32_t place = impl::index_of("instance", instance, s);
  s.description.instances.erase(s.description.instances.begin() + place);
  for (uint32_t& other : s.instance_places)
    if (other != impl::no_index && other > place) --other;
  s.instance_places[impl::HandleAccess::index(instance)] = impl::no_index;
  ++s.revisions.geometry;
  ++s.revisions.transforms;
}

}  // namespace ALHAZEN_NAMESPACE
