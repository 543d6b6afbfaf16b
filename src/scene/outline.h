#pragma once

#include "scene/scene.h"

namespace alhazen::impl {

/// A copy of a scene without what takes most of its memory: the arrays of meshes, the texels of images and, unless they
/// are asked for, those of environment maps and of the images of lights. All indices keep their meaning.
Scene outline_of(const Scene& scene, bool with_light_maps);

}  // namespace alhazen::impl
