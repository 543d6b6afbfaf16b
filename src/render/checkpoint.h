#pragma once

// The state of a render on disk, so that it can go on later and end in the same bits.

#include <cstdint>
#include <string>

#include "compile/compiled_scene.h"
#include "render/film.h"
#include "render/settings.h"

namespace alhazen {

/// A hash over everything that decides the picture; scenes that differ differ in it.
template <class Real>
uint64_t scene_fingerprint(const CompiledScene<Real>& scene);

/// Refuses a checkpoint that could not be saved, or whose saving would destroy what is in the file: a render that is to
/// be resumed, or a file that is none. Leaves everything as it is. Throws InputError.
void check_checkpoint(const RenderSettings& settings);

/// The file is a header, the planes of the film, and a CRC-32 of both. The header has a CRC-32 of its own, so that a
/// damaged file is told from one of another render.
class CheckpointFile {
 public:
  CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint);

  /// Writes the film whole or not at all. Every pixel of it holds whole blocks of samples, and samples_done of them or
  /// more: more where a pass was stopped. Throws WriteError.
  template <class Real>
  void save(Film<Real>& film, uint32_t samples_done) const;

  /// Reads the film and returns how many samples every pixel of it holds. Throws InputError where the file is missing,
  /// damaged, of another render, or holds more samples than the settings ask for.
  template <class Real>
  uint32_t load(Film<Real>& film) const;

 private:
  std::string path_;
  uint64_t fingerprint_;  ///< of scene and settings
  uint32_t samples_per_pixel_;
};

}  // namespace alhazen
