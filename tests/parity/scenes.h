#pragma once

// The two scenes of the parity tests, read once.

#include "io/images/image.h"
#include "support/bits.h"
#include "support/scene_files.h"
#include "support/temporary_folder.h"

namespace alhazen::testing {

/// Wider than a tile and not a multiple of one in either direction.
inline constexpr int parity_width = 20, parity_height = 17;

inline Scene read_spheres() {
  const TemporaryFolder folder;
  const Image image{3, 2, {"R", "G", "B"}, {{1, 0, 0, 1, 0, 1}, {0, 1, 0, 1, 1, 0}, {0, 0, 1, 0, 1, 1}}};
  write_png(folder.file("photo.png"), source_of(image), {});
  return scene_of(many_spheres(parity_width, parity_height, folder.file("photo.png")));
}

inline const Scene& parity_scene(const std::string& name) {
  if (name == "cornell") {
    static const Scene cornell = scene_of(cornell_box(parity_height));
    return cornell;
  }
  static const Scene spheres = read_spheres();
  return spheres;
}

}  // namespace alhazen::testing
