#include "compile/update_scene.h"

#include <algorithm>
#include <utility>

#include "compile/change_lights.h"
#include "compile/lost_light.h"
#include "compile/move_shapes.h"
#include "compile/open_backs.h"
#include "scene/scene_names.h"

namespace alhazen::impl {

namespace {

bool is_same(const MovingTransform& a, const MovingTransform& b) { return a.start == b.start && a.end == b.end; }

bool is_same(const Emission& a, const Emission& b) {
  return a.radiance == b.radiance && a.two_sided == b.two_sided && a.texture == b.texture;
}

/// Whether placing the second makes records that are as many, and refer to the same, as those of the first.
bool has_same_records(const ShapePlacement& a, const ShapePlacement& b) {
  const Shape &s = *a.shape, &t = *b.shape;
  return s.type == t.type && s.mesh == t.mesh && s.material == t.material && emits(s) == emits(t) &&
         a.reverse_orientation == b.reverse_orientation && a.origin.shape == b.origin.shape &&
         a.origin.instance == b.origin.instance && (a.instance == nullptr) == (b.instance == nullptr);
}

template <class Real>
class SceneUpdate {
 public:
  SceneUpdate(const SceneChanges& changes, const std::vector<Mesh>& meshes, Scene& outline, CompiledScene<Real>& scene,
              BuiltParts<Real>& parts)
      : changes_(changes), meshes_(meshes), outline_(outline), scene_(scene), parts_(parts) {}

  bool run() {
    if (!parts_.can_be_updated || !scene_.materials) return false;
    if (parts_.options.names_objects || parts_.options.groups_lights) name_instances(outline_);
    described_ = group_moving_meshes(outline_);
    if (!has_same_parts() || !compare_world() || !objects_are_same()) return false;
    close_backs(scene_);
    if (changes_.transforms && (!moved_.empty() || instances_move())) {
      take_meshes();
      if (!move_shapes(moved_, outline_, scene_, parts_, is_new_light_)) return false;
    }
    const bool emitters_moved = std::find(is_new_light_.begin(), is_new_light_.end(), 1) != is_new_light_.end();
    if (changes_.light_maps) parts_.maps = {};
    if (changes_.lights || changes_.light_maps || emitters_moved)
      if (!change_lights(emitters_, is_new_light_, outline_, scene_, parts_)) return false;
    ++scene_.generation;
    keep();
    return true;
  }

 private:
  bool has_same_parts() const {
    const Scene& before = parts_.scene;
    if (outline_.groups.size() != before.groups.size() || outline_.meshes.size() != parts_.triangle_counts.size() ||
        !std::equal(outline_.instances.begin(), outline_.instances.end(), before.instances.begin(),
                    before.instances.end(), [](const Instance& a, const Instance& b) {
                      return a.group == b.group && a.reverse_orientation == b.reverse_orientation;
                    }))
      return false;
    for (size_t g = 0; g < before.groups.size(); ++g)
      if (outline_.groups[g].shapes.size() != before.groups[g].shapes.size()) return false;
    for (size_t i = meshes_.size(); i < outline_.meshes.size(); ++i)
      if (outline_.meshes[i].triangle_count() != parts_.triangle_counts[i]) return false;
    return find_objects(outline_, parts_.triangle_counts, parts_.options.max_copied_triangles) == parts_.is_object;
  }

  /// Finds what has moved in the world, and what emits. Returns false where more than that has changed.
  bool compare_world() {
    const std::vector<ShapePlacement> before = world_placements(parts_.scene, parts_.is_object, parts_.described);
    world_ = world_placements(outline_, parts_.is_object, described_);
    if (world_.size() != before.size()) return false;
    is_new_light_.assign(parts_.areas.size(), 0);
    for (size_t i = 0; i < world_.size(); ++i) {
      const ShapePlacement &a = before[i], &b = world_[i];
      if (!has_same_records(a, b)) return false;
      if (!is_same(a.world_from_object, b.world_from_object)) {
        // What is warned of would change.
        if (a.world_from_object.is_moving() && a.shape->type != ShapeType::sphere) return false;
        moved_.push_back({i, b});
      }
      if (!emits(*b.shape)) continue;
      emitters_.push_back({i, b});
      if (!is_same(*a.shape->emission, *b.shape->emission))
        std::fill(is_new_light_.begin() + parts_.placed[i].lights, is_new_light_.begin() + parts_.placed[i + 1].lights,
                  uint8_t{1});
    }
    // Which sides coincide, and so which surfaces there are, depends on where they are.
    return moved_.empty() || !has_one_sided();
  }

  bool has_one_sided() const {
    const SceneView<Real>& view = scene_.view;
    return std::any_of(view.materials, view.materials + view.materials_count, [](const MaterialRecord<Real>& material) {
      return (material.features & MaterialFeatures::one_sided) != 0;
    });
  }

  bool objects_are_same() const {
    const auto before = object_placements(parts_.scene, parts_.is_object, parts_.described);
    const auto now = object_placements(outline_, parts_.is_object, described_);
    for (size_t g = 0; g < now.size(); ++g)
      if (!std::equal(now[g].begin(), now[g].end(), before[g].begin(), before[g].end(),
                      [](const ShapePlacement& a, const ShapePlacement& b) {
                        return has_same_records(a, b) && is_same(a.world_from_object, b.world_from_object);
                      }))
        return false;
    return true;
  }

  bool instances_move() const {
    return !std::equal(outline_.instances.begin(), outline_.instances.end(), parts_.scene.instances.begin(),
                       parts_.scene.instances.end(), [](const Instance& a, const Instance& b) {
                         return is_same(a.world_from_group, b.world_from_group);
                       });
  }

  /// Those of what has moved.
  void take_meshes() {
    for (const MovedShape& moved : moved_) {
      const Shape& shape = *moved.placement.shape;
      if (shape.type != ShapeType::mesh) continue;
      if (shape.mesh < meshes_.size() && outline_.meshes[shape.mesh].indices.empty())
        outline_.meshes[shape.mesh] = meshes_[shape.mesh];
    }
  }

  void keep() {
    parts_.described = std::move(described_);
    parts_.scene = std::move(outline_);
    parts_.scene.meshes.clear();
    parts_.scene.environments.clear();
    parts_.scene.light_images.clear();
  }

  const SceneChanges& changes_;
  const std::vector<Mesh>& meshes_;
  Scene& outline_;
  CompiledScene<Real>& scene_;
  BuiltParts<Real>& parts_;
  DescribedIndices described_;
  std::vector<ShapePlacement> world_;
  std::vector<MovedShape> moved_, emitters_;
  std::vector<uint8_t> is_new_light_;  ///< by light of shapes
};

/// The location of the shape that has a surface.
template <class Real>
SourceLocation location_of(uint32_t surface, const BuiltParts<Real>& parts) {
  const auto next = std::upper_bound(parts.placed.begin(), parts.placed.end(), surface,
                                     [](uint32_t s, const PlacedSizes& sizes) { return s < sizes.surfaces; });
  // Copies that have other materials follow all others.
  if (next == parts.placed.end() || next == parts.placed.begin()) return {parts.scene.name};
  auto index = static_cast<size_t>(next - parts.placed.begin()) - 1;
  const std::vector<ShapePlacement> world = world_placements(parts.scene, parts.is_object, parts.described);
  if (index < world.size()) return world[index].shape->where;
  index -= world.size();
  for (const auto& object : object_placements(parts.scene, parts.is_object, parts.described)) {
    if (index < object.size()) return object[index].shape->where;
    index -= object.size();
  }
  return {parts.scene.name};
}

}  // namespace

template <class Real>
bool update_scene(const SceneChanges& changes, const std::vector<Mesh>& meshes, Scene&& outline,
                  CompiledScene<Real>& scene, BuiltParts<Real>& parts) {
  return SceneUpdate<Real>(changes, meshes, outline, scene, parts).run();
}

template <class Real>
bool find_lost_light_again(uint32_t path_segments, CompiledScene<Real>& scene, BuiltParts<Real>& parts) {
  parts.options.path_segments = path_segments;
  parts.lost_light = Diagnostics();
  if (path_segments == 0 || !may_lose_light(scene.view)) return true;
  close_backs(scene);
  SceneView<Real> view = scene.view;
  if (view.bvh2_nodes_count == 0) {
    if (parts.search_tree.empty()) return false;
    view.bvh2_nodes = parts.search_tree.data();
    view.bvh2_nodes_count = static_cast<uint32_t>(parts.search_tree.size());
  }
  if (const auto lost = find_lost_light(view, path_segments))
    warn_of_lost_light(*lost, parts.scene, location_of(lost->surface, parts), parts.lost_light);
  return true;
}

template bool update_scene(const SceneChanges&, const std::vector<Mesh>&, Scene&&, CompiledScene<float>&,
                           BuiltParts<float>&);
template bool update_scene(const SceneChanges&, const std::vector<Mesh>&, Scene&&, CompiledScene<double>&,
                           BuiltParts<double>&);
template bool find_lost_light_again(uint32_t, CompiledScene<float>&, BuiltParts<float>&);
template bool find_lost_light_again(uint32_t, CompiledScene<double>&, BuiltParts<double>&);

}  // namespace alhazen::impl
