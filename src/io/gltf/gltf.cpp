#include "io/gltf/gltf.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <new>
#include <set>
#include <stdexcept>

#include "images/codecs/image_bytes.h"
#include "io/gltf/accessors.h"
#include "io/gltf/cameras_and_lights.h"
#include "io/gltf/materials.h"
#include "io/gltf/meshes.h"
#include "io/gltf/motion.h"
#include "io/gltf/nodes.h"
#include "io/gltf/pointers.h"
#include "io/gltf/validate.h"
#include "scene/default_view.h"

namespace alhazen::impl {

namespace gltf {

namespace {

/// A mesh as placed by a node.
struct Placement {
  uint32_t mesh = 0;
  Matrix4 world = identity;
  MovingTransform motion = {};  ///< `world` while the shutter is open
  Deformation deformation;
  std::string key;   ///< equal for placements that may be instances of each other; empty: not an instance
  std::string name;  ///< of the node, or of its mesh
};

std::vector<std::string> variant_names(const Document& document) {
  std::vector<std::string> names;
  const Json* extension = document.extension(document.root(), "KHR_materials_variants");
  const Json* variants = extension == nullptr ? nullptr : document.list(*extension, "variants");
  if (variants != nullptr)
    for (const Json& variant : variants->items) names.push_back(document.string(variant, "name"));
  return names;
}

std::vector<std::string> animation_names(const Document& document) {
  std::vector<std::string> names;
  for (size_t i = 0; i < document.array("animations").size(); ++i)
    names.push_back(document.string(document.item("animations", i), "name"));
  return names;
}

/// Null if no animation is requested.
const Json* chosen_animation(const Document& document, const ReadOptions& options) {
  if (!options.time && options.animation.empty() && !options.has_motion_blur()) return nullptr;
  const std::vector<std::string> names = animation_names(document);
  const size_t index = choose(document, options.animation.empty() ? "0" : options.animation, names, "animation");
  return &document.item("animations", index);
}

/// Returns whether the matrix is well enough conditioned for a Transform.
bool is_invertible(const Matrix4& m) {
  const double volume = length(column(m, 0)) * length(column(m, 1)) * length(column(m, 2));
  return volume > 1e-100 && std::abs(determinant(m)) > 1e-9 * volume;
}

class SceneReader {
 public:
  SceneReader(const Document& document, const ReadOptions& options)
      : document_(document), options_(options), nodes_(document, accessors_) {}

  Scene run() {
    scene_.name = document_.path();
    scene_.up = {0, 1, 0};
    scene_.samples_per_pixel = 64;
    scene_.quality = "good";
    scene_.max_depth = 8;
    choose_variant();
    choose_animation();
    nodes_.place();
    if (motion_) motion_->warn_of_lights(nodes_);
    for (const uint32_t node : nodes_.drawn()) add_node(node);
    place_all();
    add_lights(document_, nodes_, scene_, nullptr);
    const bool has_camera = set_camera(document_, nodes_, options_.camera, scene_);
    if (!has_camera) fit_camera(scene_, options_.aspect);
    if (has_camera && motion_) move_camera();
    const bool is_lit = !scene_.lights.empty() || emits_;
    scene_.film.fits_exposure = is_lit;
    // A file with a camera and lights is rendered with its own lights; otherwise it is shown as a model.
    if (has_camera && !is_lit && light_closed_room(scene_))
      document_.warn(
          document_.root(),
          "nothing emits light within the walls around the camera; the outermost of them emit light of their own "
          "colour");
    else if (!has_camera || !is_lit)
      add_neutral_light(scene_);
    if (scene_.meshes.empty())
      document_.warn(document_.root(), "the file has no surface to be drawn; the image is empty");
    return std::move(scene_);
  }

 private:
  void choose_variant() {
    if (!options_.variant.empty()) variant_ = choose(document_, options_.variant, variant_names(document_), "variant");
  }

  void choose_animation() {
    const Json* animation = chosen_animation(document_, options_);
    if (animation == nullptr) return;
    const double opening = options_.time.value_or(0);
    nodes_.animate(*animation, opening);
    if (options_.has_motion_blur())
      motion_.emplace(document_, accessors_, *animation, opening, *options_.shutter_seconds);
  }

  void move_camera() {
    Scene closing;
    set_camera(document_, motion_->closing(), options_.camera, closing);
    scene_.camera.world_from_camera.end = closing.camera.world_from_camera.start;
  }

  void warn_of_deformation(const Json& where, const char* what) const {
    document_.warn(where, std::string(what) +
                              " move while the shutter is open: the mesh is rendered in the shape that it has when the "
                              "shutter opens, without motion blur of its own");
  }

  const std::vector<Json>& primitives(uint32_t mesh) const {
    const Json& description = document_.item("meshes", mesh);
    const Json* list = document_.list(description, "primitives");
    if (list == nullptr || list->items.empty()) document_.fail(description, "the mesh has no primitives");
    for (const Json& primitive : list->items)
      if (primitive.kind != JsonKind::object) document_.fail(primitive, "a primitive must be an object");
    return list->items;
  }

  std::vector<double> weights(const Nodes& nodes, uint32_t node, uint32_t mesh) const {
    if (!nodes.pose(node).weights.empty()) return nodes.pose(node).weights;
    const Json& description = document_.item("meshes", mesh);
    const Json* list = document_.list(description, "weights");
    return list == nullptr ? std::vector<double>{} : document_.numbers(description, "weights", list->items.size());
  }

  void add_node(uint32_t node) {
    const Json& description = document_.item("nodes", node);
    const auto mesh = document_.index(description, "mesh", "meshes");
    if (!mesh) return;
    Placement placement;
    placement.mesh = *mesh;
    placement.name = document_.string(description, "name");
    if (placement.name.empty()) placement.name = document_.string(document_.item("meshes", *mesh), "name");
    if (placement.name.empty()) placement.name = "node." + std::to_string(node);
    placement.deformation.weights = weights(nodes_, node, *mesh);
    if (motion_ && placement.deformation.weights != weights(motion_->closing(), node, *mesh))
      warn_of_deformation(description, "morph targets");
    const auto skin = document_.index(description, "skin", "skins");
    if (skin) {
      // A skinned mesh is placed by its joints, wherever its own node is.
      placement.deformation.joints = nodes_.joints(*skin);
      if (motion_ && placement.deformation.joints != motion_->closing().joints(*skin))
        warn_of_deformation(description, "joints of a skin");
      placements_.push_back(placement);
      return;
    }
    placement.key = std::to_string(*mesh);
    for (const double weight : placement.deformation.weights) placement.key += ',' + std::to_string(weight);
    const Json* instancing = document_.extension(description, "EXT_mesh_gpu_instancing");
    if (instancing != nullptr) {
      const std::string name = placement.name;
      size_t number = 0;
      for (const Matrix4& local : instance_matrices(*instancing)) {
        placement.name = name + "." + std::to_string(++number);
        placement.world = multiply(nodes_.world(node), local);
        check_transform(document_, *instancing, placement.world);
        add_placement(placement, node, local);
      }
      return;
    }
    placement.world = nodes_.world(node);
    add_placement(placement, node, identity);
  }

  void add_placement(Placement placement, uint32_t node, const Matrix4& local) {
    if (is_invertible(placement.world)) {
      const Transform world(placement.world);
      placement.motion = motion_ ? motion_->of_mesh(node, placement.world, local, document_.item("nodes", node))
                                 : MovingTransform{world, world};
    } else {
      placement.deformation.baked = placement.world;
      placement.world = identity;
      placement.key.clear();
    }
    if (!placement.key.empty()) ++uses_[placement.key];
    if (placement.motion.is_moving()) moving_.insert(placement.key);
    placements_.push_back(std::move(placement));
  }

  std::vector<Matrix4> instance_matrices(const Json& instancing) {
    const Json* attributes = document_.object(instancing, "attributes");
    if (attributes == nullptr) document_.fail(instancing, "\"attributes\" is missing here");
    std::optional<size_t> count;
    const auto read = [&](const char* name, const char* type) {
      Values values;
      const auto index = document_.index(*attributes, name, "accessors");
      if (!index) return values;
      values = accessors_.floats(*index, {type});
      if (count && *count != values.count)
        document_.fail(*attributes, "the attributes of instances must be equally many");
      count = values.count;
      return values;
    };
    const Values translations = read("TRANSLATION", "VEC3"), rotations = read("ROTATION", "VEC4"),
                 scales = read("SCALE", "VEC3");
    const auto at = [](const Values& values, size_t i, size_t c) { return static_cast<double>(values[i][c]); };
    std::vector<Matrix4> matrices;
    for (size_t i = 0; i < count.value_or(0); ++i) {
      const auto vec3 = [&](const Values& v, double fallback) {
        return v.count == 0 ? splat(fallback) : Vec3d{at(v, i, 0), at(v, i, 1), at(v, i, 2)};
      };
      std::array<double, 4> q{0, 0, 0, 1};
      if (rotations.count > 0) q = {at(rotations, i, 0), at(rotations, i, 1), at(rotations, i, 2), at(rotations, i, 3)};
      matrices.push_back(from_trs(vec3(translations, 0), q, vec3(scales, 1)));
    }
    return matrices;
  }

  /// The primitive's own material, unless a variant is chosen and the primitive has one for it.
  std::optional<uint32_t> material_index(const Json& primitive) const {
    const Json* extension = document_.extension(primitive, "KHR_materials_variants");
    const Json* mappings = extension == nullptr ? nullptr : document_.list(*extension, "mappings");
    if (mappings != nullptr && variant_)
      for (const Json& mapping : mappings->items) {
        const Json* variants = document_.list(mapping, "variants");
        if (variants == nullptr) continue;
        for (const Json& variant : variants->items)
          if (variant.kind == JsonKind::number && variant.number == static_cast<double>(*variant_))
            return document_.required_index(mapping, "material", "materials");
      }
    return document_.index(primitive, "material", "materials");
  }

  bool moves(const Placement& placement) const {
    return placement.motion.is_moving() || (!placement.key.empty() && moving_.contains(placement.key));
  }

  /// A moving mesh is an object, whose backs are not opened to light (compile/open_backs.h): what the camera sees
  /// through them would be black. So it gets both sides.
  uint32_t two_sided(uint32_t material, const Json& where) {
    if (material == no_index || scene_.materials[material].double_sided) return material;
    document_.warn(where,
                   "a one-sided mesh that moves while the shutter is open is rendered with both sides, so it is seen "
                   "from behind, too");
    const auto [entry, is_new] = two_sided_.try_emplace(material, static_cast<uint32_t>(scene_.materials.size()));
    if (is_new) {
      Material copy = scene_.materials[material];
      copy.double_sided = true;
      scene_.materials.push_back(std::move(copy));
    }
    return entry->second;
  }

  std::vector<Shape> shapes(const Placement& placement) {
    std::vector<Shape> result;
    for (const Json& primitive : primitives(placement.mesh)) {
      const MaterialUse& use = materials_.use(material_index(primitive), has_vertex_colours(document_, primitive));
      const auto mesh = meshes_.read(primitive, use, placement.deformation);
      if (!mesh) continue;
      const std::string name = document_.string(document_.item("meshes", placement.mesh), "name");
      if (!name.empty()) scene_.meshes[*mesh].name = name;
      Shape shape;
      shape.mesh = *mesh;
      shape.material = moves(placement) ? two_sided(use.material, primitive) : use.material;
      shape.emission = use.emission;
      shape.where = document_.place(primitive);
      result.push_back(shape);
      emits_ = emits_ || (use.emission && max_component(use.emission->radiance) > 1);
    }
    return result;
  }

  void place_all() {
    std::map<std::string, uint32_t> groups;
    for (const Placement& placement : placements_) {
      const bool is_repeated = !placement.key.empty() && uses_[placement.key] > 1;
      if (is_repeated) {
        const auto entry = groups.find(placement.key);
        if (entry != groups.end()) {
          add_instance(entry->second, placement);
          continue;
        }
      }
      std::vector<Shape> placed = shapes(placement);
      // Lights are distinguished one by one, so emissive meshes are not instanced.
      const bool is_emissive = std::any_of(placed.begin(), placed.end(), [](const Shape& s) { return s.emission; });
      if (is_repeated && !is_emissive) {
        const auto group = static_cast<uint32_t>(scene_.groups.size());
        groups[placement.key] = group;
        scene_.groups.push_back({document_.string(document_.item("meshes", placement.mesh), "name"), placed});
        add_instance(group, placement);
        continue;
      }
      for (Shape& shape : placed) {
        shape.name = placement.name;
        shape.world_from_object = placement.motion;
        scene_.groups[0].shapes.push_back(std::move(shape));
      }
    }
  }

  void add_instance(uint32_t group, const Placement& placement) {
    Instance instance;
    instance.group = group;
    instance.name = placement.name;
    instance.world_from_group = placement.motion;
    instance.where = document_.place(document_.item("meshes", placement.mesh));
    scene_.instances.push_back(instance);
  }

  const Document& document_;
  const ReadOptions& options_;
  Scene scene_;
  Buffers buffers_{document_};
  Accessors accessors_{document_, buffers_};
  Textures textures_{document_, buffers_, scene_};
  Materials materials_{document_, textures_, scene_};
  Meshes meshes_{document_, buffers_, accessors_, scene_};
  Nodes nodes_;
  std::optional<Motion> motion_;  ///< if the shutter stays open
  std::vector<Placement> placements_;
  std::map<std::string, size_t> uses_;
  std::set<std::string> moving_;            ///< keys of placements of which one moves
  std::map<uint32_t, uint32_t> two_sided_;  ///< by material: its copy with both sides
  std::optional<size_t> variant_;
  bool emits_ = false;
};

/// Values that pointers animate are rendered as they are when the shutter opens.
void set_pointed_values(Document& document, const Json& animation, const ReadOptions& options) {
  const double opening = options.time.value_or(0);
  const std::vector<PointedValue> values = pointed_values(document, animation, opening);
  if (options.has_motion_blur()) {
    const std::vector<PointedValue> later = pointed_values(document, animation, opening + *options.shutter_seconds);
    for (size_t i = 0; i < values.size(); ++i)
      if (values[i].numbers != later[i].numbers)
        document.warn(*values[i].channel,
                      "KHR_animation_pointer changes values while the shutter is open: they are rendered as they are "
                      "when it opens, without motion blur");
  }
  write_pointed_values(document, values);
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

}  // namespace gltf

bool is_glb(std::span<const uint8_t> bytes) { return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0; }

Scene parse_gltf(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder,
                 const ReadOptions& options, Diagnostics& diagnostics) {
  gltf::Document document(bytes, path, folder, diagnostics, options.search);
  try {
    gltf::check_extensions(document);
    gltf::validate(document);
    if (const gltf::Json* animation = gltf::chosen_animation(document, options))
      gltf::set_pointed_values(document, *animation, options);
    return gltf::SceneReader(document, options).run();
  } catch (const std::bad_alloc&) {
    throw TooLargeError({path.name}, "the scene is too large for the memory of this machine");
  } catch (const std::length_error&) {
    throw TooLargeError({path.name}, "the scene is too large for the memory of this machine");
  }
}

namespace gltf {

namespace {

/// Reads the bytes of the main file. A file of another kind is refused by its first bytes, however large it is.
std::vector<uint8_t> read_main_file(const InputPath& path) {
  InputFile file(path);
  std::array<char, 4> head{};
  const std::string_view text(head.data(), file.read(head.data(), head.size()));
  const bool may_be_json = text.empty() || std::string_view(" \t\r\n{\xef").find(text[0]) != std::string_view::npos;
  if (text != "glTF" && !may_be_json && file.size() > uint64_t{1} << 20)
    throw InputError({path.name, 1, 1}, "the file begins neither as JSON nor as a .glb file, so it is not glTF");
  return read_bytes(path);
}

}  // namespace

}  // namespace gltf

Scene read_gltf(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return parse_gltf(gltf::read_main_file(path), path, gltf::folder_of(path.name), options, diagnostics);
}

namespace gltf {

namespace {

/// Returns whether the animation moves nothing that is drawn, or that deforms what is drawn.
bool moves_only_camera(const Document& document, const Json& animation, const Nodes& nodes) {
  std::vector<bool> is_moved(nodes.size());
  const Json* channels = document.list(animation, "channels");
  for (const Json& channel : channels == nullptr ? std::vector<Json>{} : channels->items) {
    const Json* target = document.object(channel, "target");
    const auto node = target == nullptr ? std::nullopt : document.index(*target, "node", "nodes");
    if (!node) return false;
    is_moved[*node] = true;
  }
  // Parents come before their children.
  for (const uint32_t node : nodes.of_scene()) {
    const Json& description = document.item("nodes", node);
    if (const Json* children = document.list(description, "children"); is_moved[node] && children != nullptr)
      for (const Json& child : children->items) is_moved[document.as_index(child, "nodes")] = true;
    const bool is_seen =
        description.find("mesh") != nullptr || document.extension(description, "KHR_lights_punctual") != nullptr;
    if (is_moved[node] && is_seen) return false;
  }
  for (const Json& skin : document.array("skins"))
    if (const Json* joints = document.list(skin, "joints"))
      for (const Json& joint : joints->items)
        if (is_moved[document.as_index(joint, "nodes")]) return false;
  return std::find(is_moved.begin(), is_moved.end(), true) != is_moved.end();
}

}  // namespace

}  // namespace gltf

std::vector<Camera> read_gltf_camera_path(const InputPath& path, const ReadOptions& options,
                                          const std::vector<double>& times) {
  Diagnostics ignored;  // whoever reads the scene warns
  const std::vector<uint8_t> bytes = gltf::read_main_file(path);
  const gltf::Document document(bytes, path, gltf::folder_of(path.name), ignored, options.search);
  gltf::validate(document);
  const gltf::Json* animation = gltf::chosen_animation(document, options);
  gltf::Buffers buffers(document);
  gltf::Accessors accessors(document, buffers);
  const gltf::Nodes at_rest(document, accessors);
  if (animation == nullptr || !gltf::moves_only_camera(document, *animation, at_rest)) return {};
  std::vector<Camera> cameras;
  for (const double time : times) {
    gltf::Nodes nodes = at_rest;
    nodes.animate(*animation, time);
    nodes.place();
    Scene scene;
    if (!gltf::set_camera(document, nodes, options.camera, scene)) return {};
    cameras.push_back(scene.camera);
  }
  return cameras;
}

SceneListing list_gltf(const InputPath& path, Diagnostics& diagnostics, const FileSearch& search) {
  const std::vector<uint8_t> bytes = gltf::read_main_file(path);
  const gltf::Document document(bytes, path, gltf::folder_of(path.name), diagnostics, search);
  gltf::validate(document);
  gltf::Buffers buffers(document);
  gltf::Accessors accessors(document, buffers);
  gltf::Nodes nodes(document, accessors);
  nodes.place();
  SceneListing listing;
  for (const gltf::CameraNode& camera : gltf::camera_nodes(document, nodes)) listing.cameras.push_back(camera.name);
  listing.variants = gltf::variant_names(document);
  listing.animations = gltf::animation_names(document);
  Scene scene;
  gltf::add_lights(document, nodes, scene, &listing.lights);
  return listing;
}

}  // namespace alhazen::impl
