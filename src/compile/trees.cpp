#include "compile/trees.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>

#include "compile/bvh/bvh2_builder.h"
#include "compile/bvh/bvh8_builder.h"
#include "compile/bvh/cwbvh_builder.h"
#include "compile/bvh/reinsertion.h"
#include "core/bvh/cwbvh/primitive.h"
#include "core/shapes/instance.h"

namespace alhazen::impl {

namespace {

template <class Real>
class TreeBuilder {
 public:
  TreeBuilder(const CompileOptions& options, WorldTree<Real>& world, SceneArrays<Real>& out)
      : options_(options), world_(world), out_(out) {}

  void run() {
    find_object_boxes();
    build_world();
    for (ObjectRecord& object : out_.objects) {
      object.first_primitive = static_cast<uint32_t>(out_.primitives.size());
      object.bvh2_root = static_cast<uint32_t>(out_.bvh2_nodes.size());
      object.cwbvh_root = static_cast<uint32_t>(out_.cwbvh_nodes.size());
      object.bvh8_root = static_cast<uint32_t>(out_.bvh8_nodes.size());
      build(object.first_triangle, {object.triangle_count}, false);
    }
  }

  void build_world() {
    const uint32_t in_world =
        out_.objects.empty() ? static_cast<uint32_t>(out_.triangles.size()) : out_.objects.front().first_triangle;
    PrimitiveCounts counts{};
#define ALHAZEN_COUNT(X, kind, Record, records, Block, blocks) \
  counts[static_cast<uint32_t>(PrimitiveKind::kind)] = static_cast<uint32_t>(out_.records.size());
    ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
    counts[0] = in_world;
    build(0, counts, true);
    TreeSizes& sizes = world_.sizes;
    sizes.primitives = out_.primitives.size();
    sizes.bvh2_nodes = out_.bvh2_nodes.size();
    sizes.cwbvh_nodes = out_.cwbvh_nodes.size();
    sizes.cwbvh_primitives = out_.cwbvh_primitives.size();
    sizes.bvh8_nodes = out_.bvh8_nodes.size();
#define ALHAZEN_COUNT(X, kind, Record, records, Block, block_array) \
  sizes.blocks[Bvh8Child::records] = out_.block_array.size();
    ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
  }

 private:
  /// How many primitives of each kind a tree is over, by PrimitiveKind.
  using PrimitiveCounts = std::array<uint32_t, primitive_kinds>;

  /// Boxes of triangles from `first` on and of all other primitives of the counted kinds, kind by kind.
  std::vector<Bounds3<Real>> primitive_boxes(uint32_t first, const PrimitiveCounts& counts) const {
    const SceneView<Real> view = out_.view();
    std::vector<Bounds3<Real>> boxes;
    boxes.reserve(std::accumulate(counts.begin(), counts.end(), out_.instances.size()));
    for (uint32_t kind = 0; kind < primitive_kinds; ++kind)
      for (uint32_t i = 0; i < counts[kind]; ++i) {
        const PrimitiveId id(static_cast<PrimitiveKind>(kind), kind == 0 ? first + i : i);
        boxes.push_back(visit_primitive(view, id, [&](const auto& record) { return bounds_of(view, record); }));
      }
    return boxes;
  }

  void find_object_boxes() {
    world_.object_boxes.resize(out_.objects.size());
    const SceneView<Real> objects = out_.view();
#pragma omp parallel for schedule(dynamic)
    for (size_t o = 0; o < world_.object_boxes.size(); ++o) {
      const ObjectRecord& object = out_.objects[o];
      for (uint32_t i = object.first_triangle; i < object.first_triangle + object.triangle_count; ++i)
        world_.object_boxes[o].extend(bounds_of(objects, out_.triangles[i]));
    }
  }

  /// Boxes about the corners of the objects' own, wider by what rounding of the transform there and back can lose.
  void add_instance_boxes(std::vector<Bounds3<Real>>& boxes) const {
    SceneView<Real> view;
    view.instances = out_.instances.data();
    view.instance_motions = out_.instance_motions.data();
    for (uint32_t i = 0; i < out_.instances.size(); ++i) {
      const Bounds3<Real>& object = world_.object_boxes[out_.instances[i].object];
      boxes.push_back(instance_box(instance_at(view, i, Real(0)), object));
      if (out_.instances[i].motion != no_motion)
        boxes.back().extend(instance_box(instance_at(view, i, Real(1)), object));
    }
  }

  static Bounds3<Real> instance_box(const InstanceRecord<Real>& instance, const Bounds3<Real>& object) {
    Bounds3<Real> box;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3<Real> p{corner & 1 ? object.high.x : object.low.x, corner & 2 ? object.high.y : object.low.y,
                         corner & 4 ? object.high.z : object.low.z};
      const Vec3<Real> there = transform_point(instance.world_from_object, p);
      const Vec3<Real> slack = world_position_error(instance, p, Vec3<Real>{}, there);
      box.extend(there - slack);
      box.extend(there + slack);
    }
    return box;
  }

  /// Trees over triangles from `first` on, the other kinds that are counted, and in the world over instances.
  void build(uint32_t first, const PrimitiveCounts& counts, bool is_world) {
    const BvhLayouts& layouts = options_.layouts;
    const bool has_instances = is_world && !out_.instances.empty();
    std::vector<Bounds3<Real>> boxes = primitive_boxes(first, counts);
    if (has_instances) add_instance_boxes(boxes);
    if (is_world)
      for (const Bounds3<Real>& box : boxes) out_.bounds.extend(box);
    Bvh2<Real> tree;
    if (!layouts.empty()) {
      Bvh2Options options;
      options.threads = options_.threads;
      if (has_instances) options.max_leaf = 1;  // an instance is to be alone in its leaf
      tree = build_bvh2<Real>(boxes, options);
      reinsert_subtrees(tree, options_.threads);
    } else {
      tree.order.resize(boxes.size());
      std::iota(tree.order.begin(), tree.order.end(), 0u);
    }
    if (is_world)
      std::copy_if(tree.order.begin(), tree.order.end(), std::back_inserter(world_.triangle_order),
                   [&](uint32_t i) { return i < counts[0]; });
    const uint32_t first_primitive = static_cast<uint32_t>(out_.primitives.size());
    order_primitives(tree.order, first, counts);
    if (layouts.has(BvhLayout::cwbvh) || layouts.has(BvhLayout::bvh8)) {
      std::vector<Bounds3<Real>> ordered(tree.order.size());
#pragma omp parallel for if (ordered.size() > 65'536)
      for (size_t i = 0; i < ordered.size(); ++i) ordered[i] = boxes[tree.order[i]];
      std::vector<Bounds3<Real>>().swap(boxes);
      if constexpr (sizeof(Real) == sizeof(float))
        if (layouts.has(BvhLayout::cwbvh)) add_cwbvh(tree.nodes, ordered, first_primitive);
      if (layouts.has(BvhLayout::bvh8)) build_bvh8<Real>(tree.nodes, ordered, first_primitive, options_.threads, out_);
    }
    if (layouts.has(BvhLayout::bvh2)) add_nodes(std::move(tree.nodes), first_primitive);
  }

  void add_nodes(std::vector<Bvh2Node<Real>> nodes, uint32_t first_primitive) {
    if (out_.bvh2_nodes.empty()) {
      out_.bvh2_nodes = std::move(nodes);
      return;
    }
    const uint32_t base = static_cast<uint32_t>(out_.bvh2_nodes.size());
    for (Bvh2Node<Real>& node : nodes) node.first += node.count > 0 ? first_primitive : base;
    out_.bvh2_nodes.insert(out_.bvh2_nodes.end(), nodes.begin(), nodes.end());
  }

  void add_cwbvh(const std::vector<Bvh2Node<float>>& nodes, const std::vector<Bounds3<float>>& boxes,
                 uint32_t first_primitive) {
    Cwbvh cwbvh = build_cwbvh(nodes, boxes);
    const SceneView<Real> view = out_.view();
    const uint32_t base = static_cast<uint32_t>(out_.cwbvh_nodes.size());
    const uint32_t primitive_base = static_cast<uint32_t>(out_.cwbvh_primitives.size());
    for (CwbvhNode& node : cwbvh.nodes) {
      node.first_child += base;
      node.first_primitive += primitive_base;
    }
    out_.cwbvh_nodes.insert(out_.cwbvh_nodes.end(), cwbvh.nodes.begin(), cwbvh.nodes.end());
    out_.cwbvh_primitives.reserve(primitive_base + cwbvh.primitives.size());
    for (const uint32_t place : cwbvh.primitives)
      out_.cwbvh_primitives.push_back(cwbvh_primitive(view, out_.primitives[first_primitive + place]));
  }

  /// Names the primitives in the order of the leaves, and brings triangles into that order, so that those of a leaf are
  /// neighbours in memory.
  void order_primitives(const std::vector<uint32_t>& order, uint32_t first, const PrimitiveCounts& counts) {
    std::vector<TriangleRecord> ordered;
    ordered.reserve(counts[0]);
    std::vector<TriangleOrigin> origins;
    const bool has_origins = !out_.triangle_origins.empty();
    for (uint32_t i : order) {
      uint32_t kind = 0;
      for (; kind < primitive_kinds && i >= counts[kind]; ++kind) i -= counts[kind];
      out_.primitives.emplace_back(static_cast<PrimitiveKind>(kind), i);
      if (kind > 0) continue;
      const uint32_t place = first + static_cast<uint32_t>(ordered.size());
      out_.primitives.back() = PrimitiveId(PrimitiveKind::triangle, place);
      ordered.push_back(out_.triangles[first + i]);
      if (has_origins) origins.push_back(out_.triangle_origins[first + i]);
      const uint32_t light = out_.surfaces[ordered.back().surface].light;
      if (light != no_light) out_.lights[light].primitive = place;
    }
    std::copy(ordered.begin(), ordered.end(), out_.triangles.begin() + first);
    std::copy(origins.begin(), origins.end(), out_.triangle_origins.begin() + first);
  }

  const CompileOptions& options_;
  WorldTree<Real>& world_;
  SceneArrays<Real>& out_;
};

}  // namespace

template <class Real>
void build_trees(const CompileOptions& options, SceneArrays<Real>& out, SceneStatistics& statistics,
                 WorldTree<Real>* world) {
  const auto start = std::chrono::steady_clock::now();
  size_t primitives = out.instances.size();
#define ALHAZEN_ADD(X, kind, Record, records, Block, blocks) primitives += out.records.size();
  ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
  out.primitives.reserve(primitives);
  WorldTree<Real> own;
  TreeBuilder<Real>(options, world ? *world : own, out).run();
  count_trees(options, out.view(), statistics);
  statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Real>
void build_world_tree(const CompileOptions& options, SceneArrays<Real>& out, WorldTree<Real>& world) {
  world.triangle_order.clear();
  TreeBuilder<Real>(options, world, out).build_world();
}

template <class Real>
void count_trees(const CompileOptions& options, const SceneView<Real>& view, SceneStatistics& statistics) {
  statistics.nodes = options.layouts.has(BvhLayout::bvh2) ? view.bvh2_nodes_count : view.bvh8_nodes_count;
  const auto bytes = [](const auto* array, uint64_t count) { return count * sizeof(*array); };
  statistics.tree_bytes = bytes(view.bvh2_nodes, view.bvh2_nodes_count) +
                          bytes(view.cwbvh_nodes, view.cwbvh_nodes_count) +
                          bytes(view.cwbvh_primitives, view.cwbvh_primitives_count) +
                          bytes(view.bvh8_nodes, view.bvh8_nodes_count) + bytes(view.instances, view.instances_count);
#define ALHAZEN_ADD(X, kind, Record, records, Block, block_array) \
  statistics.tree_bytes += bytes(view.block_array, view.block_array##_count);
  ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
}

template void build_trees(const CompileOptions&, SceneArrays<float>&, SceneStatistics&, WorldTree<float>*);
template void build_trees(const CompileOptions&, SceneArrays<double>&, SceneStatistics&, WorldTree<double>*);
template void build_world_tree(const CompileOptions&, SceneArrays<float>&, WorldTree<float>&);
template void build_world_tree(const CompileOptions&, SceneArrays<double>&, WorldTree<double>&);
template void count_trees(const CompileOptions&, const SceneView<float>&, SceneStatistics&);
template void count_trees(const CompileOptions&, const SceneView<double>&, SceneStatistics&);

}  // namespace alhazen::impl
