#pragma once

// The part of update_scene that moves shapes and instances.

#include <cstdint>
#include <vector>

#include "compile/built_parts.h"

namespace alhazen::impl {

/// A shape of the world that has moved, by its place among all placements.
struct MovedShape {
  size_t index;
  ShapePlacement placement;
};

/// Writes the records of what has moved, and builds the tree of the world again. `outline` has the meshes of what has
/// moved, which are freed. The lights of these shapes are marked in `is_new_light`. Returns false where other records
/// than before are left out, or something is to be warned of.
template <class Real>
bool move_shapes(const std::vector<MovedShape>& moved, Scene& outline, CompiledScene<Real>& scene,
                 BuiltParts<Real>& parts, std::vector<uint8_t>& is_new_light);

}  // namespace alhazen::impl
