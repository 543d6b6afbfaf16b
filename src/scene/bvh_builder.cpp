#include "scene/bvh_builder.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

namespace alhazen {

namespace {

constexpr int bin_count = 16;
/// From this depth on ranges are halved, which ends before max_bvh_depth for any number of primitives.
constexpr int halving_depth = max_bvh_depth - 32;
constexpr uint32_t task_size = 8192;
/// Larger ranges are binned by all threads, in chunks whose number does not depend on the threads.
constexpr uint32_t parallel_binning_size = 1u << 17;
constexpr uint32_t binning_chunks = 16;

template <class Real>
struct Bin {
  Bounds3<Real> box;
  uint32_t count = 0;
};

template <class Real>
using Bins = std::array<std::array<Bin<Real>, bin_count>, 3>;

template <class Real>
struct RangeBounds {
  Bounds3<Real> boxes, centers;
  void extend(const RangeBounds& other) {
    boxes.extend(other.boxes);
    centers.extend(other.centers);
  }
};

struct Split {
  int axis = -1;  ///< -1: a leaf is cheaper, or no plane parts the centres
  int bin = 0;    ///< the first bin of the right side
};

struct FreeMemory {
  void operator()(void* p) const { std::free(p); }
};

template <class Real>
class Builder {
 public:
  Builder(std::span<const Bounds3<Real>> boxes, const BvhOptions& options) : boxes_(boxes), options_(options) {
    const size_t count = boxes.size();
    order_.resize(count);
    for (size_t i = 0; i < count; ++i) order_[i] = static_cast<uint32_t>(i);
    // Pages of the upper bound 2 n - 1 are touched only as far as nodes are made.
    nodes_.reset(static_cast<BvhNode<Real>*>(std::calloc(2 * count, sizeof(BvhNode<Real>))));
    if (!nodes_) throw std::bad_alloc();
  }

  BvhTree<Real> build() {
    const uint32_t count = static_cast<uint32_t>(order_.size());
    const int team = count < task_size ? 1 : options_.threads > 0 ? options_.threads : omp_get_max_threads();
#pragma omp parallel num_threads(team)
#pragma omp single
    build_range(0, 0, count, 0);
    BvhTree<Real> tree;
    tree.nodes.reserve(next_node_);
    tree.nodes.emplace_back();
    number_depth_first(0, 0, tree.nodes);
    tree.order = std::move(order_);
    return tree;
  }

 private:
  RangeBounds<Real> bounds_of(uint32_t begin, uint32_t end) const {
    RangeBounds<Real> b;
    for (uint32_t i = begin; i < end; ++i) {
      const Bounds3<Real>& box = boxes_[order_[i]];
      b.boxes.extend(box);
      b.centers.extend(box.center());
    }
    return b;
  }

  static int bin_of(const Vec3<Real>& center, const Bounds3<Real>& centers, const Vec3<Real>& scale, int axis) {
    const int bin = static_cast<int>((center[axis] - centers.low[axis]) * scale[axis]);
    return std::clamp(bin, 0, bin_count - 1);
  }

  static Vec3<Real> bin_scale(const Bounds3<Real>& centers) {
    const Vec3<Real> extent = centers.diagonal();
    const auto scale = [](Real e) {
      const Real s = static_cast<Real>(bin_count) * (1 - std::numeric_limits<Real>::epsilon() * 8) / e;
      return e > 0 && std::isfinite(s) ? s : Real(0);
    };
    return {scale(extent.x), scale(extent.y), scale(extent.z)};
  }

  void fill_bins(uint32_t begin, uint32_t end, const Bounds3<Real>& centers, Bins<Real>& bins) const {
    const Vec3<Real> scale = bin_scale(centers);
    for (uint32_t i = begin; i < end; ++i) {
      const Bounds3<Real>& box = boxes_[order_[i]];
      const Vec3<Real> center = box.center();
      for (int axis = 0; axis < 3; ++axis) {
        Bin<Real>& bin = bins[static_cast<size_t>(axis)][static_cast<size_t>(bin_of(center, centers, scale, axis))];
        bin.box.extend(box);
        ++bin.count;
      }
    }
  }

  /// `work(chunk, begin, end)` over equal parts of the range, as tasks.
  template <class Work>
  static void for_chunks(uint32_t begin, uint32_t end, const Work& work) {
    const uint64_t count = end - begin;
#pragma omp taskloop grainsize(1) default(shared)
    for (uint32_t c = 0; c < binning_chunks; ++c)
      work(c, begin + static_cast<uint32_t>(count * c / binning_chunks),
           begin + static_cast<uint32_t>(count * (c + 1) / binning_chunks));
  }

  RangeBounds<Real> parallel_bounds(uint32_t begin, uint32_t end) const {
    std::array<RangeBounds<Real>, binning_chunks> parts;
    for_chunks(begin, end, [&](uint32_t c, uint32_t b, uint32_t e) { parts[c] = bounds_of(b, e); });
    for (uint32_t c = 1; c < binning_chunks; ++c) parts[0].extend(parts[c]);
    return parts[0];
  }

  void parallel_bins(uint32_t begin, uint32_t end, const Bounds3<Real>& centers, Bins<Real>& bins) const {
    std::vector<Bins<Real>> parts(binning_chunks);
    for_chunks(begin, end, [&](uint32_t c, uint32_t b, uint32_t e) { fill_bins(b, e, centers, parts[c]); });
    for (const Bins<Real>& part : parts)
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t i = 0; i < bin_count; ++i) {
          bins[axis][i].box.extend(part[axis][i].box);
          bins[axis][i].count += part[axis][i].count;
        }
  }

  Split best_split(const Bins<Real>& bins, const RangeBounds<Real>& range, uint32_t count) const {
    Split best;
    double best_cost = static_cast<double>(count) * static_cast<double>(range.boxes.half_area());
    if (count > options_.max_leaf) best_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(range.centers.diagonal()[axis] > 0)) continue;
      const auto& row = bins[static_cast<size_t>(axis)];
      std::array<double, bin_count> right_cost{};
      Bounds3<Real> box;
      uint32_t n = 0;
      for (size_t i = bin_count - 1; i > 0; --i) {
        box.extend(row[i].box);
        n += row[i].count;
        right_cost[i] = n * static_cast<double>(box.half_area());
      }
      box = {};
      n = 0;
      for (size_t i = 1; i < bin_count; ++i) {
        box.extend(row[i - 1].box);
        n += row[i - 1].count;
        if (n == 0 || n == count) continue;
        const double cost = n * static_cast<double>(box.half_area()) + right_cost[i] +
                            options_.traversal_cost * static_cast<double>(range.boxes.half_area());
        if (cost < best_cost) {
          best_cost = cost;
          best = {axis, static_cast<int>(i)};
        }
      }
    }
    return best;
  }

  uint32_t partition(uint32_t begin, uint32_t end, const Bounds3<Real>& centers, const Split& split) {
    const Vec3<Real> scale = bin_scale(centers);
    const auto middle = std::partition(order_.begin() + begin, order_.begin() + end, [&](uint32_t i) {
      return bin_of(boxes_[i].center(), centers, scale, split.axis) < split.bin;
    });
    return static_cast<uint32_t>(middle - order_.begin());
  }

  uint32_t halve(uint32_t begin, uint32_t end, int axis) {
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                       const Real ca = boxes_[a].center()[axis], cb = boxes_[b].center()[axis];
                       return ca < cb || (ca == cb && a < b);
                     });
    return middle;
  }

  void build_range(uint32_t node_index, uint32_t begin, uint32_t end, int depth) {
    const uint32_t count = end - begin;
    const bool parallel = count >= parallel_binning_size;
    const RangeBounds<Real> range = parallel ? parallel_bounds(begin, end) : bounds_of(begin, end);
    BvhNode<Real>& node = nodes_.get()[node_index];
    node.corners[0] = range.boxes.low;
    node.corners[1] = range.boxes.high;
    Split split;
    if (count > 1 && depth < halving_depth) {
      Bins<Real> bins;
      if (parallel)
        parallel_bins(begin, end, range.centers, bins);
      else
        fill_bins(begin, end, range.centers, bins);
      split = best_split(bins, range, count);
    }
    if (split.axis < 0 && count <= options_.max_leaf) {
      node.first = begin;
      node.count = static_cast<uint16_t>(count);
      return;
    }
    const int axis = split.axis < 0 ? max_axis(range.centers.diagonal()) : split.axis;
    const uint32_t middle = split.axis < 0 ? halve(begin, end, axis) : partition(begin, end, range.centers, split);
    node.first = next_node_.fetch_add(2);
    node.count = 0;
    node.axis = static_cast<uint16_t>(axis);
    const uint32_t left = node.first;
#pragma omp task default(shared) firstprivate(left, begin, middle, depth) if (count > task_size)
    build_range(left, begin, middle, depth + 1);
    build_range(left + 1, middle, end, depth + 1);
#pragma omp taskwait
  }

  /// Threads number nodes in the order in which they come; this makes the order that of the tree alone.
  void number_depth_first(uint32_t from, uint32_t to, std::vector<BvhNode<Real>>& out) const {
    BvhNode<Real> node = nodes_.get()[from];
    const uint32_t children = node.first;
    if (node.count == 0) {
      node.first = static_cast<uint32_t>(out.size());
      out.resize(out.size() + 2);
    }
    out[to] = node;
    if (node.count > 0) return;
    number_depth_first(children, node.first, out);
    number_depth_first(children + 1, node.first + 1, out);
  }

  std::span<const Bounds3<Real>> boxes_;
  BvhOptions options_;
  std::vector<uint32_t> order_;
  std::unique_ptr<BvhNode<Real>, FreeMemory> nodes_;
  std::atomic<uint32_t> next_node_{1};
};

}  // namespace

template <class Real>
BvhTree<Real> build_bvh(std::span<const Bounds3<Real>> boxes, const BvhOptions& options) {
  if (boxes.empty()) return {};
  return Builder<Real>(boxes, options).build();
}

template BvhTree<float> build_bvh(std::span<const Bounds3<float>>, const BvhOptions&);
template BvhTree<double> build_bvh(std::span<const Bounds3<double>>, const BvhOptions&);

}  // namespace alhazen
