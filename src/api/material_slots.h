#pragma once

// Materials of the public interface in the description, and back.

#include "alhazen/materials.h"
#include "api/scene_state.h"

namespace alhazen::impl {

alhazen::Material public_material(const SceneState& state, const Material& material);

/// Makes `material`, which may be in the description, what `given` says; what it cannot say stays if the kind does.
/// Throws alhazen::InputError before anything is changed.
void write_material(SceneState& state, alhazen::Material given, Material& material);

}  // namespace alhazen::impl
