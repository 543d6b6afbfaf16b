#pragma once

// The choices that a scene file offers, and the caller's selection.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alhazen {

class InputRecord;

/// Empty options leave the choice to the file. Instead of a name, a number from 0 in the order of SceneListing may be
/// given.
struct ReadOptions {
  std::string camera;
  std::string variant;                   ///< of KHR_materials_variants; empty: the materials without the extension
  std::string animation;                 ///< empty: the first; used only if `time` is given
  std::optional<double> time;            ///< seconds; absent: no animation is applied
  std::vector<std::string> definitions;  ///< Mitsuba: NAME=VALUE for $NAME
  /// Aspect ratio (width over height) of the requested image, used if the file has no camera; 0: none is requested.
  double aspect = 0;
  /// Whether the files that the scene refers to must be in its folder (files/confinement.h).
  bool confine = false;
  /// Records the files that are read; null: none.
  std::shared_ptr<InputRecord> record = nullptr;
  /// Whether nothing is selected; `confine` and `record` select nothing.
  bool is_default() const { return camera.empty() && variant.empty() && animation.empty() && !time; }
};

struct SceneListing {
  std::vector<std::string> cameras, variants, animations, lights;  ///< names, which may be empty
};

/// The aspect ratio of an image with that many pixels; 0 if either is not given.
inline double aspect_of(int64_t width, int64_t height) {
  return width > 0 && height > 0 ? static_cast<double>(width) / static_cast<double>(height) : 0;
}

}  // namespace alhazen
