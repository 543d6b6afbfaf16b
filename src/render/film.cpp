#include "render/film.h"

namespace alhazen {

namespace {

template <class Vector>
void allocate_if(bool wanted, Vector& plane, size_t size) {
  if (wanted) plane.resize(size);
}

}  // namespace

template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras) {
  size_t pixel = sizeof(Vec3<Real>) + sizeof(uint32_t);
  if (extras.weights) pixel += sizeof(Real);
  if (aovs.albedo || extras.denoising) pixel += sizeof(Vec3<Real>);
  if (aovs.normal || extras.denoising) pixel += sizeof(Vec3<Real>);
  if (aovs.depth || extras.denoising) pixel += sizeof(Real) + sizeof(uint32_t);
  if (aovs.bounces) pixel += sizeof(uint32_t);
  if (aovs.variance || extras.denoising || extras.noise_target || extras.guiding) pixel += 2 * sizeof(Real);
  if (extras.denoising) pixel += 3 * sizeof(Vec3<Real>) + sizeof(Real);
  if (extras.denoising && extras.weights) pixel += sizeof(Real);
  if (extras.noise_target) pixel += 2 * sizeof(Real) + sizeof(uint8_t);
  if (extras.guiding) pixel += sizeof(Vec3<Real>) + 2 * sizeof(Real) + sizeof(uint32_t);
  if (extras.guiding && extras.denoising) pixel += sizeof(Vec3<Real>) + sizeof(Real);
  if (extras.guiding && extras.noise_target) pixel += 2 * sizeof(Real);
  return pixel * static_cast<uint64_t>(window.pixels());
}

template <class Real>
Film<Real>::Film(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras)
    : window_(window), aovs_(aovs) {
  const size_t pixels = static_cast<size_t>(window.pixels());
  radiance_.resize(pixels);
  samples_.resize(pixels);
  allocate_if(extras.weights, weights_, pixels);
  allocate_if(aovs.albedo || extras.denoising, albedo_, pixels);
  allocate_if(aovs.normal || extras.denoising, normal_, pixels);
  allocate_if(aovs.depth || extras.denoising, depth_, pixels);
  allocate_if(aovs.depth || extras.denoising, hits_, pixels);
  allocate_if(aovs.bounces, segments_, pixels);
  const bool wants_variance = aovs.variance || extras.denoising || extras.noise_target || extras.guiding;
  allocate_if(wants_variance, luminance_m2_, pixels);
  allocate_if(wants_variance, luminance_mean_, pixels);
  allocate_if(extras.denoising, odd_radiance_, pixels);
  allocate_if(extras.denoising, odd_albedo_, pixels);
  allocate_if(extras.denoising, odd_normal_, pixels);
  allocate_if(extras.denoising, odd_depth_, pixels);
  allocate_if(extras.denoising && extras.weights, odd_weights_, pixels);
  allocate_if(extras.noise_target, block_m2_, pixels);
  allocate_if(extras.noise_target, half_difference_, pixels);
  allocate_if(extras.noise_target, finished_, pixels);
  allocate_if(extras.guiding, earlier_radiance_, pixels);
  allocate_if(extras.guiding && extras.denoising, earlier_odd_radiance_, pixels);
  allocate_if(extras.guiding, earlier_weights_, pixels);
  allocate_if(extras.guiding && extras.denoising, earlier_odd_weights_, pixels);
  allocate_if(extras.guiding, earlier_samples_, pixels);
  allocate_if(extras.guiding, earlier_sample_variance_, pixels);
  allocate_if(extras.guiding && extras.noise_target, earlier_variance_, pixels);
  allocate_if(extras.guiding && extras.noise_target, earlier_half_variance_, pixels);
  const auto pointer = [](auto& plane) { return plane.empty() ? nullptr : plane.data(); };
#define ALHAZEN_PLANE(type, name) view_.name = pointer(name##_);
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
  const auto add = [&](bool wanted, std::initializer_list<const char*> layer) {
    if (wanted) names.insert(names.end(), layer.begin(), layer.end());
  };
  add(aovs_.albedo, {"albedo.R", "albedo.G", "albedo.B"});
  add(aovs_.normal, {"normal.X", "normal.Y", "normal.Z"});
  add(aovs_.depth, {"depth.Z"});
  add(aovs_.bounces, {"bounces.Y"});
  add(aovs_.samples, {"samples.Y"});
  add(aovs_.variance, {"variance.Y"});
  return names;
}

template <class Real>
void Film<Real>::resolve_row(int y, std::span<float> row) const {
  const size_t width = static_cast<size_t>(window_.width());
  for (size_t x = 0; x < width; ++x) {
    const size_t i = static_cast<size_t>(y) * width + x;
    float* out = row.data() + x;
    const auto put = [&](Real value) {
      *out = static_cast<float>(value);
      out += width;
    };
    const auto put3 = [&](const Vec3<Real>& value) {
      put(value.x);
      put(value.y);
      put(value.z);
    };
    const auto mean = [](const Vec3<Real>& sum, Real count) { return count != 0 ? sum / count : Vec3<Real>{}; };
    const Real n = static_cast<Real>(samples_[i]);
    put3(view_.radiance_sum(i).mean());
    if (aovs_.albedo) put3(mean(albedo_[i], n));
    if (aovs_.normal) put3(mean(normal_[i], n));
    if (aovs_.depth) put(hits_[i] > 0 ? depth_[i] / static_cast<Real>(hits_[i]) : Real(0));
    if (aovs_.bounces) put(n > 0 ? static_cast<Real>(segments_[i]) / n : Real(0));
    if (aovs_.samples) put(n);
    if (aovs_.variance) put(view_.sample_variance(i));
  }
}

template uint64_t film_bytes<float>(const PixelWindow&, const AovSet&, const FilmExtras&);
template uint64_t film_bytes<double>(const PixelWindow&, const AovSet&, const FilmExtras&);
template class Film<float>;
template class Film<double>;

}  // namespace alhazen
