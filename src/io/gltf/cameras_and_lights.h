#pragma once

// Cameras and lights, which are placed by nodes.

#include <string>
#include <vector>

#include "io/gltf/nodes.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen::impl::gltf {

/// Nodes with a camera, in the order of traversal, with their names: that of the node, else that of the camera.
struct CameraNode {
  uint32_t node = 0, camera = 0;
  std::string name;
};
std::vector<CameraNode> camera_nodes(const Document& document, const Nodes& nodes);

/// Sets the camera and the image size. `choice` is a name or a number, empty for the first. Returns false if there is
/// no camera. Throws InputError if none fits `choice`.
bool set_camera(const Document& document, const Nodes& nodes, const std::string& choice, Scene& scene);

/// The index of `choice` (a name, else a number) among `names`. Throws InputError that lists them.
size_t choose(const Document& document, const std::string& choice, const std::vector<std::string>& names,
              const char* what);

/// Adds the lights of KHR_lights_punctual. Candela and lux are taken as W / sr and W / m^2 without conversion.
void add_lights(const Document& document, const Nodes& nodes, Scene& scene, std::vector<std::string>* names);

/// If the camera is inside closed walls and no light can enter, makes the outermost walls emit light of their own
/// colour. Returns whether it did.
bool light_closed_room(Scene& scene);

}  // namespace alhazen::impl::gltf
