#pragma once

// Material, MakeNamedMaterial, NamedMaterial.

#include <string>

#include "io/pbrt/build.h"

namespace alhazen::pbrt {

/// `Material "kind"`: the material of the shapes that follow.
void set_material(Build& build, const std::string& kind, ParameterList& list);
/// `MakeNamedMaterial "name" "string type" "kind"`.
void define_named_material(Build& build, const std::string& name, ParameterList& list);
/// `NamedMaterial "name"`, which may be defined later.
void use_named_material(Build& build, const std::string& name, const Place& place);

/// The material of a shape: the current one, or the diffuse one of reflectance 0.5 where none was set.
uint32_t current_material(Build& build);

}  // namespace alhazen::pbrt
