#pragma once

// Reads the parameter list after the name of a directive.

#include "io/pbrt/lexer.h"
#include "io/pbrt/parameters.h"

namespace alhazen::impl::pbrt {

/// Adds every parameter up to the next directive to `list`.
void parse_parameters(Lexer& lexer, const std::string& rgb_space, ParameterList& list);

}  // namespace alhazen::impl::pbrt
