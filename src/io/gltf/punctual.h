#pragma once

// Cameras and lights, which nodes place.

#include <string>
#include <vector>

#include "io/gltf/nodes.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen::gltf {

/// Nodes with a camera, in the order of drawing, and their names: that of the node, else that of the camera.
struct CameraNode {
  uint32_t node = 0, camera = 0;
  std::string name;
};
std::vector<CameraNode> camera_nodes(const Document& document, const Nodes& nodes);

/// Sets camera and size of the picture. `choice` is a name or a number, empty for the first. False where there is none.
/// Throws InputError where `choice` fits nothing.
bool set_camera(const Document& document, const Nodes& nodes, const std::string& choice, Scene& scene);

/// The index of `choice` (a name, else a number) among `names`. Throws InputError that lists them.
size_t choose(const Document& document, const std::string& choice, const std::vector<std::string>& names,
              const char* what);

/// KHR_lights_punctual. Candela and lux are taken as W / sr and W / m^2 as they stand.
void add_lights(const Document& document, const Nodes& nodes, Scene& scene, std::vector<std::string>* names);

/// A camera before the whole scene, from the front, above and aside, for a picture of that shape (width over height; 0:
/// that of the film).
void fit_camera(Scene& scene, double aspect);

/// White light from everywhere, more of it from above, and from windows: a bright one before and above the scene,
/// others beside and behind it.
void add_neutral_light(Scene& scene);

/// Where the camera stands within closed walls and no light can get in, makes the outermost of them shine by their own
/// colour. False where it does not.
bool light_closed_room(Scene& scene);

}  // namespace alhazen::gltf
