#include "render/noisy_image.h"

namespace alhazen::impl {

namespace {

template <class Real>
void put(std::vector<float>& values, size_t i, const Vec3<Real>& sum, Real count) {
  const Vec3<Real> mean = count != 0 ? sum / count : Vec3<Real>{};
  values[3 * i] = static_cast<float>(mean.x);
  values[3 * i + 1] = static_cast<float>(mean.y);
  values[3 * i + 2] = static_cast<float>(mean.z);
}

template <class Real>
void put(std::vector<float>& values, size_t i, Real sum, Real count) {
  values[i] = count != 0 ? static_cast<float>(sum / count) : 0.0f;
}

}  // namespace

template <class Real>
NoisyImage make_noisy_image(const Film<Real>& film) {
  const FilmView<Real> planes = film.view();
  NoisyImage image;
  image.width = film.window().width();
  image.height = film.window().height();
  const size_t pixels = image.pixels();
  for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal, &image.depth})
    for (std::vector<float>* values : {&buffer->mean, &buffer->odd})
      values->resize((buffer == &image.depth ? 1 : 3) * pixels);
  image.hits.resize(pixels);
  image.odd_fraction.resize(pixels);
  image.variance.resize(pixels);
  image.samples.assign(planes.samples, planes.samples + pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const uint32_t samples = planes.samples[i], odd_samples = samples_in_odd_blocks(samples);
    const Real count = static_cast<Real>(samples), odd = static_cast<Real>(odd_samples);
    const auto all = planes.radiance_sum(i), of_odd = planes.odd_radiance_sum(i);
    put(image.radiance.mean, i, all.radiance, all.weight);
    put(image.radiance.odd, i, of_odd.radiance, of_odd.weight);
    const bool has_halves = of_odd.weight > 0 && all.weight > of_odd.weight;
    image.odd_fraction[i] = has_halves ? static_cast<float>(of_odd.weight / all.weight) : 0.0f;
    put(image.albedo.mean, i, planes.albedo[i], count);
    put(image.albedo.odd, i, planes.odd_albedo[i], odd);
    put(image.normal.mean, i, planes.normal[i], count);
    put(image.normal.odd, i, planes.odd_normal[i], odd);
    put(image.depth.mean, i, planes.depth[i], count);
    put(image.depth.odd, i, planes.odd_depth[i], odd);
    image.hits[i] = samples > 0 ? static_cast<float>(planes.hits[i]) / static_cast<float>(samples) : 0.0f;
    image.variance[i] = static_cast<float>(planes.sample_variance(i));
  }
  return image;
}

template NoisyImage make_noisy_image(const Film<float>&);
template NoisyImage make_noisy_image(const Film<double>&);

}  // namespace alhazen::impl
