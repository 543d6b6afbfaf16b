#pragma once

// Textures of the public interface in the description, and back.

#include "alhazen/textures.h"
#include "api/scene_state.h"

namespace alhazen::impl {

alhazen::Texture public_texture(const SceneState& state, const Texture& texture);

/// Makes `texture`, which may be in the description, what `given` says; what it cannot say stays if the kind does.
/// Throws alhazen::InputError before anything is changed.
void write_texture(SceneState& state, alhazen::Texture given, uint32_t index, Texture& texture);

}  // namespace alhazen::impl
