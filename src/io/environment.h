#pragma once

// Environment maps: pictures of the whole sphere, read as light.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen {

/// A picture in linear floats: 8-bit ones are decoded from sRGB; negative values become 0. Throws InputError that names
/// the file where it is no picture.
ImageTexels read_environment(const InputPath& path);

/// Why `map` cannot be an environment map, and what to do; empty where it can.
std::string environment_fault(const ImageTexels& map);

/// Irradiance by luminance, W / m^2, that the map makes on a plane whose normal is the map's +z.
double upward_irradiance(const ImageTexels& map);

/// Lights `scene` by the map of file `path` instead of by its infinite lights: the map's top is towards +y, its middle
/// towards -z, and the camera of the scene sees it as it is, not mirrored. Throws InputError.
void use_environment(Scene& scene, const InputPath& path);

}  // namespace alhazen
