#pragma once

// Files that are models, not scenes: without camera and lights, or without any that are meant for a whole scene.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Completes a scene with shapes by a camera that sees all of them, for an image of that aspect ratio (0: that of the
/// film), neutral light and the quality `good`; y is up. Throws InputError if there is nothing to be seen.
void show_as_model(Scene& scene, const std::string& path, double aspect);

/// A mesh alone, in the colours of its vertices if it has any.
Scene model_of(Mesh&& mesh, const std::string& path, double aspect);

}  // namespace alhazen::impl
