#include "render/quality.h"

#include "render/setting_table.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

constexpr Quality all_qualities[] = {
    {"draft", 16, 0, "off", "auto", "a quick look"},
    {"good", 1024, 0.02, "auto", "auto", "an image to show"},
    {"final", 16384, 0.01, "auto", "none", "without denoising"},
};

const Quality& quality_of(const std::string& name) {
  std::string names;
  for (const Quality& quality : all_qualities) {
    if (name == quality.name) return quality;
    names += (names.empty() ? "" : ", ") + std::string(quality.name);
  }
  throw InputError("unknown quality '" + name + "': it may be " + names);
}

bool leaves_quality_open(const Settings& asked) {
  return asked.samples_per_pixel == 0 && asked.noise == 0 && asked.noise_measure.empty() && asked.denoiser.empty();
}

}  // namespace

std::span<const Quality> qualities() { return all_qualities; }

Settings with_quality(const Settings& asked, const Scene& scene) {
  Settings settings = asked;
  if (settings.quality.empty() && leaves_quality_open(asked)) settings.quality = scene.quality;
  if (settings.quality.empty()) return settings;
  const Quality& quality = quality_of(settings.quality);
  if (settings.samples_per_pixel == 0) settings.samples_per_pixel = quality.samples_per_pixel;
  if (settings.noise == 0 && settings.noise_measure.empty() && quality.noise > 0) {
    settings.noise = quality.noise;
    settings.noise_measure = "display";
  }
  if (settings.denoiser.empty()) settings.denoiser = quality.denoiser;
  return settings;
}

std::string quality_options(const Settings& settings) {
  if (settings.quality.empty()) return {};
  std::string text;
  for (const char* name : {"spp", "noise", "denoise"})
    if (const std::string value = setting_text(settings, name); !value.empty())
      text += (text.empty() ? "--" : " --") + std::string(name) + " " + value;
  return text;
}

}  // namespace alhazen::impl
