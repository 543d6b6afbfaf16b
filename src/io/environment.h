#pragma once

// Environment maps: images of the whole sphere of directions, used as light.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads an image as linear floats: 8-bit ones are decoded from sRGB; negative values become 0. Throws InputError that
/// names the file if it is not an image.
ImageTexels read_environment(const InputPath& path);

/// Why `map` cannot be an environment map, and what to do; empty if it can.
std::string environment_fault(const ImageTexels& map);

/// Irradiance by luminance, W / m^2, from the map on a plane whose normal is the map's +z.
double upward_irradiance(const ImageTexels& map);

/// Lights `scene` by the map of file `path` instead of its infinite lights: the map's top is towards +y, its centre
/// towards -z, and the scene's camera sees it without mirroring. Throws InputError.
void use_environment(Scene& scene, const InputPath& path);
/// The same by a map in memory, in which environment_fault() finds none; `name` is for messages.
void use_environment(Scene& scene, ImageTexels&& map, const std::string& name);

/// Takes all infinite lights out of a scene.
void remove_infinite_lights(Scene& scene);

}  // namespace alhazen::impl
