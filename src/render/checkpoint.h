#pragma once

// The state of a render on disk, so that it can go on later and end in the same bits.

#include <cstdint>
#include <string>

#include "render/film.h"
#include "render/settings.h"
#include "scene/flat_scene.h"

namespace alhazen {

/// A hash over the geometry and what else decides the picture; scenes that differ differ in it.
template <class Real>
uint64_t scene_fingerprint(const FlatScene<Real>& scene);

class CheckpointFile {
 public:
  CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint);

  /// Writes the film whole or not at all. Throws RenderError.
  template <class Real>
  void save(Film<Real>& film, uint32_t samples_done) const;

  /// Reads the film and returns how many samples a pixel it holds. Throws InputError where the file is missing, damaged
  /// or of another render.
  template <class Real>
  uint32_t load(Film<Real>& film) const;

 private:
  std::string path_;
  uint64_t fingerprint_;  ///< of scene and settings
};

}  // namespace alhazen
