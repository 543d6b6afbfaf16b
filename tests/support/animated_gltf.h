#pragma once

// A small glTF scene with animations: node 0 is a green triangle with a morph target, node 1 a camera four units before
// it, node 2 a distant light.

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace alhazen::impl::test {

struct AnimatedChannel {
  int node;
  std::string path;           ///< translation, rotation, scale or weights
  std::vector<float> times;   ///< of the keyframes, seconds
  std::vector<float> values;  ///< of all keyframes
  std::string interpolation = "LINEAR";
};

/// Writes NAME.gltf and NAME.bin. `emission` makes the triangle emit.
inline void write_animated_gltf(const TemporaryFolder& folder, const std::string& name,
                                const std::vector<AnimatedChannel>& channels, float emission = 0) {
  using Json = nlohmann::json;
  Bytes bytes;
  Json accessors = Json::array(), views = Json::array();
  const auto add = [&](const std::vector<float>& numbers, const std::string& type, size_t components) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", numbers.size() * 4}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", 5126},
                         {"count", numbers.size() / components},
                         {"type", type}});
    bytes.resize(bytes.size() + numbers.size() * 4);
    std::memcpy(bytes.data() + bytes.size() - numbers.size() * 4, numbers.data(), numbers.size() * 4);
    return accessors.size() - 1;
  };
  add({-1, -1, 0, 1, -1, 0, 0, 1, 0}, "VEC3", 3);
  add({0, 0, 0, 0, 0, 0, 1, 0, 0}, "VEC3", 3);
  Json samplers = Json::array(), targets = Json::array();
  for (const AnimatedChannel& channel : channels) {
    const size_t components = channel.path == "rotation" ? 4 : channel.path == "weights" ? 1 : 3;
    const std::string type = components == 4 ? "VEC4" : components == 1 ? "SCALAR" : "VEC3";
    const size_t input = add(channel.times, "SCALAR", 1), output = add(channel.values, type, components);
    targets.push_back({{"sampler", samplers.size()}, {"target", {{"node", channel.node}, {"path", channel.path}}}});
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", channel.interpolation}});
  }
  Json scene{
      {"asset", {{"version", "2.0"}}},
      {"extensionsUsed", {"KHR_lights_punctual"}},
      {"extensions", {{"KHR_lights_punctual", {{"lights", {{{"type", "directional"}, {"intensity", 3}}}}}}}},
      {"buffers", {{{"uri", name + ".bin"}, {"byteLength", bytes.size()}}}},
      {"bufferViews", views},
      {"accessors", accessors},
      {"materials",
       {{{"doubleSided", true},
         {"emissiveFactor", {emission, emission, emission}},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}, {"metallicFactor", 0}}}}}},
      {"meshes",
       {{{"weights", {0}},
         {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}, {"targets", {{{"POSITION", 1}}}}}}}}}},
      {"cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}}},
      {"nodes",
       {{{"mesh", 0}},
        {{"camera", 0}, {"translation", {0, 0, 4}}},
        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}}}};
  if (!channels.empty()) scene["animations"] = {{{"samplers", samplers}, {"channels", targets}}};
  folder.write(name + ".bin", bytes);
  folder.write_text(name + ".gltf", scene.dump(1));
}

}  // namespace alhazen::impl::test
