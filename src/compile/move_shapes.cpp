#include "compile/move_shapes.h"

#include <algorithm>
#include <chrono>

#include "compile/shapes.h"
#include "core/shapes/triangle.h"

namespace alhazen::impl {

namespace {

/// The arena is the scene's own.
template <class Type>
Type* writable(const Type* array) {
  return const_cast<Type*>(array);
}

template <class Type>
std::vector<Type> copied(const Type* array, size_t count) {
  return {array, array + count};
}

/// Places what has moved once more, and writes the records over those of before.
template <class Real>
class MovedRecords {
 public:
  MovedRecords(Scene& outline, CompiledScene<Real>& scene, BuiltParts<Real>& parts)
      : view_(scene.view), parts_(parts), builder_(outline, *scene.materials, fresh_, areas_, notes_) {}

  /// Returns false where they are not as many as before.
  bool place(const std::vector<MovedShape>& moved) {
    std::vector<ShapePlacement> placements;
    for (const MovedShape& m : moved) placements.push_back(m.placement);
    builder_.count(placements);
    builder_.reserve();
    starts_.push_back({});
    for (const MovedShape& m : moved) {
      builder_.place(m.placement);
      starts_.push_back(placed_sizes(fresh_, 0));
      if (difference(starts_.back(), starts_[starts_.size() - 2]) !=
          difference(parts_.placed[m.index + 1], parts_.placed[m.index]))
        return false;
    }
    return notes_.warnings().empty();
  }

  /// `triangles` are those of the world in the order of placement.
  void write(const std::vector<MovedShape>& moved, std::vector<TriangleRecord>& triangles,
             std::vector<uint8_t>& is_new_light) {
    for (size_t k = 0; k < moved.size(); ++k) {
      const PlacedSizes &from = starts_[k], &to = parts_.placed[moved[k].index];
      const PlacedSizes count = difference(starts_[k + 1], from);
      copy(fresh_.positions, from.positions, view_.positions, to.positions, count.positions);
      copy(fresh_.normals, from.normals, view_.normals, to.normals, count.normals);
      copy(fresh_.vertex_tangents, from.vertex_tangents, view_.vertex_tangents, to.vertex_tangents,
           count.vertex_tangents);
      copy(fresh_.sphere_frames, from.sphere_frames, view_.sphere_frames, to.sphere_frames, count.sphere_frames);
      for (uint32_t i = 0; i < count.surfaces; ++i)
        writable(view_.surfaces)[to.surfaces + i].flip_normal = fresh_.surfaces[from.surfaces + i].flip_normal;
      for (uint32_t i = 0; i < count.triangles; ++i) {
        TriangleRecord triangle = fresh_.triangles[from.triangles + i];
        for (uint32_t& vertex : triangle.vertex) vertex += to.positions - from.positions;
        triangle.surface += to.surfaces - from.surfaces;
        triangles[to.triangles + i] = triangle;
      }
#define ALHAZEN_WRITE(X, kind, Record, records, Block, blocks) \
  write_records(fresh_.records, from.records, view_.records, to.records, count.records, from, to);
      ALHAZEN_PRIMITIVES(ALHAZEN_WRITE, )
#undef ALHAZEN_WRITE
      for (uint32_t i = 0; i < count.lights; ++i) {
        parts_.areas[to.lights + i] = areas_[from.lights + i];
        is_new_light[to.lights + i] = 1;
      }
    }
  }

 private:
  template <class Type>
  static void copy(const std::vector<Type>& fresh, size_t from, const Type* array, size_t to, size_t count) {
    std::copy_n(fresh.begin() + static_cast<ptrdiff_t>(from), count, writable(array) + to);
  }

  static void write_records(const std::vector<TriangleRecord>&, size_t, const TriangleRecord*, size_t, size_t,
                            const PlacedSizes&, const PlacedSizes&) {}

  template <class Record>
  static void write_records(const std::vector<Record>& fresh, size_t from, const Record* array, size_t to, size_t count,
                            const PlacedSizes& before, const PlacedSizes& after) {
    for (size_t i = 0; i < count; ++i) {
      Record record = fresh[from + i];
      record.surface += after.surfaces - before.surfaces;
      if constexpr (requires { record.frame; })
        if (record.frame != no_sphere_frame) record.frame += after.sphere_frames - before.sphere_frames;
      writable(array)[to + i] = record;
    }
  }

  const SceneView<Real>& view_;
  BuiltParts<Real>& parts_;
  SceneArrays<Real> fresh_;
  std::vector<double> areas_;
  Diagnostics notes_;
  ShapeBuilder<Real> builder_;
  std::vector<PlacedSizes> starts_;
};

/// The world's triangles in the order in which they were placed.
template <class Real>
std::vector<TriangleRecord> placed_triangles(const CompiledScene<Real>& scene, const WorldTree<Real>& world) {
  std::vector<TriangleRecord> triangles(world.triangle_order.size());
  for (size_t i = 0; i < triangles.size(); ++i) triangles[world.triangle_order[i]] = scene.view.triangles[i];
  return triangles;
}

/// Shifts the indices in the nodes of objects, which follow those of the world.
template <class Real>
void shift_objects(const TreeSizes& before, const TreeSizes& after, CompiledScene<Real>& scene,
                   std::vector<Bvh2Node<Real>>& search_tree) {
  const SceneView<Real>& view = scene.view;
  const auto shift = [](size_t from, size_t to) { return static_cast<uint32_t>(to) - static_cast<uint32_t>(from); };
  const uint32_t bvh2 = shift(before.bvh2_nodes, after.bvh2_nodes),
                 cwbvh = shift(before.cwbvh_nodes, after.cwbvh_nodes),
                 cwbvh_primitives = shift(before.cwbvh_primitives, after.cwbvh_primitives),
                 bvh8 = shift(before.bvh8_nodes, after.bvh8_nodes);
  for (uint32_t i = 0; i < view.objects_count; ++i) {
    ObjectRecord& object = writable(view.objects)[i];
    object.bvh2_root += bvh2, object.cwbvh_root += cwbvh, object.bvh8_root += bvh8;
  }
  Bvh2Node<Real>* const binary = search_tree.empty() ? writable(view.bvh2_nodes) : search_tree.data();
  const size_t binary_count = search_tree.empty() ? view.bvh2_nodes_count : search_tree.size();
  for (size_t i = after.bvh2_nodes; bvh2 != 0 && i < binary_count; ++i)
    if (binary[i].count == 0) binary[i].first += bvh2;
  for (size_t i = after.cwbvh_nodes; i < view.cwbvh_nodes_count; ++i) {
    CwbvhNode& node = writable(view.cwbvh_nodes)[i];
    node.first_child += cwbvh, node.first_primitive += cwbvh_primitives;
  }
  if (before.bvh8_nodes == after.bvh8_nodes && before.blocks == after.blocks) return;
#pragma omp parallel for if (view.bvh8_nodes_count > 65'536)
  for (size_t i = after.bvh8_nodes; i < view.bvh8_nodes_count; ++i)
    for (uint32_t& child : writable(view.bvh8_nodes)[i].child) {
      const Bvh8Child::Kind kind = Bvh8Child::kind(child);
      if (kind == Bvh8Child::node)
        child += bvh8;
      else if (Bvh8Child::blocks(child) > 0)
        child += shift(before.blocks[kind], after.blocks[kind]);
    }
}

/// Whether the indices of nodes and blocks still fit into Bvh8Child.
template <class Real>
bool fits_indices(const TreeSizes& before, const TreeSizes& after, const SceneView<Real>& view) {
  bool fits = view.bvh8_nodes_count - before.bvh8_nodes + after.bvh8_nodes <= Bvh8Child::max_index_count;
#define ALHAZEN_FITS(X, kind, Record, records, Block, block_array)                                                  \
  fits = fits && view.block_array##_count - before.blocks[Bvh8Child::records] + after.blocks[Bvh8Child::records] <= \
                     Bvh8Child::max_index_count;
  ALHAZEN_PRIMITIVES(ALHAZEN_FITS, )
#undef ALHAZEN_FITS
  return fits;
}

template <class Type>
ArrayFront front_of(const std::vector<Type>& fresh, size_t old_count) {
  return {true, fresh.data(), fresh.size(), old_count};
}

/// Puts the tree of the world in `out` in place of the one of before.
template <class Real>
bool replace_world_tree(const TreeSizes& before, SceneArrays<Real>& out, CompiledScene<Real>& scene,
                        BuiltParts<Real>& parts) {
  const SceneView<Real>& view = scene.view;
  const TreeSizes& after = parts.world.sizes;
  if (after.primitives != before.primitives || !fits_indices(before, after, view)) return false;
  ArrayFronts fronts;
  if (view.bvh2_nodes_count > 0) {
    fronts.bvh2_nodes = front_of(out.bvh2_nodes, before.bvh2_nodes);
  } else if (!parts.search_tree.empty()) {
    std::vector<Bvh2Node<Real>>& tree = parts.search_tree;
    out.bvh2_nodes.insert(out.bvh2_nodes.end(), tree.begin() + static_cast<ptrdiff_t>(before.bvh2_nodes), tree.end());
    tree = std::move(out.bvh2_nodes);
  }
  fronts.cwbvh_nodes = front_of(out.cwbvh_nodes, before.cwbvh_nodes);
  fronts.cwbvh_primitives = front_of(out.cwbvh_primitives, before.cwbvh_primitives);
  fronts.bvh8_nodes = front_of(out.bvh8_nodes, before.bvh8_nodes);
#define ALHAZEN_FRONT(X, kind, Record, records, Block, block_array) \
  fronts.block_array = front_of(out.block_array, before.blocks[Bvh8Child::records]);
  ALHAZEN_PRIMITIVES(ALHAZEN_FRONT, )
#undef ALHAZEN_FRONT
  fronts.primitives = front_of(out.primitives, before.primitives);
  fronts.triangles = front_of(out.triangles, out.triangles.size());
  fronts.lights = front_of(out.lights, view.lights_count);
  fronts.instances = front_of(out.instances, view.instances_count);
  fronts.instance_motions = front_of(out.instance_motions, view.instance_motions_count);
  replace_fronts(fronts, scene);
  shift_objects(before, after, scene, parts.search_tree);
  return true;
}

/// Copies what the tree of the world is built of. The triangles of objects follow those of the world, and so do their
/// vertices.
template <class Real>
void copy_world(const SceneView<Real>& view, size_t positions, SceneArrays<Real>& out) {
  out.positions = copied(view.positions, positions);
#define ALHAZEN_COPY(X, kind, Record, records, Block, blocks) \
  if (PrimitiveKind::kind != PrimitiveKind::triangle) out.records = copied(view.records, view.records##_count);
  ALHAZEN_PRIMITIVES(ALHAZEN_COPY, )
#undef ALHAZEN_COPY
  out.surfaces = copied(view.surfaces, view.surfaces_count);
  out.lights = copied(view.lights, view.lights_count);
}

/// The records of all instances, in the order of the description.
template <class Real>
void add_instances(const Scene& outline, const BuiltParts<Real>& parts, const SceneView<Real>& view,
                   SceneArrays<Real>& out) {
  for (const Instance& instance : outline.instances) {
    const uint32_t object = parts.object_of[instance.group];
    if (object == no_index) continue;
    add_instance(outline, instance, object, out);
    out.instances.back().object_id = view.instances[out.instances.size() - 1].object_id;
  }
}

template <class Real>
uint32_t has_narrow_triangles(const SceneView<Real>& view) {
  return std::any_of(view.triangles, view.triangles + view.triangles_count, [&](const TriangleRecord& triangle) {
    const uint32_t* v = triangle.vertex;
    return is_narrow(view.positions[v[0]], view.positions[v[1]], view.positions[v[2]]);
  });
}

}  // namespace

template <class Real>
bool move_shapes(const std::vector<MovedShape>& moved, Scene& outline, CompiledScene<Real>& scene,
                 BuiltParts<Real>& parts, std::vector<uint8_t>& is_new_light) {
  const auto start = std::chrono::steady_clock::now();
  SceneArrays<Real> out;
  add_instances(outline, parts, scene.view, out);
  out.triangles = placed_triangles(scene, parts.world);
  if (!moved.empty()) {
    MovedRecords<Real> records(outline, scene, parts);
    if (!records.place(moved)) return false;
    records.write(moved, out.triangles, is_new_light);
  }
  copy_world(scene.view, parts.placed[parts.world_placements].positions, out);
  CompileOptions options = parts.options;
  if (scene.view.bvh2_nodes_count > 0 || !parts.search_tree.empty()) options.layouts.add(BvhLayout::bvh2);
  const TreeSizes before = parts.world.sizes;
  build_world_tree(options, out, parts.world);
  scene.view.bounds = out.bounds;
  for (size_t i = 0; i < scene.backs.closed.size(); ++i) scene.backs.closed[i] = out.triangles[i].surface;
  if (!replace_world_tree(before, out, scene, parts)) return false;
  if (!moved.empty()) scene.view.has_narrow_triangles = has_narrow_triangles(scene.view);
  if (scene.view.bvh2_nodes_count == 0) options.layouts = parts.options.layouts;
  count_trees(options, scene.view, scene.statistics);
  scene.statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return true;
}

template bool move_shapes(const std::vector<MovedShape>&, Scene&, CompiledScene<float>&, BuiltParts<float>&,
                          std::vector<uint8_t>&);
template bool move_shapes(const std::vector<MovedShape>&, Scene&, CompiledScene<double>&, BuiltParts<double>&,
                          std::vector<uint8_t>&);

}  // namespace alhazen::impl
