#pragma once

// What may be chosen of a scene file that offers a choice, and what it offers.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alhazen {

class InputRecord;

/// Empty ones are left to the file. Names may be numbers too, which count from 0 in the order of SceneListing.
struct ReadOptions {
  std::string camera;
  std::string variant;         ///< of KHR_materials_variants; empty: materials as without the extension
  std::string animation;       ///< empty: the first; `time` says whether any
  std::optional<double> time;  ///< seconds; absent: nothing is animated
  /// Width over height of the picture that is asked for, which counts where the file has no camera; 0: nothing is
  /// asked.
  double aspect = 0;
  /// Whether the files that the scene names must lie in its folder (files/confinement.h).
  bool confine = false;
  /// Where the files that are read are noted; null: nowhere.
  std::shared_ptr<InputRecord> record = nullptr;
  /// Whether nothing is chosen; `confine` and `record` choose nothing of what the file offers.
  bool is_default() const { return camera.empty() && variant.empty() && animation.empty() && !time; }
};

struct SceneListing {
  std::vector<std::string> cameras, variants, animations, lights;  ///< names, empty where they have none
};

/// Of a picture of that many pixels; 0 where either is not given.
inline double aspect_of(int64_t width, int64_t height) {
  return width > 0 && height > 0 ? static_cast<double>(width) / static_cast<double>(height) : 0;
}

}  // namespace alhazen
