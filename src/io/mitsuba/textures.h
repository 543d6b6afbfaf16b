#pragma once

// Textures, and parameters that may be textures.

#include "io/mitsuba/colours.h"

namespace alhazen::impl::mitsuba {

/// The texture of property `name`, constant if it is a colour; `fallback` if there is none.
uint32_t colour_texture(Build& build, ObjectReader& reader, std::string_view name, ColourUse use,
                        const Vec3d& fallback);

/// The same for a number, which is the luminance of a texture with colours.
uint32_t scalar_texture(Build& build, ObjectReader& reader, std::string_view name, double fallback);

/// The texture that is nested without a certain name, as scalar or as colour; no_index if there is none.
uint32_t nested_texture(Build& build, ObjectReader& reader, bool is_scalar);

/// The value of a texture that is constant; absent for others.
std::optional<Vec3d> constant_value(const Build& build, uint32_t texture);

/// The product of both; one that is 1 everywhere is left out.
uint32_t product(Build& build, uint32_t a, uint32_t b);

}  // namespace alhazen::impl::mitsuba
