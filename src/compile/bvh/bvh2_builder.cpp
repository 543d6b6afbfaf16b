#include "compile/bvh/bvh2_builder.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "core/simd/lanes.h"
#include "util/large_array.h"

namespace alhazen::impl {

namespace {

constexpr int max_bins = 16;
/// From this depth on, ranges are halved, which keeps the depth below max_bvh2_depth for any number of primitives.
constexpr int halving_depth = max_bvh2_depth - 32;
constexpr uint32_t task_size = 8192;
/// Larger ranges are binned by all threads, in chunks whose number does not depend on the threads.
constexpr uint32_t parallel_binning_size = 1u << 17;
constexpr uint32_t binning_chunks = 16;

/// Returns the number of bins. Small ranges, which are the most frequent, use fewer bins to make the sweep cheaper.
constexpr int bins_for(uint32_t count) { return count < 96 ? 4 + static_cast<int>(count / 8) : max_bins; }

template <class Real>
using Row = Lanes<Real, 4>;

/// A primitive's box and index in a layout for SIMD instructions: two rows of four, whose last element is not part of
/// the box.
template <class Real>
struct Reference {
  Vec3<Real> low;
  uint32_t index = 0;
  Vec3<Real> high;
  Real unused = 0;

  Row<Real> lows() const { return Row<Real>::load(&low.x); }
  Row<Real> highs() const { return Row<Real>::load(&high.x); }
  Vec3<Real> centre() const { return Bounds3<Real>{low, high}.centre(); }
};

static_assert(sizeof(Reference<float>) == 2 * sizeof(Row<float>) &&
              sizeof(Reference<double>) == 2 * sizeof(Row<double>));

template <class Real>
struct RowBounds {
  Row<Real> low, high;

  static RowBounds empty() { return {Row<Real>::all(infinity<Real>), Row<Real>::all(-infinity<Real>)}; }
  void extend(const Row<Real>& other_low, const Row<Real>& other_high) {
    low = min(other_low, low);
    high = max(other_high, high);
  }
  void extend(const RowBounds& other) { extend(other.low, other.high); }
  Bounds3<Real> bounds() const {
    return {{low.lane(0), low.lane(1), low.lane(2)}, {high.lane(0), high.lane(1), high.lane(2)}};
  }
};

template <class Real>
struct Bin {
  RowBounds<Real> box;
  uint32_t count;
};

/// The first `count` bins of each axis.
template <class Real>
struct Bins {
  int count = 0;
  Bin<Real> of_axis[3][max_bins];

  Bins() {}
  explicit Bins(int bins) { clear(bins); }
  void clear(int bins) {
    count = bins;
    for (auto& row : of_axis)
      for (int i = 0; i < count; ++i) row[i] = {RowBounds<Real>::empty(), 0};
  }
  void extend(const Bins& other) {
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < count; ++i) {
        of_axis[axis][i].box.extend(other.of_axis[axis][i].box);
        of_axis[axis][i].count += other.of_axis[axis][i].count;
      }
  }
};

template <class Real>
struct RangeBounds {
  RowBounds<Real> boxes = RowBounds<Real>::empty(), centres = RowBounds<Real>::empty();
  void extend(const RangeBounds& other) {
    boxes.extend(other.boxes);
    centres.extend(other.centres);
  }
};

/// Maps twice a centre to its bin on each axis.
template <class Real>
class Binning {
 public:
  Binning(const Bounds3<Real>& centres, int bins) : bins_(bins) {
    const Vec3<Real> extent = centres.diagonal();
    for (int axis = 0; axis < 3; ++axis) {
      const Real s = static_cast<Real>(bins) * (1 - std::numeric_limits<Real>::epsilon() * 8) / extent[axis];
      scale_[axis] = extent[axis] > 0 && std::isfinite(s) ? s : Real(0);
      low_[axis] = centres.low[axis];
    }
  }

  ALHAZEN_INLINE void bins_of(const Reference<Real>& reference, int (&bin)[3]) const {
    const Row<Real> centre = (reference.lows() + reference.highs()) * Row<Real>::all(Real(0.5));
    Real place[4];
    ((centre - Row<Real>::load(low_)) * Row<Real>::load(scale_)).store(place);
    for (int axis = 0; axis < 3; ++axis) bin[axis] = std::clamp(static_cast<int>(place[axis]), 0, bins_ - 1);
  }

  ALHAZEN_INLINE int bin_of(const Reference<Real>& reference, int axis) const {
    return std::clamp(static_cast<int>((reference.centre()[axis] - low_[axis]) * scale_[axis]), 0, bins_ - 1);
  }

 private:
  int bins_;
  Real low_[4]{}, scale_[4]{};
};

struct Split {
  int axis = -1;  ///< -1: a leaf is cheaper, or no plane separates the centres
  int bin = 0;    ///< the first bin of the right side
};

template <class Real>
class Builder {
 public:
  Builder(std::span<const Bounds3<Real>> boxes, const Bvh2Options& options)
      : options_(options),
        references_(boxes.size()),
        nodes_(2 * boxes.size()),
        count_(static_cast<uint32_t>(boxes.size())) {
    team_ = count_ < task_size ? 1 : options.threads > 0 ? options.threads : omp_get_max_threads();
#pragma omp parallel for num_threads(team_)
    for (uint32_t i = 0; i < count_; ++i) references_[i] = {boxes[i].low, i, boxes[i].high, 0};
  }

  Bvh2<Real> build() {
#pragma omp parallel num_threads(team_)
#pragma omp single
    build_range(0, 0, count_, 0);
    Bvh2<Real> tree;
    tree.order.resize(count_);
    for (uint32_t i = 0; i < count_; ++i) tree.order[i] = references_[i].index;
    references_.clear();
    tree.nodes.reserve(next_node_);
    tree.nodes.emplace_back();
    number_depth_first(0, 0, tree.nodes);
    return tree;
  }

 private:
  RangeBounds<Real> bounds_of(uint32_t begin, uint32_t end) const {
    RangeBounds<Real> b;
    const Row<Real> half = Row<Real>::all(Real(0.5));
    for (uint32_t i = begin; i < end; ++i) {
      const Row<Real> low = references_[i].lows(), high = references_[i].highs();
      const Row<Real> centre = (low + high) * half;
      b.boxes.extend(low, high);
      b.centres.extend(centre, centre);
    }
    return b;
  }

  void fill_bins(uint32_t begin, uint32_t end, const Binning<Real>& binning, Bins<Real>& bins) const {
    for (uint32_t i = begin; i < end; ++i) {
      int place[3];
      binning.bins_of(references_[i], place);
      const Row<Real> low = references_[i].lows(), high = references_[i].highs();
      for (int axis = 0; axis < 3; ++axis) {
        Bin<Real>& bin = bins.of_axis[axis][place[axis]];
        bin.box.extend(low, high);
        ++bin.count;
      }
    }
  }

  /// Calls `work(chunk, begin, end)` for equal parts of the range, as tasks.
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

  void parallel_bins(uint32_t begin, uint32_t end, const Binning<Real>& binning, Bins<Real>& bins) const {
    // On the stack, since an allocation that throws within a task would end the process.
    std::array<Bins<Real>, binning_chunks> parts;
    for_chunks(begin, end, [&](uint32_t c, uint32_t b, uint32_t e) {
      parts[c].clear(bins.count);
      fill_bins(b, e, binning, parts[c]);
    });
    for (const Bins<Real>& part : parts) bins.extend(part);
  }

  Split best_split(const Bins<Real>& bins, const Bounds3<Real>& boxes, const Bounds3<Real>& centres,
                   uint32_t count) const {
    Split best;
    const double area = static_cast<double>(boxes.half_area());
    double best_cost = static_cast<double>(count) * area;
    if (count > options_.max_leaf) best_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centres.diagonal()[axis] > 0)) continue;
      const auto& row = bins.of_axis[axis];
      double right_cost[max_bins];
      RowBounds<Real> box = RowBounds<Real>::empty();
      uint32_t n = 0;
      for (int i = bins.count - 1; i > 0; --i) {
        box.extend(row[i].box);
        n += row[i].count;
        right_cost[i] = n * static_cast<double>(box.bounds().half_area());
      }
      box = RowBounds<Real>::empty();
      n = 0;
      for (int i = 1; i < bins.count; ++i) {
        box.extend(row[i - 1].box);
        n += row[i - 1].count;
        if (n == 0 || n == count) continue;
        const double cost =
            n * static_cast<double>(box.bounds().half_area()) + right_cost[i] + options_.traversal_cost * area;
        if (cost < best_cost) {
          best_cost = cost;
          best = {axis, i};
        }
      }
    }
    return best;
  }

  uint32_t partition(uint32_t begin, uint32_t end, const Binning<Real>& binning, const Split& split) {
    Reference<Real>* const first = references_.begin();
    const auto middle = std::partition(first + begin, first + end, [&](const Reference<Real>& reference) {
      return binning.bin_of(reference, split.axis) < split.bin;
    });
    return static_cast<uint32_t>(middle - first);
  }

  uint32_t halve(uint32_t begin, uint32_t end, int axis) {
    const uint32_t middle = begin + (end - begin) / 2;
    Reference<Real>* const first = references_.begin();
    std::nth_element(first + begin, first + middle, first + end,
                     [&](const Reference<Real>& a, const Reference<Real>& b) {
                       const Real ca = a.centre()[axis], cb = b.centre()[axis];
                       return ca < cb || (ca == cb && a.index < b.index);
                     });
    return middle;
  }

  void build_range(uint32_t node_index, uint32_t begin, uint32_t end, int depth) {
    const uint32_t count = end - begin;
    const bool parallel = count >= parallel_binning_size;
    const RangeBounds<Real> range = parallel ? parallel_bounds(begin, end) : bounds_of(begin, end);
    const Bounds3<Real> boxes = range.boxes.bounds(), centres = range.centres.bounds();
    Bvh2Node<Real>& node = nodes_[node_index];
    node.corners[0] = boxes.low;
    node.corners[1] = boxes.high;
    const Binning<Real> binning(centres, bins_for(count));
    Split split;
    if (count > 1 && depth < halving_depth) {
      Bins<Real> bins(bins_for(count));
      if (parallel)
        parallel_bins(begin, end, binning, bins);
      else
        fill_bins(begin, end, binning, bins);
      split = best_split(bins, boxes, centres, count);
    }
    if (split.axis < 0 && count <= options_.max_leaf) {
      node.first = begin;
      node.count = static_cast<uint16_t>(count);
      node.axis = 0;
      return;
    }
    const int axis = split.axis < 0 ? max_axis(centres.diagonal()) : split.axis;
    const uint32_t middle = split.axis < 0 ? halve(begin, end, axis) : partition(begin, end, binning, split);
    node.first = next_node_.fetch_add(2);
    node.count = 0;
    node.axis = static_cast<uint16_t>(axis);
    const uint32_t left = node.first;
#pragma omp task default(shared) firstprivate(left, begin, middle, depth) if (count > task_size)
    build_range(left, begin, middle, depth + 1);
    build_range(left + 1, middle, end, depth + 1);
#pragma omp taskwait
  }

  /// Renumbers the nodes depth-first, since their order otherwise depends on the timing of the threads.
  void number_depth_first(uint32_t from, uint32_t to, std::vector<Bvh2Node<Real>>& out) const {
    Bvh2Node<Real> node = nodes_[from];
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

  Bvh2Options options_;
  LargeArray<Reference<Real>> references_;
  LargeArray<Bvh2Node<Real>> nodes_;  ///< as many as there can be, 2 n - 1
  uint32_t count_;
  int team_;
  std::atomic<uint32_t> next_node_{1};
};

}  // namespace

template <class Real>
Bvh2<Real> build_bvh2(std::span<const Bounds3<Real>> boxes, const Bvh2Options& options) {
  if (boxes.empty()) return {};
  return Builder<Real>(boxes, options).build();
}

template Bvh2<float> build_bvh2(std::span<const Bounds3<float>>, const Bvh2Options&);
template Bvh2<double> build_bvh2(std::span<const Bounds3<double>>, const Bvh2Options&);

}  // namespace alhazen::impl
