#pragma once

// The choices that a scene file offers, and the caller's selection.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/find_file.h"

namespace alhazen::impl {

/// Empty options leave the choice to the file. Instead of a name, a number from 0 in the order of SceneListing may be
/// given.
struct ReadOptions {
  std::string camera;
  std::string variant;                        ///< of KHR_materials_variants; empty: the materials without the extension
  std::string animation;                      ///< empty: the first; used only if `time` is given
  std::optional<double> time;                 ///< seconds, when the shutter opens; absent: no animation is applied
  std::vector<std::string> definitions = {};  ///< Mitsuba: NAME=VALUE for $NAME
  /// Aspect ratio (width over height) of the requested image, used if the file has no camera; 0: none is requested.
  double aspect = 0;
  /// Whether the files that the scene refers to must be in its folder (files/confinement.h).
  bool confine = false;
  /// Records the files that are read; null: none.
  std::shared_ptr<InputRecord> record = nullptr;
  /// For how many seconds the shutter is open; absent: as the file says, or 0.
  std::optional<double> shutter_seconds = std::nullopt;
  FileSearch search = {};
  /// Whether nothing is selected that glTF files alone offer.
  bool is_default() const { return camera.empty() && variant.empty() && animation.empty(); }
  bool has_motion_blur() const { return shutter_seconds && *shutter_seconds > 0; }
};

struct SceneListing {
  std::vector<std::string> cameras, variants, animations, lights;  ///< names, which may be empty
};

/// The aspect ratio of an image with that many pixels; 0 if either is not given.
inline double aspect_of(int64_t width, int64_t height) {
  return width > 0 && height > 0 ? static_cast<double>(width) / static_cast<double>(height) : 0;
}

}  // namespace alhazen::impl
