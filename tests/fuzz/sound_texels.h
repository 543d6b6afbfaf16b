#pragma once

// The conditions that every image from a decoder must satisfy, whatever the file.

#include <cstdlib>

#include "scene/scene.h"

namespace alhazen::impl::fuzzing {

inline void require(bool condition) {
  if (!condition) std::abort();
}

inline void require_sound(const ImageTexels& texels) {
  require(texels.width > 0 && texels.height > 0 && (texels.channels == 1 || texels.channels == 3));
  const size_t values =
      static_cast<size_t>(texels.width) * static_cast<size_t>(texels.height) * static_cast<size_t>(texels.channels);
  require(texels.bytes.empty() != texels.floats.empty());
  require(texels.bytes.size() + texels.floats.size() == values);
}

}  // namespace alhazen::impl::fuzzing
