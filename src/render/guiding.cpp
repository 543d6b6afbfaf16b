#include "render/guiding.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <new>

#include "render/noise.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t leaf_cell = GuideView<float>::leaf_cell;

/// The first two iterations take about this many samples each, so that there is something to learn from.
constexpr int64_t first_samples = int64_t{1} << 17;
/// A region is halved when this many vertices, times the square root of 2^iteration, were in it.
constexpr double vertices_per_region = 2000;
/// A quarter of directions is divided when it has more than this part of the light of its region.
constexpr double divided_part = 0.02;
/// The share of the BSDF before it is learned, and its limits.
constexpr float first_share = 0.5f, min_share = 0.2f, max_share = 0.95f;
/// The share is learned from this many vertices at least.
constexpr uint64_t min_vertices = 256;
/// Levels of the tree of space.
constexpr uint32_t max_region_depth = 60;
/// Variances are relative to the luminance of tiles of this many pixels, plus a tenth of the mean.
constexpr int variance_tile = 8;
constexpr double floor_fraction = 0.1;
/// Guided samples take longer by about this factor; after the first guided iteration, which has learned little, guiding
/// may still be worse than none by this other.
constexpr double cost_of_guiding = 1.5, early_gain = 0.7;
/// Variances of fewer samples are not compared.
constexpr double min_compared_samples = 1024;
/// Those of an iteration are trusted when it has this part of the samples before it.
constexpr double trusted_part = 0.25;
/// Bounds the weights of iterations.
constexpr double max_weight = 1024;
/// The arrays take at most this part of the memory: the old and the new ones exist at once, and vectors grow by
/// doubling.
constexpr uint64_t parts_of_memory = 5;

uint64_t bytes_of(const GuideArrays& arrays) {
  const auto bytes = [](const auto& array) { return array.size() * sizeof(array[0]); };
  return bytes(arrays.cells) + bytes(arrays.regions) + bytes(arrays.quads) + bytes(arrays.light) +
         bytes(arrays.tallies);
}

/// Builds the arrays of the next iteration from those of the last.
class TreeBuilder {
 public:
  explicit TreeBuilder(const GuideArrays& old) : old_(old), sums_(old.quads.size()) {
    for (size_t i = sums_.size(); i-- > 0;)
      for (uint32_t k = 0; k < 4; ++k) sums_[i] += value_of(static_cast<uint32_t>(i), k);
  }

  /// Returns false if the arrays would take more than `max_bytes`.
  bool build(double vertices, double part, uint64_t max_bytes, bool learns_shares) {
    vertices_per_region_ = vertices;
    part_ = part;
    max_bytes_ = max_bytes;
    learns_shares_ = learns_shares;
    made_ = {};
    made_.cells.resize(1);
    made_.quads.resize(1);
    made_.light.resize(4);
    return copy_cell(0, 0, 0);
  }

  GuideArrays take() { return std::move(made_); }

 private:
  bool is_full() const { return bytes_of(made_) > max_bytes_; }

  double value_of(uint32_t quad, uint32_t quarter) const {
    const uint32_t child = old_.quads[quad].child[quarter];
    return child ? sums_[child] : static_cast<double>(old_.light[size_t{quad} * 4 + quarter]);
  }

  bool copy_cell(uint32_t from, uint32_t to, uint32_t depth) {
    const uint32_t node = old_.cells[from];
    if (node & leaf_cell) {
      const uint32_t region = node & ~leaf_cell;
      return divide(region, to, depth, static_cast<double>(old_.tallies[region].vertices), 1);
    }
    const uint32_t children = add_children(to);
    return copy_cell(node, children, depth + 1) && copy_cell(node + 1, children + 1, depth + 1);
  }

  uint32_t add_children(uint32_t cell) {
    const uint32_t children = static_cast<uint32_t>(made_.cells.size());
    made_.cells.resize(made_.cells.size() + 2);
    made_.cells[cell] = children;
    return children;
  }

  /// Halves a region while too many vertices are in it; they are taken to be divided evenly.
  bool divide(uint32_t region, uint32_t cell, uint32_t depth, double vertices, double part) {
    if (vertices > vertices_per_region_ && depth < max_region_depth) {
      const uint32_t children = add_children(cell);
      return divide(region, children, depth + 1, vertices / 2, part / 2) &&
             divide(region, children + 1, depth + 1, vertices / 2, part / 2);
    }
    const GuideRegion& old = old_.regions[region];
    made_.cells[cell] = leaf_cell | static_cast<uint32_t>(made_.regions.size());
    const GuideRegion made{static_cast<uint32_t>(made_.quads.size()), share_of(region)};
    total_ = sums_[old.quad];
    // What was learned earlier fades.
    kept_part_ = part / 2;
    add_quad(old.quad, 0, 0);
    made_.regions.push_back(made);
    made_.tallies.push_back({});
    return !is_full();
  }

  float share_of(uint32_t region) const {
    const GuideRegion& old = old_.regions[region];
    const GuideTally& tally = old_.tallies[region];
    if (!(sums_[old.quad] > 0)) return 1;
    if (old.bsdf_share == 1) return first_share;
    if (!learns_shares_ || tally.vertices < min_vertices) return old.bsdf_share;
    // The slopes fall from share to share, up to rounding: where they cross zero the share is best.
    const auto slope = [&](uint32_t i) { return static_cast<float>(static_cast<int64_t>(tally.slopes[i])); };
    if (slope(0) <= 0) return min_share;
    for (uint32_t i = 1; i < tried_shares; ++i)
      if (slope(i) <= 0)
        return std::max(min_share, tried_share(i - 1) + (tried_share(i) - tried_share(i - 1)) *
                                                            (slope(i - 1) / (slope(i - 1) - slope(i))));
    return max_share;
  }

  /// Adds a node for the old one, or, if that is 0, for a quarter whose light is `even`, the same everywhere in it.
  uint32_t add_quad(uint32_t old, double even, uint32_t depth) {
    const uint32_t made = static_cast<uint32_t>(made_.quads.size());
    made_.quads.push_back({});
    made_.light.resize(made_.light.size() + 4);
    double values[4], sum = 0;
    for (uint32_t k = 0; k < 4; ++k) sum += values[k] = old ? value_of(old, k) : even / 4;
    for (uint32_t k = 0; k < 4; ++k) {
      made_.quads[made].share[k] = sum > 0 ? static_cast<float>(values[k] / sum) : 0.25f;
      if (values[k] > part_ * total_ && depth + 1 < max_quad_depth && !is_full()) {
        const uint32_t child = add_quad(old ? old_.quads[old].child[k] : 0, values[k], depth + 1);
        made_.quads[made].child[k] = child;
      } else {
        made_.light[size_t{made} * 4 + k] = static_cast<uint64_t>(values[k] * kept_part_);
      }
    }
    return made;
  }

  const GuideArrays& old_;
  GuideArrays made_;
  std::vector<double> sums_;  ///< of the old nodes
  double vertices_per_region_ = 0, part_ = 0, total_ = 0, kept_part_ = 0;
  uint64_t max_bytes_ = 0;
  bool learns_shares_ = false;
};

/// Calls visit(pixel, tile) for each pixel of a window.
template <class Visit>
void visit_tiles(int width, int height, const Visit& visit) {
  const int columns = (width + variance_tile - 1) / variance_tile;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      visit(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x),
            static_cast<size_t>(y / variance_tile * columns + x / variance_tile));
}

size_t tile_count(int width, int height) {
  return static_cast<size_t>((width + variance_tile - 1) / variance_tile) *
         static_cast<size_t>((height + variance_tile - 1) / variance_tile);
}

template <class Real>
VarianceComparison compare_variances(const FilmView<Real>& film, int width, int height,
                                     const std::vector<float>& plain_variance) {
  struct Tile {
    double luminance = 0, variance = 0;
    uint32_t pixels = 0, counted = 0;
  };
  std::vector<Tile> tiles(tile_count(width, height));
  VarianceComparison result;
  double mean = 0;
  visit_tiles(width, height, [&](size_t i, size_t t) {
    Tile& tile = tiles[t];
    const double value = static_cast<double>(luminance(film.radiance_sum(i).mean()));
    tile.luminance += value;
    mean += value;
    ++tile.pixels;
    const uint32_t n = film.current_samples(i);
    if (n < 2 || film.is_finished(i)) return;
    ++tile.counted;
    tile.variance += static_cast<double>(film.luminance_m2[i]) / (n - 1);
    result.samples += n - 1;
    if (film.earlier_samples) result.earlier_samples += film.earlier_samples[i];
  });
  mean /= static_cast<double>(width) * height;
  for (size_t t = 0; t < tiles.size(); ++t) {
    const Tile& tile = tiles[t];
    const double reference = std::max(tile.luminance / tile.pixels, 0.0) + floor_fraction * mean;
    const double inverse = reference > 0 ? 1 / (reference * reference) : 0;
    result.present += tile.variance * inverse;
    if (!plain_variance.empty()) result.plain += static_cast<double>(plain_variance[t]) * tile.counted * inverse;
    result.present_tiles.push_back(tile.counted > 0 ? static_cast<float>(tile.variance / tile.counted) : 0.0f);
  }
  return result;
}

/// Those of different images are different, for devices that keep a copy of one and are given another.
uint64_t first_guide_generation() {
  static std::atomic<uint64_t> images{0};
  return images.fetch_add(1, std::memory_order_relaxed) << 32;
}

}  // namespace

template <class Real>
Guiding<Real>::Guiding(const RenderSettings& settings, const SceneView<Real>& scene)
    : decides_(settings.guiding == GuidingMode::automatic),
      max_bytes_(settings.guiding_memory / parts_of_memory),
      width_(settings.window.width()),
      height_(settings.window.height()),
      exposure_(static_cast<double>(scene.exposure)),
      bounds_(scene.bounds),
      generation_(first_guide_generation()) {
  const int64_t pixels = settings.window.pixels();
  const int64_t wanted = std::clamp<int64_t>((first_samples + pixels - 1) / pixels, 1, 256);
  first_ = static_cast<uint32_t>((wanted + samples_per_block - 1) / samples_per_block * samples_per_block);
  arrays_.cells.assign(1, leaf_cell);
  arrays_.regions.assign(1, {1, 1});
  arrays_.quads.assign(2, GuideQuad{{0.25f, 0.25f, 0.25f, 0.25f}, {0, 0, 0, 0}});
  arrays_.light.assign(8, 0);
  arrays_.tallies.assign(1, {});
}

template <class Real>
GuideView<Real> Guiding<Real>::view() {
  GuideView<Real> view;
  view.cells = arrays_.cells.data();
  view.regions = arrays_.regions.data();
  view.quads = arrays_.quads.data();
  view.light = arrays_.light.data();
  view.tallies = arrays_.tallies.data();
  view.cells_count = static_cast<uint32_t>(arrays_.cells.size());
  view.regions_count = static_cast<uint32_t>(arrays_.regions.size());
  view.quads_count = static_cast<uint32_t>(arrays_.quads.size());
  view.low = bounds_.low;
  const auto inverse = [](Real extent) { return extent > 0 ? 1 / extent : Real(0); };
  const Vec3<Real> extent = bounds_.diagonal();
  view.scale = {inverse(extent.x), inverse(extent.y), inverse(extent.z)};
  view.to_fixed = static_cast<Real>(to_fixed_);
  return view;
}

template <class Real>
void Guiding<Real>::add(const uint64_t* light, const GuideTally* tallies) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  for (size_t i = 0; i < arrays_.light.size(); ++i) arrays_.light[i] += light[i];
  for (size_t i = 0; i < arrays_.tallies.size(); ++i) {
    arrays_.tallies[i].vertices += tallies[i].vertices;
    for (uint32_t k = 0; k < tried_shares; ++k) arrays_.tallies[i].slopes[k] += tallies[i].slopes[k];
  }
}

template <class Real>
std::optional<double> Guiding<Real>::measured_weight(const VarianceComparison& variances) const {
  const double ratio = variances.plain / variances.present;
  if (!is_guided() || variances.samples < min_compared_samples || !(variances.plain > 0) || !std::isfinite(ratio))
    return std::nullopt;
  // The first samples of an iteration may have missed bright paths that are rare.
  const double trust =
      variances.earlier_samples > 0 ? std::min(1.0, variances.samples / (trusted_part * variances.earlier_samples)) : 1;
  return std::clamp(last_weight_ + trust * (ratio - last_weight_), 1 / max_weight, max_weight);
}

template <class Real>
void Guiding<Real>::weigh_samples(Film<Real>& film) {
  // Luminances are those of the image with this weight, whenever it is asked for.
  film.set_weight(static_cast<Real>(last_weight_));
  const auto weight = measured_weight(compare_variances(film.view(), width_, height_, plain_variance_));
  gain_ = weight.value_or(gain_);
  film.set_weight(static_cast<Real>(is_guided() ? weight.value_or(last_weight_) : 1));
}

template <class Real>
uint32_t Guiding<Real>::samples_left(uint32_t samples) const {
  const uint64_t end = samples == iteration_end() ? 2 * iteration_end() : iteration_end();
  return static_cast<uint32_t>(std::min<uint64_t>(end - samples, std::numeric_limits<uint32_t>::max()));
}

template <class Real>
void Guiding<Real>::begin_pass(Film<Real>& film, uint32_t samples) {
  if (samples == iteration_end()) end_iteration(film);
}

template <class Real>
void Guiding<Real>::end_iteration(Film<Real>& film) {
  ++iteration_;
  if (!is_on_) return;
  if (to_fixed_ == 0) {
    double sum = 0;
    visit_tiles(width_, height_, [&](size_t i, size_t) {
      sum += static_cast<double>(luminance(film.view().radiance_sum(i).mean())) / exposure_;
    });
    const double mean = sum / (static_cast<double>(width_) * height_);
    // Where there is no light yet, there is nothing to learn; the next iteration may find some.
    if (mean > 0 && std::isfinite(mean)) to_fixed_ = 1 / mean;
    return;
  }
  film.set_weight(static_cast<Real>(last_weight_));
  VarianceComparison variances = compare_variances(film.view(), width_, height_, plain_variance_);
  const std::optional<double> weight = measured_weight(variances);
  last_weight_ = is_guided() ? weight.value_or(last_weight_) : 1;
  gain_ = weight.value_or(gain_);
  film.set_weight(static_cast<Real>(last_weight_));
  if (film.view().earlier_variance) keep_variances(film);
  film.end_iteration();
  if (plain_variance_.empty()) {
    plain_variance_ = std::move(variances.present_tiles);
  } else {
    ++guided_;
    if (decides_ && weight && *weight < (guided_ == 1 ? early_gain : cost_of_guiding)) is_on_ = false;
  }
  if (is_on_) learn();
}

template <class Real>
void Guiding<Real>::learn() try {
  TreeBuilder builder(arrays_);
  double vertices = vertices_per_region * std::sqrt(std::exp2(iteration_ > 2 ? iteration_ - 2 : 0)),
         part = divided_part;
  while (!builder.build(vertices, part, max_bytes_, guided_ > 0)) {
    vertices *= 2;
    part *= 1.5;
  }
  arrays_ = builder.take();
  ++generation_;
} catch (const std::bad_alloc&) {
  // The next iteration is guided by what this one was.
}

template <class Real>
GuidingState Guiding<Real>::state(uint32_t samples) const {
  GuidingState state;
  state.is_used = is_guided() && samples > iteration_end() / 2;
  state.iterations = guided_ + (state.is_used ? 1 : 0);
  state.regions = arrays_.regions.size();
  state.bytes = bytes_of(arrays_);
  state.gain = gain_;
  return state;
}

namespace {

class ByteWriter {
 public:
  template <class T>
  void operator()(const std::vector<T>& values) {
    const uint64_t count = values.size();
    put(&count, sizeof(count));
    put(values.data(), count * sizeof(T));
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(const T& value) { put(&value, sizeof(value)); }
  std::vector<std::byte> bytes;

 private:
  void put(const void* data, size_t size) {
    if (size == 0) return;
    const std::byte* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
  }
};

class ByteReader {
 public:
  explicit ByteReader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  void operator()(std::vector<T>& values) {
    uint64_t count = 0;
    (*this)(count);
    if (!is_good || count > (bytes_.size() - at_) / sizeof(T)) {
      is_good = false;
      return;
    }
    values.resize(count);
    take(values.data(), count * sizeof(T));
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(T& value) { take(&value, sizeof(value)); }
  bool is_at_end() const { return at_ == bytes_.size(); }
  bool is_good = true;

 private:
  void take(void* data, size_t size) {
    if (!is_good || size > bytes_.size() - at_) {
      is_good = false;
      return;
    }
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  const std::vector<std::byte>& bytes_;
  size_t at_ = 0;
};

}  // namespace

template <class Real>
std::vector<std::byte> Guiding<Real>::bytes() const {
  ByteWriter write;
  visit_state(*this, write);
  return std::move(write.bytes);
}

template <class Real>
bool Guiding<Real>::restore(const std::vector<std::byte>& bytes) {
  ByteReader read(bytes);
  visit_state(*this, read);
  ++generation_;
  return read.is_good && read.is_at_end() && arrays_.light.size() == 4 * arrays_.quads.size() &&
         arrays_.tallies.size() == arrays_.regions.size();
}

template <class Real>
template <class Self, class Visit>
void Guiding<Real>::visit_state(Self& self, Visit& visit) {
  visit(self.is_on_);
  visit(self.iteration_);
  visit(self.guided_);
  visit(self.to_fixed_);
  visit(self.last_weight_);
  visit(self.gain_);
  visit(self.plain_variance_);
  visit(self.arrays_.cells);
  visit(self.arrays_.regions);
  visit(self.arrays_.quads);
  visit(self.arrays_.light);
  visit(self.arrays_.tallies);
}

template class Guiding<float>;
template class Guiding<double>;

}  // namespace alhazen::impl
