#pragma once

// What the tests of sessions of views share.

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "view/fake_viewers.h"

namespace alhazen::impl::test {

using nlohmann::json;

inline const std::string scenes = std::string(ALHAZEN_SOURCE_DIR) + "/scenes/";

inline ViewOptions options_of(const std::string& scene, int width = 96, int height = 54, int64_t samples = 8) {
  ViewOptions options;
  options.scene = scenes + scene;
  options.settings.width = width;
  options.settings.height = height;
  options.settings.samples_per_pixel = samples;
  return options;
}

inline bool is_final(const json& header) { return header["final"].get<bool>(); }
inline bool is_any(const json&) { return true; }

inline PageCamera camera_at(double angle) {
  return {{6 * std::sin(angle), 1.5, 6 * std::cos(angle)}, {0, 1, 0}, {0, 1, 0}, 40, 0, {}};
}

/// What the library renders of a scene seen by such a camera.
inline RenderedImage rendered(const ViewOptions& options, const std::optional<PageCamera>& camera,
                              const std::vector<std::string>& layers = {}) {
  ::alhazen::Scene scene = ::alhazen::Scene::load(options.scene, options.load);
  if (camera) scene.set_camera(placed_camera(scene.camera(), *camera));
  Settings settings = options.settings;
  settings.aovs = layers;
  return ::alhazen::render(scene, settings);
}

inline void expect_same_bits(const DecodedFrame& frame, const RenderedImage& image) {
  const auto& channels = frame.header["channels"];
  for (size_t c = 0; c < channels.size(); ++c) {
    const float* const plane = image.plane(channels[c]);
    ASSERT_NE(plane, nullptr) << channels[c];
    for (size_t i = 0; i < frame.planes[c].size(); ++i)
      ASSERT_EQ(frame.planes[c][i], std::bit_cast<uint32_t>(plane[i])) << channels[c] << " " << i;
  }
}

inline void want(FakeView& view, ViewerId viewer, const std::vector<std::string>& layers, bool exact = true) {
  view.send(viewer, {{"type", "layers"}, {"layers", layers}, {"exact", exact}});
}

}  // namespace alhazen::impl::test
