#include "pipeline/describe_scene.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "scene/default_view.h"
#include "scene/kind_names.h"
#include "scene/scene_names.h"

namespace alhazen::impl {

namespace {

uint64_t bytes_of(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3d) + mesh.indices.size() * sizeof(uint32_t) +
         mesh.normals.size() * sizeof(Vec3f) + (mesh.uvs.size() + mesh.second_uvs.size()) * sizeof(Vec2f) +
         (mesh.tangents.size() + mesh.colours.size()) * sizeof(std::array<float, 4>);
}

const Mesh* mesh_if_any(const Scene& scene, const Shape& shape) {
  return shape.type == ShapeType::mesh && shape.mesh < scene.meshes.size() ? &scene.meshes[shape.mesh] : nullptr;
}

std::string material_name(const Scene& scene, uint32_t index) {
  if (index >= scene.materials.size()) return "default";
  const Material& material = scene.materials[index];
  return material.name.empty() ? std::string(material_kind_name(material.kind)) : material.name;
}

const char* shape_name(ShapeType type) {
  return type == ShapeType::sphere     ? "sphere"
         : type == ShapeType::cylinder ? "cylinder"
         : type == ShapeType::disk     ? "disk"
                                       : "mesh";
}

std::string name_of(const Scene& scene, const Shape& shape) {
  const Mesh* mesh = mesh_if_any(scene, shape);
  if (mesh != nullptr && !mesh->name.empty() && mesh->name != scene.name)
    return std::filesystem::path(mesh->name).filename().string();
  return std::string(shape_name(shape.type)) + ", " + shape.where.to_string();
}

void add_shape(const Scene& scene, const Shape& shape, ObjectDescription& object, std::set<uint32_t>& meshes) {
  const Mesh* mesh = mesh_if_any(scene, shape);
  if (mesh == nullptr) {
    ++object.primitives;
    return;
  }
  object.triangles += mesh->triangle_count();
  if (meshes.insert(shape.mesh).second) object.bytes += bytes_of(*mesh);
}

std::string materials_of(const Scene& scene, const ShapeGroup& group) {
  std::set<uint32_t> materials;
  for (const Shape& shape : group.shapes) materials.insert(shape.material);
  if (materials.empty()) return {};
  return materials.size() == 1 ? material_name(scene, *materials.begin())
                               : std::to_string(materials.size()) + " materials";
}

std::vector<ObjectDescription> objects_of(const Scene& scene) {
  std::vector<ObjectDescription> objects;
  std::set<uint32_t> meshes;
  for (const Shape& shape : scene.groups[0].shapes) {
    ObjectDescription object;
    object.name = name_of(scene, shape);
    object.material = material_name(scene, shape.material);
    add_shape(scene, shape, object, meshes);
    objects.push_back(std::move(object));
  }
  std::vector<uint64_t> instances(scene.groups.size());
  for (const Instance& instance : scene.instances)
    if (instance.group < instances.size()) ++instances[instance.group];
  for (size_t i = 1; i < scene.groups.size(); ++i) {
    const ShapeGroup& group = scene.groups[i];
    ObjectDescription object;
    object.name = !group.name.empty()    ? group.name
                  : group.shapes.empty() ? "object " + std::to_string(i)
                                         : name_of(scene, group.shapes[0]);
    object.instances = instances[i];
    object.material = materials_of(scene, group);
    for (const Shape& shape : group.shapes) add_shape(scene, shape, object, meshes);
    objects.push_back(std::move(object));
  }
  std::stable_sort(objects.begin(), objects.end(), [](const ObjectDescription& a, const ObjectDescription& b) {
    return std::pair(a.triangles * a.instances, a.primitives * a.instances) >
           std::pair(b.triangles * b.instances, b.primitives * b.instances);
  });
  return objects;
}

std::vector<MaterialDescription> materials_of(const Scene& scene) {
  std::vector<MaterialDescription> materials;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    materials.push_back(
        {material_name(scene, static_cast<uint32_t>(i)), material_kind_name(scene.materials[i].kind), 0});
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes)
      if (shape.material < materials.size()) ++materials[shape.material].shapes;
  std::stable_sort(materials.begin(), materials.end(),
                   [](const MaterialDescription& a, const MaterialDescription& b) { return a.shapes > b.shapes; });
  return materials;
}

std::vector<LightDescription> lights_of(const Scene& scene) {
  std::vector<LightDescription> lights;
  const std::vector<std::string> names = light_names(scene);
  for (size_t i = 0; i < names.size(); ++i) {
    const Light& light = scene.lights[i];
    lights.push_back({names[i], light_traits(light.kind).name, light.where, light.radiance, 0});
  }
  SceneNames objects(scene);
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes) {
      const uint32_t id = objects.object_id(shape);
      if (!shape.emission) continue;
      const Mesh* mesh = mesh_if_any(scene, shape);
      lights.push_back({group.name.empty() ? objects.objects()[id - 1] : group.name, "area light", shape.where,
                        shape.emission->radiance, mesh == nullptr ? 0 : mesh->triangle_count()});
    }
  return lights;
}

std::vector<ImageDescription> images_of(const Scene& scene) {
  std::vector<ImageDescription> images;
  const auto add = [&](const std::vector<ImageTexels>& all, const char* use) {
    for (const ImageTexels& image : all)
      images.push_back({image.name, use, image.width, image.height, image.channels, image.floats.empty() ? 8 : 32,
                        image.bytes.size() + image.floats.size() * sizeof(float)});
  };
  add(scene.images, "texture");
  add(scene.environments, "environment map");
  add(scene.light_images, "image of a light");
  std::stable_sort(images.begin(), images.end(),
                   [](const ImageDescription& a, const ImageDescription& b) { return a.bytes > b.bytes; });
  return images;
}

}  // namespace

SceneDescription describe(const Scene& scene) {
  SceneDescription d;
  const std::vector<PlacedShape> placed = placed_shapes(scene);
  for (const PlacedShape& shape : placed) d.bounds.extend(shape.box);
  d.objects = objects_of(scene);
  d.materials = materials_of(scene);
  d.lights = lights_of(scene);
  d.images = images_of(scene);
  d.textures = scene.textures.size();
  d.instances = scene.instances.size();
  for (const ObjectDescription& object : d.objects) {
    d.triangles += object.triangles * object.instances;
    d.stored_triangles += object.triangles;
    d.primitives += object.primitives * object.instances;
    d.mesh_bytes += object.bytes;
  }
  for (const ImageDescription& image : d.images) d.image_bytes += image.bytes;
  return d;
}

}  // namespace alhazen::impl
