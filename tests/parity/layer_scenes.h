#pragma once

// A small scene that the tests of layers look at, and the channels of what they render.

#include <algorithm>
#include <string>
#include <vector>

#include "parity/engines.h"
#include "parity/scenes.h"

namespace alhazen::impl::test {

/// The values of a channel, row by row.
inline std::vector<double> plane(const Outcome& outcome, const std::string& channel) {
  const auto found = std::find(outcome.channels.begin(), outcome.channels.end(), channel);
  EXPECT_NE(found, outcome.channels.end()) << channel;
  const size_t width = static_cast<size_t>(outcome.width), channels = outcome.channels.size(),
               c = static_cast<size_t>(found - outcome.channels.begin());
  std::vector<double> values;
  for (size_t y = 0; y < static_cast<size_t>(outcome.height) && c < channels; ++y)
    for (size_t x = 0; x < width; ++x)
      values.push_back(static_cast<double>(outcome.rows[(y * channels + c) * width + x]));
  return values;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

inline double min(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
inline double max(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Looks along +y, x to the right and z up, at an area of 2 x 2 units at distance 4, under a white sky.
inline Scene seen(const std::string& world, const std::string& head = "") {
  return scene_of(head + R"(Scale -1 1 1
LookAt 0 0 0  0 1 0  0 0 1
Camera "perspective" "float fov" 28.072486935852957
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
)" + world);
}

/// A rectangle at y = 4 that faces the camera.
inline std::string rectangle(double x0, double x1, double z0, double z1, const std::string& more = "") {
  const auto corner = [](double x, double z) { return std::to_string(x) + " 4 " + std::to_string(z) + "  "; };
  return "Shape \"trianglemesh\" \"point3 P\" [ " + corner(x0, z0) + corner(x1, z0) + corner(x1, z1) + corner(x0, z1) +
         "] \"integer indices\" [ 0 1 2 0 2 3 ] \"point2 uv\" [ 0 0 1 0 1 1 0 1 ] " + more + "\n";
}

inline Settings serial(std::vector<std::string> aovs = {}) {
  Settings settings;
  settings.backend = "serial";
  settings.samples_per_pixel = 16;
  settings.aovs = std::move(aovs);
  return settings;
}

}  // namespace alhazen::impl::test
