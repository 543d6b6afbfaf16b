#pragma once

// What may be chosen of a scene file that offers a choice, and what it offers.

#include <optional>
#include <string>
#include <vector>

namespace alhazen {

/// Empty ones are left to the file. Names may be numbers too, which count from 0 in the order of SceneListing.
struct ReadOptions {
  std::string camera;
  std::string variant;         ///< of KHR_materials_variants; empty: the first
  std::string animation;       ///< empty: the first; `time` says whether any
  std::optional<double> time;  ///< seconds; absent: nothing is animated
  bool is_default() const { return camera.empty() && variant.empty() && animation.empty() && !time; }
};

struct SceneListing {
  std::vector<std::string> cameras, variants, animations, lights;  ///< names, empty where they have none
};

}  // namespace alhazen
