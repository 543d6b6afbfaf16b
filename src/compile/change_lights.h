#pragma once

// The part of update_scene that makes the records of lights again.

#include <cstdint>
#include <vector>

#include "compile/built_parts.h"
#include "compile/move_shapes.h"

namespace alhazen::impl {

/// Makes the records of all lights of `outline`, and how they are chosen among. `emitters` are the shapes of the world
/// that emit, by their place among all placements. `is_new`, by light of shapes, says whose measure must be computed
/// again. Returns false where a map is needed that neither the scene nor `outline` has.
template <class Real>
bool change_lights(const std::vector<MovedShape>& emitters, const std::vector<uint8_t>& is_new, Scene& outline,
                   CompiledScene<Real>& scene, BuiltParts<Real>& parts);

}  // namespace alhazen::impl
