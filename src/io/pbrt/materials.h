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

/// The same with the `alpha` of a shape, and with what the medium inside it absorbs.
uint32_t material_of_shape(Build& build, uint32_t alpha, const Place& place);

/// `MakeNamedMedium`: kept where all that it does is to absorb.
void define_named_medium(Build& build, const std::string& name, ParameterList& list);
/// `MediumInterface`.
void set_medium_interface(Build& build, const std::string& inside, const std::string& outside, const Place& place);

/// What had to wait until all materials were defined.
void finish_materials(Build& build);

}  // namespace alhazen::pbrt
