#pragma once

// Scene texts for the tests of the reader.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/pbrt/pbrt.h"

namespace alhazen::impl::test {

struct Parsed {
  Scene scene;
  Diagnostics diagnostics;

  /// Returns whether one of the warnings contains `text`.
  bool warned(const std::string& text) const {
    for (const Diagnostics::Warning& warning : diagnostics.warnings())
      if (warning.to_string().find(text) != std::string::npos) return true;
    return false;
  }
};

inline Parsed parse(const std::string& text, const std::string& folder = "no-such-folder") {
  Parsed parsed;
  parsed.scene = parse_pbrt(text, "test.pbrt", folder, parsed.diagnostics);
  return parsed;
}

/// Parses `text` after WorldBegin.
inline Parsed parse_world(const std::string& text, const std::string& folder = "no-such-folder") {
  return parse("WorldBegin\n" + text, folder);
}

/// The message of the error from parsing, empty if there is none.
inline std::string error_of(const std::string& text, const std::string& folder = "no-such-folder") {
  try {
    parse(text, folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline void expect_near(const Vec3d& actual, const Vec3d& expected, double tolerance = 1e-12) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

inline const std::vector<Shape>& shapes(const Parsed& parsed) { return parsed.scene.groups[0].shapes; }
inline const Material& material_of(const Parsed& parsed, const Shape& shape) {
  return parsed.scene.materials[shape.material];
}
inline Vec3d constant_of(const Parsed& parsed, uint32_t texture) {
  EXPECT_LT(texture, parsed.scene.textures.size());
  const Texture& node = parsed.scene.textures.at(texture);
  EXPECT_EQ(node.kind, TextureKind::constant);
  return node.value;
}

}  // namespace alhazen::impl::test
