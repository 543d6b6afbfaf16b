#include "render/denoiser.h"

#include <algorithm>
#include <cmath>

#include "render/denoising/blend.h"
#include "util/diagnostics.h"

namespace alhazen {

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
    if (!problem.empty()) throw InputError("the denoiser '" + asked + "' is not available: " + problem);
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

std::vector<float> denoise(const std::string& name, NoisyImage image, const DenoiseOptions& options) {
  denoising::repair(image);
  denoising::fill_gaps(image);
  std::vector<float> denoised = make_denoiser(name)->denoise(image, options);
  for (size_t i = 0; i < denoised.size(); ++i)
    if (!std::isfinite(denoised[i])) denoised[i] = image.radiance.mean[i];
  denoising::blend_with_noisy(image, denoised, std::max(1, options.threads));
  return denoised;
}

}  // namespace alhazen
