#pragma once

// Other materials in a compiled scene.

#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Gives a scene that was compiled for several images the values of the materials and textures of `description`, which
/// has the same images, shapes and lights as it had then. Nothing is built again. Returns false, with the scene as it
/// was, where that does not do: if surfaces begin or cease to be one-sided, to have an opacity or to use uv, if
/// textures of lights or names that layers show change, or if the scene is in another render space. Throws InputError
/// as compile_scene does.
template <class Real>
bool update_materials(const Scene& description, CompiledScene<Real>& scene);

}  // namespace alhazen::impl
