#pragma once

// What people call the kinds of a scene's parts.

#include <string>

#include "scene/scene.h"

namespace alhazen::impl {

const char* camera_name(CameraKind kind);
const char* material_kind_name(MaterialKind kind);  ///< "coated_diffuse"
const char* texture_kind_name(TextureKind kind);

/// What it is and its place in the file: "point light, a.pbrt:3:1".
std::string light_name(const Light& light);

}  // namespace alhazen::impl
