#pragma once

// Messages speak of options of the command line; a program has set members of Settings.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/warning.h"

namespace alhazen::impl {

/// The member of Settings, or argument of the library, that an option is called: `samples_per_pixel` of `spp`. Empty
/// for options that programs have nothing like.
std::string field_of_option(std::string_view option);

/// The same message about fields: `'fov' must be a number` of `--fov must be a number`.
std::string with_field_names(const std::string& message);
std::vector<Warning> with_field_names(std::vector<Warning> warnings);

}  // namespace alhazen::impl
