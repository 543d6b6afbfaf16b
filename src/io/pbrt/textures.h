#pragma once

// Textures, and the parameters of materials that take textures.

#include <optional>

#include "io/pbrt/build.h"
#include "io/pbrt/colours.h"

namespace alhazen::impl::pbrt {

/// `Texture "name" "float|spectrum" "kind"`.
void add_texture(Build& build, const std::string& name, const std::string& value_type, const std::string& kind,
                 ParameterList& list);

/// The spectrum texture of parameter `name`: a named texture or a constant colour; no_index if absent.
uint32_t colour_texture(Build& build, ParameterList& list, std::string_view name, ColourUse use);
/// The same with a constant if absent.
uint32_t colour_texture_or(Build& build, ParameterList& list, std::string_view name, ColourUse use, double fallback);

/// The float texture of parameter `name`; no_index if absent.
uint32_t scalar_texture(Build& build, ParameterList& list, std::string_view name);
uint32_t scalar_texture_or(Build& build, ParameterList& list, std::string_view name, double fallback);

/// The value of a texture if it is constant.
std::optional<double> constant_value(const Build& build, uint32_t texture);

}  // namespace alhazen::impl::pbrt
