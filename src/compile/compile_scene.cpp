#include "compile/compile_scene.h"

#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compile/built_parts.h"
#include "compile/camera.h"
#include "compile/emission.h"
#include "compile/images.h"
#include "compile/instances.h"
#include "compile/lights.h"
#include "compile/lost_light.h"
#include "compile/materials.h"
#include "compile/open_backs.h"
#include "compile/render_space.h"
#include "compile/shapes.h"
#include "compile/trees.h"
#include "core/shapes/triangle.h"
#include "scene/mixes.h"
#include "scene/scene_names.h"
#include "util/memory_limit.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

template <class Real>
class SceneCompiler {
 public:
  /// `parts` may be null.
  SceneCompiler(Scene& scene, const CompileOptions& options, Diagnostics& diagnostics, BuiltParts<Real>* parts)
      : scene_(scene), options_(options), diagnostics_(diagnostics), parts_(parts) {}

  /// The message for a scene that does not fit into memory.
  std::string too_large() const {
    uint64_t texels = 0;
    for (const ImageTexels& image : scene_.images)
      texels += static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height);
    return "the scene is too large for the memory of this machine, or for a limit set on it (ulimit -v, a "
           "container's): it "
           "places " +
           std::to_string(placed_shapes_) + " shapes, meshes of " + std::to_string(shapes_.sizes().triangles) +
           " triangles among them, and has images of " + std::to_string(texels >> 20) +
           " million texels; give it fewer instances, less geometry or smaller images (--texture-budget)";
  }

  CompiledScene<Real> run() {
    check_film();
    diagnostics_.activity().begin("preparing the scene");
    CompiledScene<Real> flat;
    if (options_.in_render_space) flat.world_origin = move_to_render_space(scene_);
    compile_camera(scene_, width_, height_, out_, flat.view, diagnostics_);
    check_mixes(scene_);
    fit_images(scene_, options_.texture_budget, diagnostics_);
    materials_ = compile_materials(scene_, out_);
    for (const MaterialRecord<Real>& material : out_.materials) {
      if (material.features & MaterialFeatures::cutout) flat.view.has_cutouts = 1;
      if (material.opacity.count > 0) flat.view.lets_light_through = 1;
      if (material.features & MaterialFeatures::one_sided) has_one_sided_ = true;
      if (has_trait<&MaterialTraits::has_lobes>(material.kind)) flat.view.has_lobes = 1;
    }
    if (parts_) parts_->texture_floats = out_.texel_floats.size();
    described_lights_ = add_described_lights<Real>(scene_, nullptr, maps_, out_, flat.view, light_measures_);
    place_shapes();
    group_lights(flat);
    if (parts_) parts_->areas = measures_of_shapes();
    weigh_emission_textures(out_.view(), {}, light_measures_);
    if (parts_) parts_->measures = measures_of_shapes();
    shapes_.warn_of_dropped_triangles();
    for (const TriangleRecord& triangle : out_.triangles) {
      const uint32_t* v = triangle.vertex;
      if (is_narrow(out_.positions[v[0]], out_.positions[v[1]], out_.positions[v[2]])) {
        flat.view.has_narrow_triangles = 1;
        break;
      }
    }
    build_trees_and_query(flat);
    count_primitives(flat.statistics);
    flat.statistics.lights = out_.lights.size() + (is_zero(flat.view.background) ? 0 : 1);
    flat.statistics.instances = out_.instances.size();
    flat.origins = std::move(origins_);
    flat.origins.triangles = std::move(out_.triangle_origins);
    out_.move_into(flat);
    if (options_.for_cameras) flat.materials = std::make_shared<const CompiledMaterials>(materials_);
    flat.object_names = names_.objects();
    flat.material_names = names_.materials();
    open_seen_backs(static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), options_.threads, flat);
    if (parts_) keep_parts(flat);
    return flat;
  }

 private:
  std::vector<double> measures_of_shapes() const {
    return {light_measures_.begin() + static_cast<ptrdiff_t>(described_lights_.size()), light_measures_.end()};
  }

  void keep_parts(const CompiledScene<Real>& flat) {
    parts_->can_be_updated = is_zero(flat.world_origin);
    parts_->options = options_;
    parts_->maps = std::move(maps_);
    parts_->described_lights = std::move(described_lights_);
    parts_->scene = std::move(scene_);
    parts_->scene.meshes.clear();
    parts_->scene.images.clear();
    parts_->scene.environments.clear();
    parts_->scene.light_images.clear();
  }

  /// Builds the trees, then runs the queries that need rays. They use the binary tree.
  void build_trees_and_query(CompiledScene<Real>& flat) {
    if (has_one_sided_) split_coincident_sides(out_);
    const bool checks_lost_light = options_.path_segments > 0 && may_lose_light(out_.view());
    CompileOptions options = options_;
    if (has_one_sided_ || checks_lost_light) options.layouts.add(BvhLayout::bvh2);
    diagnostics_.activity().begin("building the BVH");
    build_trees(options, out_, flat.statistics, parts_ ? &parts_->world : nullptr);
    diagnostics_.activity().begin("preparing the lights");
    add_triangle_emitters(out_.view(), out_);
    assign_light_probabilities(light_measures_, scene_.light_sampling, out_.view(), out_, flat.view);
    const bool opens_later = has_one_sided_ && options_.for_cameras;
    if (has_one_sided_ && !opens_later &&
        open_seen_backs(whole_view(flat), static_cast<uint32_t>(width_), static_cast<uint32_t>(height_),
                        options_.threads, out_))
      flat.view.lets_light_through = 1;
    if (checks_lost_light)
      if (const auto lost = find_lost_light(whole_view(flat), options_.path_segments))
        warn_of_lost_light(*lost, scene_, shapes_.location_of(lost->surface),
                           parts_ ? parts_->lost_light : diagnostics_);
    if (opens_later) {
      flat.backs = prepare_openings(whole_view(flat), out_);
      flat.backs.lets_light_through = flat.view.lets_light_through;
      return;
    }
    if (options_.layouts.has(BvhLayout::bvh2) || out_.bvh2_nodes.empty()) return;
    flat.statistics.tree_bytes -= out_.bvh2_nodes.size() * sizeof(out_.bvh2_nodes[0]);
    flat.statistics.nodes = out_.bvh8_nodes.size();
    std::vector<Bvh2Node<Real>> nodes;
    nodes.swap(out_.bvh2_nodes);
    if (parts_) parts_->search_tree = std::move(nodes);
  }

  bool names_things() const { return options_.names_objects || options_.groups_lights; }

  /// Groups the lights by their names; those of shapes have the names of their objects.
  void group_lights(CompiledScene<Real>& flat) {
    if (!options_.groups_lights) return;
    NameTable names;
    const auto ids_of = [&](const std::vector<uint32_t>& objects) {
      std::vector<uint32_t> ids;
      for (const uint32_t object : objects) ids.push_back(names.id_of(names_.objects()[object - 1]));
      return ids;
    };
    std::vector<uint32_t> described;
    for (const std::string& name : light_names(scene_)) described.push_back(names.id_of(name));
    ids_of(shapes_.emissive_objects());
    const std::vector<uint32_t> of_shapes = ids_of(shapes_.light_objects());
    const auto is_background = [&](size_t i) {
      return scene_.lights[i].kind == LightKind::constant_infinite && !is_zero(scene_.lights[i].radiance);
    };
    std::vector<bool> shines(names.names().size());
    for (size_t i = 0; i < described.size(); ++i)
      if (is_background(i)) shines[described[i] - 1] = true;
    for (const size_t i : described_lights_) shines[described[i] - 1] = true;
    for (const uint32_t name : of_shapes) shines[name - 1] = true;
    const GroupedLights grouped = group_light_names(names.names(), shines, options_.light_groups);
    flat.light_groups = grouped.groups;
    const auto group = [&](uint32_t name) { return grouped.group_of[name - 1]; };
    bool has_background = false;
    for (size_t i = 0; i < described.size(); ++i) {
      if (!is_background(i)) continue;
      if (has_background && group(described[i]) != flat.view.background_group)
        throw InputError(
            scene_.lights[i].where,
            "the constant light '" + names.names()[described[i] - 1] +
                "' is in another light group than one before it: all of them are rendered as one light, so "
                "give them one group");
      flat.view.background_group = group(described[i]);
      has_background = true;
    }
    for (const size_t i : described_lights_) out_.light_groups.push_back(group(described[i]));
    for (const uint32_t name : of_shapes) out_.light_groups.push_back(group(name));
  }

  void count_primitives(SceneStatistics& statistics) const {
    const auto count = [&](PrimitiveKind kind, const char* name, uint64_t number) {
      if (kind == PrimitiveKind::triangle)
        statistics.triangles = number;
      else if (kind == PrimitiveKind::sphere || kind == PrimitiveKind::moving_sphere)
        statistics.spheres += number;
      else
        statistics.others.push_back({name, number});
    };
#define ALHAZEN_COUNT(X, kind, Record, records, Block, blocks) \
  count(PrimitiveKind::kind, #records, out_.records.size());
    ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
  }

  /// The settings of `flat` over the arrays as they are.
  SceneView<Real> whole_view(const CompiledScene<Real>& flat) const {
    SceneView<Real> view = out_.view();
    view.camera = flat.view.camera;
    view.has_cutouts = flat.view.has_cutouts;
    view.has_narrow_triangles = flat.view.has_narrow_triangles;
    view.lets_light_through = flat.view.lets_light_through;
    return view;
  }

  void check_film() {
    width_ = options_.width > 0 ? options_.width : scene_.film.width;
    height_ = options_.height > 0 ? options_.height : scene_.film.height;
    if (width_ < 1 || height_ < 1 || width_ > 100'000 || height_ > 100'000)
      throw InputError({scene_.name}, "an image of " + std::to_string(width_) + " x " + std::to_string(height_) +
                                          " pixels cannot be rendered: give sides between 1 and 100000");
  }

  void place_shapes() {
    if (names_things()) name_instances(scene_);
    const DescribedIndices described = group_moving_meshes(scene_);
    const std::vector<uint64_t> triangles = triangle_counts(scene_);
    const std::vector<bool> is_object = find_objects(scene_, triangles, options_.max_copied_triangles);
    check_placements(is_object);
    const std::vector<ShapePlacement> world = world_placements(scene_, is_object, described);
    const std::vector<std::vector<ShapePlacement>> objects = object_placements(scene_, is_object, described);
    shapes_.count(world);
    for (const std::vector<ShapePlacement>& object : objects) shapes_.count(object);
    check_meshes(world.size());
    shapes_.reserve();
    place(world);
    place_objects(objects, described);
    if (!parts_) return;
    parts_->placed.push_back(placed_sizes(out_, described_lights_.size()));
    parts_->described = described;
    parts_->triangle_counts = triangles;
    parts_->world_placements = world.size();
    parts_->is_object = is_object;
  }

  void place(const std::vector<ShapePlacement>& placements) {
    for (const ShapePlacement& p : placements) {
      if (parts_) parts_->placed.push_back(placed_sizes(out_, described_lights_.size()));
      shapes_.place(p);
    }
  }

  /// Places the shapes of objects, by group, and the instances that refer to them.
  void place_objects(const std::vector<std::vector<ShapePlacement>>& objects, const DescribedIndices& described) {
    std::vector<uint32_t> object_of(objects.size(), no_index);
    for (size_t g = 0; g < objects.size(); ++g) {
      ObjectRecord object{};
      object.first_triangle = static_cast<uint32_t>(out_.triangles.size());
      place(objects[g]);
      object.triangle_count = static_cast<uint32_t>(out_.triangles.size()) - object.first_triangle;
      if (object.triangle_count == 0) continue;
      object_of[g] = static_cast<uint32_t>(out_.objects.size());
      out_.objects.push_back(object);
    }
    for (size_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      if (object_of[instance.group] == no_index) continue;
      add_instance(scene_, instance, object_of[instance.group], out_);
      if (names_things()) out_.instances.back().object_id = names_.object_id(instance);
      if (options_.keeps_origins) origins_.instances.push_back(described.instances[i]);
    }
    if (parts_) parts_->object_of = std::move(object_of);
  }

  /// Checks that the shapes of the world and copies of groups that are no objects fit into memory.
  void check_placements(const std::vector<bool>& is_object) {
    placed_shapes_ = scene_.groups.at(0).shapes.size();
    for (const Instance& instance : scene_.instances)
      if (!is_object[instance.group]) placed_shapes_ += scene_.groups[instance.group].shapes.size();
    if (placed_shapes_ * sizeof(ShapePlacement) > physical_memory() / 10 * 9)
      throw TooLargeError({scene_.name}, too_large());
  }

  /// Checks that indices can hold the numbers of primitives and instances, and that the triangles fit into memory.
  void check_meshes(size_t world_shapes) const {
    const uint64_t triangles = shapes_.sizes().triangles, vertices = shapes_.sizes().vertices;
    if (triangles > max_primitives_of_a_kind || vertices > 0xfffffff0u || world_shapes > max_primitives_of_a_kind)
      throw InputError({scene_.name}, "the scene has " + std::to_string(triangles) + " triangles with " +
                                          std::to_string(vertices) + " vertices, more than 2^29 or 2^32: split it");
    if (scene_.instances.size() > Bvh8Child::max_index_count)
      throw InputError({scene_.name}, "the scene has " + std::to_string(scene_.instances.size()) +
                                          " instances, more than 2^26: split it");
    const uint64_t min_bytes =
        triangles * (sizeof(TriangleRecord) + sizeof(TriangleBlock<Real>) / 4) + vertices * sizeof(Vec3<Real>);
    if (min_bytes > physical_memory() / 10 * 9) throw InputError({scene_.name}, too_large());
  }

  Scene& scene_;
  const CompileOptions& options_;
  Diagnostics& diagnostics_;
  BuiltParts<Real>* parts_;
  int64_t width_ = 0, height_ = 0;
  SceneArrays<Real> out_;
  CompiledMaterials materials_;
  bool has_one_sided_ = false;
  std::vector<double> light_measures_;    ///< by light, see assign_light_probabilities
  std::vector<size_t> described_lights_;  ///< of the first lights: index into Scene::lights
  LightMaps<Real> maps_;
  SceneNames names_{scene_};
  SceneOrigins origins_;  ///< but for the triangles, which out_ has
  ShapeBuilder<Real> shapes_{scene_,
                             materials_,
                             out_,
                             light_measures_,
                             diagnostics_,
                             names_things() ? &names_ : nullptr,
                             options_.keeps_origins ? &origins_.surfaces : nullptr};
  uint64_t placed_shapes_ = 0;
};

template <class Real>
CompiledScene<Real> compile(Scene& scene, const CompileOptions& options, Diagnostics& diagnostics,
                            BuiltParts<Real>* parts) {
  limit_default_team();
  SceneCompiler<Real> compiler(scene, options, diagnostics, parts);
  try {
    return compiler.run();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw TooLargeError({scene.name}, compiler.too_large());
}

}  // namespace

template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics) {
  return compile<Real>(scene, options, diagnostics, nullptr);
}

template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics,
                                  BuiltParts<Real>& parts) {
  return compile<Real>(scene, options, diagnostics, &parts);
}

template CompiledScene<float> compile_scene(Scene&&, const CompileOptions&, Diagnostics&);
template CompiledScene<double> compile_scene(Scene&&, const CompileOptions&, Diagnostics&);
template CompiledScene<float> compile_scene(Scene&&, const CompileOptions&, Diagnostics&, BuiltParts<float>&);
template CompiledScene<double> compile_scene(Scene&&, const CompileOptions&, Diagnostics&, BuiltParts<double>&);

}  // namespace alhazen::impl
