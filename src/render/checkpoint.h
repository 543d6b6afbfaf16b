#pragma once

// The state of a render on disk, so that it can be continued later and give the same bits.

#include <cstdint>
#include <string>

#include "compile/compiled_scene.h"
#include "render/film.h"
#include "render/guiding.h"
#include "render/settings.h"

namespace alhazen::impl {

/// A hash over the compiled scene, its BVHs too. CheckpointFile adds the settings that determine samples.
template <class Real>
uint64_t scene_fingerprint(const CompiledScene<Real>& scene);

/// Refuses a checkpoint that could not be saved, or that would overwrite a render that could be resumed or a file that
/// is no checkpoint. Changes nothing. Throws InputError.
void check_checkpoint(const RenderSettings& settings);

/// The file consists of a header, the settings as text, the planes of the film, with guiding what it has learned, and a
/// CRC-32 of all. The header has a
/// CRC-32 of its own, so that a damaged file is distinguished from a checkpoint of another render.
class CheckpointFile {
 public:
  CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint);

  /// Writes the film completely or not at all. Every pixel holds complete blocks of samples, at least `samples_done`;
  /// more if a pass was stopped. Throws WriteError.
  template <class Real>
  void save(Film<Real>& film, uint32_t samples_done, const Guiding<Real>* guiding = nullptr) const;

  /// Reads the film and returns the number of samples that every pixel holds. Throws InputError if the file is missing,
  /// damaged, of another render, or holds more samples than the settings request.
  template <class Real>
  uint32_t load(Film<Real>& film, Guiding<Real>* guiding = nullptr) const;

 private:
  std::string path_;
  std::string settings_;  ///< those that determine samples, as text
  uint64_t fingerprint_;  ///< of scene and settings
  uint32_t samples_per_pixel_;
};

}  // namespace alhazen::impl
