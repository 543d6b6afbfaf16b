#include "render/film.h"

namespace alhazen {

namespace {

template <class Vector>
void allocate_if(bool wanted, Vector& plane, size_t size) {
  if (wanted) plane.resize(size);
}

}  // namespace

template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, bool weighted, bool for_denoising) {
  size_t pixel = sizeof(Vec3<Real>) + sizeof(uint32_t);
  if (weighted) pixel += sizeof(Real);
  if (aovs.albedo || for_denoising) pixel += sizeof(Vec3<Real>);
  if (aovs.normal || for_denoising) pixel += sizeof(Vec3<Real>);
  if (aovs.depth || for_denoising) pixel += sizeof(Real) + sizeof(uint32_t);
  if (aovs.bounces) pixel += sizeof(uint32_t);
  if (aovs.variance || for_denoising) pixel += 2 * sizeof(Real);
  if (for_denoising) pixel += 3 * sizeof(Vec3<Real>) + sizeof(Real);
  return pixel * static_cast<uint64_t>(window.pixels());
}

template <class Real>
Film<Real>::Film(const PixelWindow& window, const AovSet& aovs, bool weighted, bool for_denoising)
    : window_(window), aovs_(aovs) {
  const size_t pixels = static_cast<size_t>(window.pixels());
  radiance_.resize(pixels);
  samples_.resize(pixels);
  allocate_if(weighted, weights_, pixels);
  allocate_if(aovs.albedo || for_denoising, albedo_, pixels);
  allocate_if(aovs.normal || for_denoising, normal_, pixels);
  allocate_if(aovs.depth || for_denoising, depth_, pixels);
  allocate_if(aovs.depth || for_denoising, hits_, pixels);
  allocate_if(aovs.bounces, segments_, pixels);
  allocate_if(aovs.variance || for_denoising, luminance_m2_, pixels);
  allocate_if(aovs.variance || for_denoising, luminance_mean_, pixels);
  allocate_if(for_denoising, odd_radiance_, pixels);
  allocate_if(for_denoising, odd_albedo_, pixels);
  allocate_if(for_denoising, odd_normal_, pixels);
  allocate_if(for_denoising, odd_depth_, pixels);
  const auto pointer = [](auto& plane) { return plane.empty() ? nullptr : plane.data(); };
#define ALHAZEN_PLANE(type, name) view_.name = pointer(name##_);
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
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
    put3(mean(radiance_[i], weights_.empty() ? n : weights_[i]));
    if (aovs_.albedo) put3(mean(albedo_[i], n));
    if (aovs_.normal) put3(mean(normal_[i], n));
    if (aovs_.depth) put(hits_[i] > 0 ? depth_[i] / static_cast<Real>(hits_[i]) : Real(0));
    if (aovs_.bounces) put(n > 0 ? static_cast<Real>(segments_[i]) / n : Real(0));
    if (aovs_.samples) put(n);
    if (aovs_.variance) put(n > 1 ? luminance_m2_[i] / (n - 1) : Real(0));
  }
}

template uint64_t film_bytes<float>(const PixelWindow&, const AovSet&, bool, bool);
template uint64_t film_bytes<double>(const PixelWindow&, const AovSet&, bool, bool);
template class Film<float>;
template class Film<double>;

}  // namespace alhazen
