#pragma once

// Renders in this process and compares results bitwise.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "compile/compile_scene.h"
#include "io/pbrt/pbrt.h"
#include "render/renderer.h"

namespace alhazen::impl::test {

/// All layers that every integrator can write.
inline const std::vector<std::string> all_aovs{"alpha",    "albedo",      "normal",  "camera_normal", "depth",
                                               "distance", "position",    "uv",      "motion",        "object",
                                               "material", "cryptomatte", "bounces", "samples",       "variance"};

/// With names of objects and materials, which layers need.
inline CompileOptions naming(CompileOptions options) {
  options.names_objects = true;
  return options;
}

struct Outcome {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> rows;      ///< all channels of row 0, all of row 1, ...
  std::vector<uint8_t> planes;  ///< the film's sums in its own precision
  RenderStatistics statistics;
};

inline Outcome outcome_of(const Rendering& rendering) {
  Outcome outcome;
  const ImageSource source = rendering.source();
  outcome.width = source.width;
  outcome.height = source.height;
  outcome.channels = source.channels;
  outcome.statistics = rendering.statistics;
  const size_t row = source.channels.size() * static_cast<size_t>(source.width);
  outcome.rows.resize(row * static_cast<size_t>(source.height));
  for (int y = 0; y < source.height; ++y)
    source.fill_row(y, std::span(outcome.rows).subspan(static_cast<size_t>(y) * row, row));
  std::visit(
      [&](const auto& film) {
        film->visit_planes([&](const void* data, size_t size) {
          const auto* bytes = static_cast<const uint8_t*>(data);
          outcome.planes.insert(outcome.planes.end(), bytes, bytes + size);
        });
      },
      rendering.film);
  return outcome;
}

inline Outcome render_bits(Scene scene, const Settings& settings, const ProgressFunction& progress = {}) {
  Diagnostics diagnostics;
  const RenderSettings resolved = resolve_settings(settings, scene);
  return outcome_of(render_scene(std::move(scene), resolved, 0, RenderEvents{progress, {}, {}}, diagnostics));
}

inline Scene scene_of(const std::string& text) {
  Diagnostics diagnostics;
  Scene scene = parse_pbrt(text, "test.pbrt", "", diagnostics);
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().to_string();
  return scene;
}

/// Succeeds if both have the same bits; otherwise the message names the first difference.
inline ::testing::AssertionResult same_bits(const Outcome& a, const Outcome& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    return ::testing::AssertionFailure() << "sizes or channels differ";
  const size_t width = static_cast<size_t>(a.width), row = width * a.channels.size();
  size_t differing = 0, first = 0;
  for (size_t i = 0; i < a.rows.size(); ++i) {
    if (std::memcmp(&a.rows[i], &b.rows[i], sizeof(float)) == 0) continue;
    if (differing++ == 0) first = i;
  }
  if (differing > 0)
    return ::testing::AssertionFailure() << differing << " of " << a.rows.size() << " values differ; the first is "
                                         << a.channels[first % row / width] << " of pixel " << first % width << ", "
                                         << first / row << ": " << a.rows[first] << " and " << b.rows[first];
  if (a.planes != b.planes)
    return ::testing::AssertionFailure() << "the images are equal, but not the sums from which they are computed";
  return ::testing::AssertionSuccess();
}

}  // namespace alhazen::impl::test
