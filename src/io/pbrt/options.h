#pragma once

// The directives before WorldBegin: Camera, Film, PixelFilter, Sampler, Integrator, Option.

#include <string>

#include "io/pbrt/build.h"
#include "io/pbrt/lexer.h"

namespace alhazen::impl::pbrt {

void set_camera(Build& build, const std::string& kind, ParameterList& list);
/// Field of view in degrees over the shorter side of the film, of the realistic camera in the file.
double realistic_fov(const Build& build);
void set_film(Build& build, const std::string& kind, ParameterList& list);
void set_filter(Build& build, const std::string& kind, ParameterList& list);
void set_sampler(Build& build, const std::string& kind, ParameterList& list);
void set_integrator(Build& build, const std::string& kind, ParameterList& list);
void ignore_accelerator(Build& build, const std::string& kind, ParameterList& list);

/// `Option "name" value`.
void set_option(Build& build, Lexer& lexer, const Place& place);

}  // namespace alhazen::impl::pbrt
