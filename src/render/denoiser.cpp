#include "render/denoiser.h"

#include <algorithm>
#include <cmath>

#include "render/denoising/blend.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

std::unique_ptr<Denoiser> make_denoiser(const std::string& name) {
  std::string names;
  for (std::unique_ptr<Denoiser>& denoiser : all_denoisers()) {
    if (denoiser->name() == name) return std::move(denoiser);
    names += ", " + denoiser->name();
  }
  throw InputError("unknown denoiser '" + name + "': it may be none, auto" + names);
}

ChosenDenoiser choose_denoiser(const std::string& asked) {
  if (asked.empty() || asked == "none") return {};
  if (asked != "auto") {
    const std::string problem = make_denoiser(asked)->problem();
    if (!problem.empty()) throw UnsupportedError("the denoiser '" + asked + "' is not available: " + problem);
    return {asked, {}};
  }
  ChosenDenoiser chosen;
  for (const std::unique_ptr<Denoiser>& denoiser : all_denoisers()) {
    if (denoiser->problem().empty()) {
      chosen.name = denoiser->name();
      break;
    }
    if (const std::string defect = denoiser->defect(); !defect.empty())
      chosen.warning = "the denoiser '" + denoiser->name() + "' is not used: " + defect;
  }
  return chosen;
}

std::string next_denoiser(const std::string& name) {
  bool is_after = false;
  for (const std::unique_ptr<Denoiser>& denoiser : all_denoisers()) {
    if (is_after && denoiser->problem().empty()) return denoiser->name();
    is_after = is_after || denoiser->name() == name;
  }
  return {};
}

namespace {

/// The power of two that brings the geometric mean of the channels that are not black close to 1, and no value above
/// 2^60, so that squares are finite. By powers of two nothing is rounded.
float normalizing_scale(const std::vector<float>& radiance) {
  double sum = 0;
  size_t count = 0;
  float brightest = 0;
  for (const float value : radiance) {
    if (!(value > 0)) continue;
    sum += std::log2(static_cast<double>(value));
    brightest = std::max(brightest, value);
    ++count;
  }
  if (count == 0) return 1;
  const double wanted = -std::floor(sum / static_cast<double>(count)),
               most = 60 - std::ceil(std::log2(static_cast<double>(brightest)));
  return std::ldexp(1.0f, static_cast<int>(std::clamp(std::min(wanted, most), -60.0, 60.0)));
}

void multiply(std::vector<float>& values, float factor) {
  for (float& value : values) value *= factor;
}

}  // namespace

std::vector<float> denoise(const std::string& name, NoisyImage image, const DenoiseOptions& options) {
  denoising::repair(image);
  denoising::fill_gaps(image);
  // Constants that keep quotients finite are small only beside values about 1.
  const float scale = normalizing_scale(image.radiance.mean);
  multiply(image.radiance.mean, scale);
  multiply(image.radiance.odd, scale);
  multiply(image.variance, scale * scale);
  std::vector<float> denoised = make_denoiser(name)->denoise(image, options);
  for (size_t i = 0; i < denoised.size(); ++i)
    if (!std::isfinite(denoised[i])) denoised[i] = image.radiance.mean[i];
  denoising::blend_with_noisy(image, denoised, std::max(1, options.threads));
  multiply(denoised, 1 / scale);
  return denoised;
}

}  // namespace alhazen::impl
