#pragma once

// The directives that change the current transformation matrix (CTM).

#include "io/pbrt/build.h"
#include "io/pbrt/lexer.h"

namespace alhazen::impl::pbrt {

void set_identity(Build& build, Lexer& lexer, const Place& place);
void translate(Build& build, Lexer& lexer, const Place& place);
void scale(Build& build, Lexer& lexer, const Place& place);
void rotate(Build& build, Lexer& lexer, const Place& place);
void look_at(Build& build, Lexer& lexer, const Place& place);
void set_transform(Build& build, Lexer& lexer, const Place& place);
void concat_transform(Build& build, Lexer& lexer, const Place& place);
void name_coordinate_system(Build& build, Lexer& lexer, const Place& place);
void use_coordinate_system(Build& build, Lexer& lexer, const Place& place);
void set_active_transform(Build& build, Lexer& lexer, const Place& place);
void set_transform_times(Build& build, Lexer& lexer, const Place& place);

}  // namespace alhazen::impl::pbrt
