#pragma once

// Qualities: settings that go together, under one name.

#include <cstdint>
#include <span>
#include <string>

#include "alhazen/alhazen.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// What a quality sets where nothing else is asked.
struct Quality {
  const char* name;
  int64_t samples_per_pixel;  ///< with a noise target, the most
  double noise;               ///< target, of the displayed value; 0: none
  const char* guiding;
  const char* denoiser;
  const char* help;  ///< what it is for, in a few words
};

std::span<const Quality> qualities();

/// Returns `asked` with what its quality, or else that of the scene, sets beside it. A scene's own quality counts only
/// if neither samples nor a noise target nor a denoiser is asked for. Throws InputError for an unknown name.
Settings with_quality(const Settings& asked, const Scene& scene);

/// What the quality of settings set, as options of `alhazen render`; empty without one.
std::string quality_options(const Settings& settings);

}  // namespace alhazen::impl
