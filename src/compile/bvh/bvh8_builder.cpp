#include "compile/bvh/bvh8_builder.h"

#include <omp.h>

#include "compile/bvh/collapse.h"
#include "compile/bvh/octant_slots.h"
#include "core/bvh/bvh8/intersector.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t max_leaf_primitives = 16;

/// Returns the number of lanes in a block.
template <class Real>
uint32_t lanes_of(PrimitiveKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, blocks)                   \
  case PrimitiveKind::kind:                                                     \
    static_assert(max_leaf_primitives <= Block::lanes * Bvh8Child::max_blocks); \
    return Block::lanes;
    ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
    case PrimitiveKind::instance:
      break;
  }
  return 1;
}

// Fills a lane of a block. Unused lanes hold values that are never hit.

template <class Real>
void set_lane(TriangleBlock<Real>& block, uint32_t lane, const SceneArrays<Real>& scene, const TriangleRecord& triangle,
              bool is_there) {
  for (int v = 0; v < 3; ++v)
    for (int axis = 0; axis < 3; ++axis)
      block.vertex[v][axis][lane] = scene.positions[triangle.vertex[is_there ? v : 0]][axis];
}

template <class Record, class Real>
void set_lane(RecordBlock<Record>& block, uint32_t lane, const SceneArrays<Real>&, const Record& record,
              bool is_there) {
  for (int k = 0; k < Record::numbers; ++k)
    block.number[k][lane] = is_there ? record.number(k) : std::numeric_limits<Real>::quiet_NaN();
}

/// The cost of a leaf: its number of blocks, or infinity if the primitives are of several kinds or too many. An
/// instance always gets its own leaf.
template <class Real>
struct BlockCost {
  std::span<const PrimitiveId> primitives;
  static constexpr float instance_cost = 16;

  float operator()(uint32_t first, uint32_t count) const {
    if (count > max_leaf_primitives) return std::numeric_limits<float>::infinity();
    if (count == 1 && primitives[first].kind() == PrimitiveKind::instance) return instance_cost;
    const PrimitiveKind kind = primitives[first].kind();
    for (uint32_t i = first; i < first + count; ++i)
      if (primitives[i].kind() != kind || kind == PrimitiveKind::instance)
        return std::numeric_limits<float>::infinity();
    const uint32_t lanes = lanes_of<Real>(kind);
    return static_cast<float>((count + lanes - 1) / lanes);
  }
};

/// Returns the box in float, padded by the rounding errors of the box test and the primitive tests.
template <class Real>
Bounds3<float> padded_box(const Bounds3<Real>& box) {
  const Vec3<Real> far = max(abs(box.low), abs(box.high));
  const float slack = static_cast<float>(max_component(far)) * box_slack;
  const Vec3<float> low = convert<float>(box.low), high = convert<float>(box.high);
  return {low - splat(slack), high + splat(slack)};
}

template <class Real>
class Bvh8Builder {
 public:
  Bvh8Builder(std::span<const Bvh2Node<Real>> tree, std::span<const Bounds3<Real>> boxes, uint32_t first_primitive,
              int threads, SceneArrays<Real>& scene)
      : scene_(scene),
        primitives_(std::span(scene.primitives).subspan(first_primitive, boxes.size())),
        threads_(threads),
        cost_{primitives_},
        collapse_(tree, boxes, cost_, threads) {}

  void run() {
    first_node_ = static_cast<uint32_t>(scene_.bvh8_nodes.size());
#define ALHAZEN_COUNT(X, kind, Record, records, Block, blocks) \
  block_count_[Bvh8Child::records] = static_cast<uint32_t>(scene_.blocks.size());
    ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
    plan();
    for (const size_t count : {first_node_ + plan_.size(), size_t{block_count_[Bvh8Child::triangles]}})
      if (count > Bvh8Child::max_index_count)
        throw InputError("the scene is too large: its tree would have more than 2^26 nodes or blocks of triangles");
    scene_.bvh8_nodes.resize(first_node_ + plan_.size());
#define ALHAZEN_RESIZE(X, kind, Record, records, Block, blocks) scene_.blocks.resize(block_count_[Bvh8Child::records]);
    ALHAZEN_PRIMITIVES(ALHAZEN_RESIZE, )
#undef ALHAZEN_RESIZE
#pragma omp parallel for schedule(dynamic, 1024) num_threads(threads_)
    for (size_t i = 0; i < plan_.size(); ++i) fill(i);
  }

 private:
  /// A node to be filled: the binary node that it replaces, and the indices of its first child and blocks.
  struct Planned {
    uint32_t binary;
    uint32_t first_node;
    uint32_t first_block[Bvh8Child::kinds];  ///< by Bvh8Child::Kind
  };

  bool is_instance(uint32_t leaf) const { return primitives_[collapse_.first(leaf)].kind() == PrimitiveKind::instance; }

  /// Returns the number of blocks of a leaf, or 0 for an instance.
  uint32_t blocks_of(uint32_t leaf, Bvh8Child::Kind& kind) const {
    if (is_instance(leaf)) return 0;
    const PrimitiveKind primitive = primitives_[collapse_.first(leaf)].kind();
    kind = Bvh8Child::kind(primitive);
    const uint32_t lanes = lanes_of<Real>(primitive);
    return (collapse_.count(leaf) + lanes - 1) / lanes;
  }

  /// Assigns indices to nodes and blocks. Siblings are adjacent, and descendants follow closely.
  void plan() {
    plan_.push_back({});
    std::vector<uint32_t> pending{0};
    while (!pending.empty()) {
      const uint32_t at = pending.back();
      pending.pop_back();
      Planned& node = plan_[at];
      node.first_node = first_node_ + static_cast<uint32_t>(plan_.size());
      std::copy(std::begin(block_count_), std::end(block_count_), node.first_block);
      uint32_t children[bvh8_width];
      const uint32_t count = collapse_.children_of(node.binary, children);
      for (uint32_t c = 0; c < count; ++c) {
        if (collapse_.makes_leaf(children[c])) {
          Bvh8Child::Kind kind{};
          const uint32_t blocks = blocks_of(children[c], kind);
          block_count_[kind] += blocks;
        } else {
          pending.push_back(static_cast<uint32_t>(plan_.size()));
          plan_.push_back({children[c], 0, {}});
        }
      }
    }
  }

  void fill(size_t at) {
    Planned next = plan_[at];
    Bvh8Node& node = scene_.bvh8_nodes[first_node_ + at];
    uint32_t children[bvh8_width];
    const uint32_t count = collapse_.children_of(next.binary, children);
    const Vec3<Real> middle = collapse_.box(next.binary).centre();
    Vec3<Real> offsets[bvh8_width];
    for (uint32_t c = 0; c < count; ++c) offsets[c] = collapse_.box(children[c]).centre() - middle;
    const std::array<uint32_t, 8> slots = octant_slots(offsets, count);
    for (uint32_t slot = 0; slot < bvh8_width; ++slot) leave_free(node, slot);
    for (uint32_t c = 0; c < count; ++c) {
      const Bounds3<float> box = padded_box(collapse_.box(children[c]));
      const uint32_t slot = slots[c];
      for (int axis = 0; axis < 3; ++axis) {
        node.bounds[2 * axis][slot] = box.low[axis];
        node.bounds[2 * axis + 1][slot] = box.high[axis];
      }
      if (collapse_.makes_leaf(children[c]) && is_instance(children[c])) {
        node.child[slot] = Bvh8Child::instance(primitives_[collapse_.first(children[c])].index());
      } else if (collapse_.makes_leaf(children[c])) {
        Bvh8Child::Kind kind{};
        const uint32_t blocks = blocks_of(children[c], kind);
        node.child[slot] = Bvh8Child::pack(kind, blocks, next.first_block[kind]);
        fill_blocks(children[c], next.first_block[kind], blocks);
        next.first_block[kind] += blocks;
      } else {
        node.child[slot] = Bvh8Child::pack(Bvh8Child::node, 0, next.first_node++);
      }
    }
  }

  static void leave_free(Bvh8Node& node, uint32_t slot) {
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[2 * axis][slot] = infinity<float>;
      node.bounds[2 * axis + 1][slot] = -infinity<float>;
    }
    node.child[slot] = Bvh8Child::nothing;
  }

  void fill_blocks(uint32_t leaf, uint32_t first_block, uint32_t blocks) {
    switch (primitives_[collapse_.first(leaf)].kind()) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, block_array) \
  case PrimitiveKind::kind:                                        \
    return fill_blocks(leaf, scene_.block_array.data() + first_block, blocks, scene_.records);
      ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
      case PrimitiveKind::instance:
        break;
    }
  }

  template <class Block, class Record>
  void fill_blocks(uint32_t leaf, Block* block, uint32_t blocks, const std::vector<Record>& records) const {
    const uint32_t first = collapse_.first(leaf), count = collapse_.count(leaf);
    for (uint32_t i = 0; i < blocks * Block::lanes; ++i) {
      const uint32_t lane = i % Block::lanes;
      // Unused lanes hold the index of the last primitive.
      const uint32_t index = primitives_[first + std::min(i, count - 1)].index();
      set_lane(block[i / Block::lanes], lane, scene_, records[index], i < count);
      block[i / Block::lanes].index[lane] = index;
    }
  }

  SceneArrays<Real>& scene_;
  std::span<const PrimitiveId> primitives_;
  uint32_t first_node_ = 0;
  int threads_;
  BlockCost<Real> cost_;
  BvhCollapse<Real, BlockCost<Real>> collapse_;
  std::vector<Planned> plan_;
  uint32_t block_count_[Bvh8Child::kinds]{};
};

}  // namespace

template <class Real>
void build_bvh8(std::span<const Bvh2Node<Real>> tree, std::span<const Bounds3<Real>> boxes, uint32_t first_primitive,
                int threads, SceneArrays<Real>& scene) {
  constexpr size_t min_shared_nodes = 8192;  // below, it is not worth waking other threads
  const int team = tree.size() < min_shared_nodes ? 1 : threads > 0 ? threads : omp_get_max_threads();
  if (!tree.empty()) Bvh8Builder<Real>(tree, boxes, first_primitive, team, scene).run();
}

template void build_bvh8(std::span<const Bvh2Node<float>>, std::span<const Bounds3<float>>, uint32_t, int,
                         SceneArrays<float>&);
template void build_bvh8(std::span<const Bvh2Node<double>>, std::span<const Bounds3<double>>, uint32_t, int,
                         SceneArrays<double>&);

}  // namespace alhazen::impl
