#include "compile/bvh/reinsertion.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "util/large_array.h"

namespace alhazen::impl {

namespace {

/// Each round considers one in `nodes_per_candidate` nodes, those with the largest boxes.
constexpr size_t nodes_per_candidate = 20;
constexpr int rounds = 2;
/// Below this many nodes there is little to gain.
constexpr size_t min_nodes = 8;
/// Below this many nodes it is not worth waking other threads.
constexpr size_t min_shared_nodes = 8192;
/// A search stops after this many nodes, in case boxes overlap so much that the bounds prune little.
constexpr int max_visits = 4096;

template <class Real>
struct Move {
  uint32_t from = 0, to = 0;
  Real gain = 0;  ///< reduction of the sum of all half areas
};

template <class Real>
Bounds3<Real> box_of(const Bvh2Node<Real>& node) {
  return {node.corners[0], node.corners[1]};
}

template <class Real>
Real area_of(const Bvh2Node<Real>& node) {
  return box_of(node).half_area();
}

template <class Real>
Bounds3<Real> united(Bounds3<Real> a, const Bounds3<Real>& b) {
  a.extend(b);
  return a;
}

/// Siblings are adjacent, the first of a pair at an odd index.
uint32_t sibling_of(uint32_t node) { return node % 2 == 1 ? node + 1 : node - 1; }
uint32_t first_of_pair(uint32_t node) { return node % 2 == 1 ? node : node - 1; }

template <class Real>
class Reinsertion {
 public:
  explicit Reinsertion(std::vector<Bvh2Node<Real>>& nodes) : nodes_(nodes), parents_(nodes.size()) {
    for (uint32_t i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].count == 0) set_parent_of_children(i);
  }

  void run(int threads) {
    const std::vector<uint32_t> candidates = largest_nodes(threads);
    std::vector<Move<Real>> moves(candidates.size());
    for (int round = 0; round < rounds; ++round) {
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
      for (size_t i = 0; i < candidates.size(); ++i) moves[i] = best_move(candidates[i]);
      std::sort(moves.begin(), moves.end(), [](const Move<Real>& a, const Move<Real>& b) {
        return a.gain > b.gain || (a.gain == b.gain && a.from < b.from);
      });
      if (!make(moves)) return;
    }
  }

 private:
  std::vector<uint32_t> largest_nodes(int threads) const {
    struct Sized {
      Real area;
      uint32_t node;
    };
    LargeArray<Sized> all(nodes_.size() - 1);
#pragma omp parallel for num_threads(threads)
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = {area_of(nodes_[i + 1]), i + 1};
    const size_t count = std::max<size_t>(all.size() / nodes_per_candidate, std::min<size_t>(all.size(), 64));
    std::nth_element(
        all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count - 1), all.end(),
        [](const Sized& a, const Sized& b) { return a.area > b.area || (a.area == b.area && a.node < b.node); });
    std::vector<uint32_t> largest(count);
    for (size_t i = 0; i < count; ++i) largest[i] = all[i].node;
    return largest;
  }

  void set_parent_of_children(uint32_t node) { parents_[nodes_[node].first] = parents_[nodes_[node].first + 1] = node; }

  /// Finds the best new sibling of the subtree by branch and bound over the rest of the tree, from the subtree's
  /// sibling upwards.
  Move<Real> best_move(uint32_t from) const {
    struct Place {
      Real gain;  ///< not counting the area of a new parent there
      uint32_t node;
    };
    Move<Real> best{from, 0, 0};
    if (parents_[from] == 0) return best;  // its parent is the root, which stays
    const Bounds3<Real> box = box_of(nodes_[from]);
    const Real area = box.half_area();
    Place stack[max_visits + 1];  // each visit pops one entry and pushes at most two
    int waiting = 0;
    uint32_t pivot = parents_[from], side = sibling_of(from);
    Bounds3<Real> without = box_of(nodes_[side]);  // the pivot's box once the subtree is gone
    Real gain = area_of(nodes_[pivot]);
    int visits = 0;
    for (;;) {
      stack[waiting++] = {gain, side};
      for (; waiting > 0 && visits < max_visits; ++visits) {
        const Place place = stack[--waiting];
        if (place.gain - area <= best.gain) continue;
        const Bvh2Node<Real>& there = nodes_[place.node];
        const Real with_parent = place.gain - united(box_of(there), box).half_area();
        if (with_parent > best.gain) best = {from, place.node, with_parent};
        if (there.count > 0) continue;
        const Real below = with_parent + area_of(there);
        stack[waiting++] = {below, there.first};
        stack[waiting++] = {below, there.first + 1};
      }
      if (pivot != parents_[from]) {
        without.extend(box_of(nodes_[side]));
        gain += area_of(nodes_[pivot]) - without.half_area();
      }
      if (pivot == 0 || visits == max_visits) break;
      side = sibling_of(pivot);
      pivot = parents_[pivot];
    }
    // Reinsertion beside its sibling or its own parent would not change the tree.
    if (best.to == sibling_of(from) || best.to == parents_[from]) best.gain = 0;
    return best;
  }

  /// Makes the moves that do not conflict with a better one. Returns false if there was none.
  bool make(const std::vector<Move<Real>>& moves) {
    std::vector<bool> touched(nodes_.size());
    bool any = false;
    for (const Move<Real>& move : moves) {
      if (!(move.gain > 0)) break;
      const uint32_t nodes[] = {move.from, sibling_of(move.from), parents_[move.from], move.to, parents_[move.to]};
      if (std::any_of(std::begin(nodes), std::end(nodes), [&](uint32_t n) { return touched[n]; })) continue;
      for (const uint32_t n : nodes) touched[n] = true;
      reinsert(move.from, move.to);
      any = true;
    }
    return any;
  }

  /// Replaces the parent of `from` with its sibling, and uses the freed pair of nodes for `from` and the old `to`.
  void reinsert(uint32_t from, uint32_t to) {
    const uint32_t sibling = sibling_of(from), parent = parents_[from];
    const Bvh2Node<Real> destination = nodes_[to];
    nodes_[parent] = nodes_[sibling];
    if (nodes_[parent].count == 0) set_parent_of_children(parent);
    nodes_[sibling] = destination;
    if (destination.count == 0) set_parent_of_children(sibling);
    nodes_[to].first = first_of_pair(from);
    nodes_[to].count = 0;
    set_parent_of_children(to);
    refit_from(to);
    refit_from(parent);
  }

  void refit_from(uint32_t node) {
    for (;; node = parents_[node]) {
      Bvh2Node<Real>& n = nodes_[node];
      if (n.count == 0) {
        const Bounds3<Real> box = united(box_of(nodes_[n.first]), box_of(nodes_[n.first + 1]));
        n.corners[0] = box.low;
        n.corners[1] = box.high;
        n.axis = static_cast<uint16_t>(widest_gap(nodes_[n.first], nodes_[n.first + 1]));
      }
      if (node == 0) return;
    }
  }

  /// Returns the axis along which the centres are farthest apart.
  static int widest_gap(const Bvh2Node<Real>& a, const Bvh2Node<Real>& b) {
    return max_axis(abs(box_of(a).centre() - box_of(b).centre()));
  }

  std::vector<Bvh2Node<Real>>& nodes_;
  std::vector<uint32_t> parents_;
};

/// Restores the depth-first order of nodes and primitives, unless the tree is too deep.
template <class Real>
class Renumbering {
 public:
  Renumbering(const std::vector<Bvh2Node<Real>>& nodes, const std::vector<uint32_t>& order)
      : nodes_(nodes), order_(order) {
    out_.nodes.reserve(nodes.size());
    out_.order.reserve(order.size());
    out_.nodes.emplace_back();
  }

  bool run() { return place(0, 0, 0); }
  Bvh2<Real>& tree() { return out_; }

 private:
  bool place(uint32_t from, uint32_t to, int depth) {
    if (depth >= max_bvh2_depth) return false;
    Bvh2Node<Real> node = nodes_[from];
    if (node.count > 0) {
      node.first = static_cast<uint32_t>(out_.order.size());
      const auto first = order_.begin() + nodes_[from].first;
      out_.order.insert(out_.order.end(), first, first + node.count);
      out_.nodes[to] = node;
      return true;
    }
    const uint32_t children = node.first;
    node.first = static_cast<uint32_t>(out_.nodes.size());
    out_.nodes.resize(out_.nodes.size() + 2);
    out_.nodes[to] = node;
    return place(children, node.first, depth + 1) && place(children + 1, node.first + 1, depth + 1);
  }

  const std::vector<Bvh2Node<Real>>& nodes_;
  const std::vector<uint32_t>& order_;
  Bvh2<Real> out_;
};

}  // namespace

template <class Real>
void reinsert_subtrees(Bvh2<Real>& tree, int threads) {
  if (tree.nodes.size() < min_nodes || !std::isfinite(area_of(tree.nodes[0]))) return;
  std::vector<Bvh2Node<Real>> nodes = tree.nodes;
  const int team = threads > 0 ? threads : omp_get_max_threads();
  Reinsertion<Real>(nodes).run(nodes.size() < min_shared_nodes ? 1 : team);
  Renumbering<Real> renumbering(nodes, tree.order);
  if (renumbering.run()) tree = std::move(renumbering.tree());
}

template void reinsert_subtrees(Bvh2<float>&, int);
template void reinsert_subtrees(Bvh2<double>&, int);

}  // namespace alhazen::impl
