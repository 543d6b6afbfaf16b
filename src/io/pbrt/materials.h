#pragma once

// Material, MakeNamedMaterial, NamedMaterial.

#include <string>

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

/// `Material "kind"`: the material of subsequent shapes.
void set_material(Build& build, const std::string& kind, ParameterList& list);
/// `MakeNamedMaterial "name" "string type" "kind"`.
void define_named_material(Build& build, const std::string& name, ParameterList& list);
/// `NamedMaterial "name"`, which may be defined later.
void use_named_material(Build& build, const std::string& name, const Place& place);

/// The material of a shape: the current one, or a diffuse one with reflectance 0.5 if none is set.
uint32_t current_material(Build& build);

/// The same with the `alpha` of a shape, and with the absorption of the medium inside it.
uint32_t material_of_shape(Build& build, uint32_t alpha, const Place& place);

/// `MakeNamedMedium`: stored if it only absorbs.
void define_named_medium(Build& build, const std::string& name, ParameterList& list);
/// `MediumInterface`.
void set_medium_interface(Build& build, const std::string& inside, const std::string& outside, const Place& place);

/// Completes materials after all of them are defined.
void finish_materials(Build& build);

}  // namespace alhazen::impl::pbrt
