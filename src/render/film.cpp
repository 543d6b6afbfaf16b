#include "render/film.h"

#include <atomic>

namespace alhazen::impl {

namespace {

/// Whether a film has each of its planes.
struct WantedPlanes {
#define ALHAZEN_PLANE(type, name) bool name = false;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE

  WantedPlanes(const AovSet& aovs, const FilmExtras& extras) {
    radiance = samples = alpha = true;
    weights = extras.weights;
    albedo = aovs.albedo || extras.denoising;
    normal = aovs.normal || aovs.camera_normal || extras.denoising;
    depth = hits = aovs.distance || extras.denoising;
    segments = aovs.bounces;
    position = points = aovs.depth || aovs.position || aovs.uv || aovs.motion;
    uv = aovs.uv;
    displacement = aovs.motion;
    light = aovs.components;
    groups = aovs.light_groups;
    objects = aovs.object || aovs.cryptomatte;
    materials = aovs.material || aovs.cryptomatte;
    luminance_m2 = luminance_mean = aovs.variance || extras.denoising || extras.noise_target || extras.guiding;
    odd_radiance = odd_albedo = odd_normal = odd_depth = extras.denoising;
    odd_weights = extras.denoising && extras.weights;
    block_m2 = half_difference = finished = extras.noise_target;
    earlier_radiance = earlier_weights = earlier_samples = earlier_sample_variance = extras.guiding;
    earlier_alpha = extras.guiding;
    earlier_light = extras.guiding && light;
    earlier_groups = extras.guiding && groups;
    earlier_odd_radiance = earlier_odd_weights = extras.guiding && extras.denoising;
    earlier_variance = earlier_half_variance = extras.guiding && extras.noise_target;
  }
};

}  // namespace

template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras) {
  const WantedPlanes wanted(aovs, extras);
  size_t pixel = 0;
#define ALHAZEN_PLANE(type, name) pixel += wanted.name ? sizeof(type) : 0;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  return pixel * static_cast<uint64_t>(window.pixels());
}

namespace {

/// Generations of different films are different, for devices that keep a copy of one and are given another.
uint64_t first_film_generation() {
  static std::atomic<uint64_t> films{0};
  return films.fetch_add(1, std::memory_order_relaxed) << 32;
}

}  // namespace

template <class Real>
Film<Real>::Film(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras)
    : window_(window), aovs_(aovs), has_alpha_(extras.alpha), generation_(first_film_generation()) {
  const size_t pixels = static_cast<size_t>(window.pixels());
  const WantedPlanes wanted(aovs, extras);
#define ALHAZEN_PLANE(type, name)          \
  if (wanted.name) name##_.resize(pixels); \
  view_.name = wanted.name ? name##_.data() : nullptr;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
}

template <class Real>
uint64_t Film<Real>::unfinished(int x0, int x1, int y0, int y1) const {
  uint64_t count = static_cast<uint64_t>(x1 - x0) * static_cast<uint64_t>(y1 - y0);
  if (finished_.empty()) return count;
  for (int y = y0; y < y1; ++y) {
    const uint8_t* row = finished_.data() + index_of(x0, y);
    count -= static_cast<uint64_t>(std::count(row, row + (x1 - x0), uint8_t{1}));
  }
  return count;
}

template <class Real>
uint64_t Film<Real>::total_samples(uint32_t limit) const {
  uint64_t total = 0;
  for (const uint32_t samples : samples_) total += std::min(samples, limit);
  return total;
}

template <class Real>
bool Film<Real>::has_samples(uint32_t count) const {
  for (size_t i = 0; i < samples_.size(); ++i)
    if (samples_[i] < count && !view_.is_finished(i)) return false;
  return true;
}

template <class Real>
uint64_t Film<Real>::pixels_without_samples() const {
  return static_cast<uint64_t>(std::count(samples_.begin(), samples_.end(), 0u));
}

template <class Real>
void Film<Real>::end_iteration() {
  const Real weight = view_.iteration_weight;
  for (size_t i = 0; i < samples_.size(); ++i) {
    earlier_radiance_[i] += radiance_[i] * weight;
    earlier_weights_[i] += weights_[i] * weight;
    earlier_alpha_[i] += alpha_[i] * weight;
    if (!earlier_light_.empty()) earlier_light_[i].add(light_[i], weight);
    if (!earlier_groups_.empty()) earlier_groups_[i].add(groups_[i], weight);
    if (!earlier_odd_radiance_.empty()) {
      earlier_odd_radiance_[i] += odd_radiance_[i] * weight;
      earlier_odd_weights_[i] += odd_weights_[i] * weight;
    }
    earlier_sample_variance_[i] = view_.sample_variance(i);
    earlier_samples_[i] = samples_[i];
  }
  const auto clear = [](auto& plane) { plane.assign(plane.size(), {}); };
  clear(radiance_);
  clear(weights_);
  clear(alpha_);
  clear(light_);
  clear(groups_);
  clear(odd_radiance_);
  clear(odd_weights_);
  clear(luminance_m2_);
  clear(luminance_mean_);
  clear(block_m2_);
  clear(half_difference_);
  ++generation_;
}

template <class Real>
std::vector<std::string> Film<Real>::channels() const {
  std::vector<std::string> names{"R", "G", "B"};
  if (has_alpha_) names.push_back("A");
  for (const ImageLayer<Real>& layer : image_layers<Real>())
    if (aovs_.*layer.is_wanted)
      for (std::string& channel : layer.channels_in(scene_)) names.push_back(std::move(channel));
  return names;
}

template <class Real>
void Film<Real>::resolve_row(int y, std::span<float> row) const {
  const size_t width = static_cast<size_t>(window_.width()), first = static_cast<size_t>(y) * width;
  const auto put = [&](size_t channel, size_t x, float value) { row[channel * width + x] = value; };
  for (size_t x = 0; x < width; ++x) {
    const Vec3<Real> radiance = view_.radiance_sum(first + x).mean();
    put(0, x, static_cast<float>(radiance.x));
    put(1, x, static_cast<float>(radiance.y));
    put(2, x, static_cast<float>(radiance.z));
    if (has_alpha_) put(3, x, static_cast<float>(std::clamp(view_.coverage(first + x), Real(0), Real(1))));
  }
  size_t channel = has_alpha_ ? 4 : 3;
  std::vector<float> values;
  for (const ImageLayer<Real>& layer : image_layers<Real>()) {
    if (!(aovs_.*layer.is_wanted)) continue;
    values.resize(layer.channels_in(scene_).size());
    for (size_t x = 0; x < width; ++x) {
      layer.put(view_, scene_, first + x, values.data());
      for (size_t c = 0; c < values.size(); ++c) put(channel + c, x, values[c]);
    }
    channel += values.size();
  }
}

template uint64_t film_bytes<float>(const PixelWindow&, const AovSet&, const FilmExtras&);
template uint64_t film_bytes<double>(const PixelWindow&, const AovSet&, const FilmExtras&);
template class Film<float>;
template class Film<double>;

}  // namespace alhazen::impl
