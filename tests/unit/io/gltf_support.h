#pragma once

// glTF files written by tests.

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/gltf/gltf.h"

namespace alhazen::impl::test {

using nlohmann::json;

inline std::string base64(const std::vector<uint8_t>& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

struct ParsedGltf {
  Scene scene;
  Diagnostics diagnostics;
  bool warned(const std::string& text) const {
    for (const Diagnostics::Warning& warning : diagnostics.warnings())
      if (warning.to_string().find(text) != std::string::npos) return true;
    return false;
  }
  const std::vector<Shape>& shapes() const { return scene.groups[0].shapes; }
  const Mesh& mesh(size_t shape = 0) const { return scene.meshes.at(shapes().at(shape).mesh); }
  const Material& material(size_t shape = 0) const { return scene.materials.at(shapes().at(shape).material); }
  const Texture& texture(uint32_t index) const { return scene.textures.at(index); }
};

inline ParsedGltf parse_text(const std::string& text, const ReadOptions& options = {},
                             const std::string& folder = "no-such-folder") {
  ParsedGltf parsed;
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  parsed.scene = parse_gltf({bytes, text.size()}, "test.gltf", folder, options, parsed.diagnostics);
  return parsed;
}

/// The message of the error from parsing, empty if there is none.
inline std::string error_of_gltf(const std::string& text, const ReadOptions& options = {},
                                 const std::string& folder = "no-such-folder") {
  try {
    parse_text(text, options, folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// A file under construction: JSON that can be changed freely, and the bytes of its one buffer.
struct GltfFile {
  json root{{"asset", {{"version", "2.0"}}}};
  std::vector<uint8_t> data;

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (data.size() % 4 != 0) data.push_back(0);
    const size_t offset = data.size();
    const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
    data.insert(data.end(), bytes, bytes + values.size() * sizeof(T));
    json description{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", data.size() - offset}};
    if (stride > 0) description["byteStride"] = stride;
    root["bufferViews"].push_back(description);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  template <class T>
  static int component_type() {
    if (std::is_same_v<T, int8_t>) return 5120;
    if (std::is_same_v<T, uint8_t>) return 5121;
    if (std::is_same_v<T, int16_t>) return 5122;
    if (std::is_same_v<T, uint16_t>) return 5123;
    if (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
  }

  int add_accessor(json description) {
    root["accessors"].push_back(std::move(description));
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  /// Adds an accessor of tightly packed values in a view of its own.
  template <class T>
  int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type[3] - '0');
    json description{{"bufferView", view(values)},
                     {"componentType", component_type<T>()},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) description["normalized"] = true;
    return add_accessor(description);
  }

  /// Adds a mesh of one primitive and returns its index.
  int add_mesh(json primitive) {
    root["meshes"].push_back({{"primitives", json::array({std::move(primitive)})}});
    return static_cast<int>(root["meshes"].size()) - 1;
  }

  int add_node(json node) {
    root["nodes"].push_back(std::move(node));
    return static_cast<int>(root["nodes"].size()) - 1;
  }

  /// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0), with uvs, as a primitive.
  json triangle() {
    json primitive;
    primitive["attributes"]["POSITION"] = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    primitive["attributes"]["TEXCOORD_0"] = accessor<float>({0, 1, 1, 1, 0, 0}, "VEC2");
    return primitive;
  }

  /// The triangle with a material, on a node.
  void add_triangle_of(json material) {
    root["materials"].push_back(std::move(material));
    json primitive = triangle();
    primitive["material"] = root["materials"].size() - 1;
    add_node({{"mesh", add_mesh(primitive)}});
  }

  /// A texture with an image of 1 x 2 pixels, white above black; with alpha 255 above 0 on request.
  int add_texture(bool has_alpha = false, json sampler = {}) {
    const std::string opaque =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAACCAIAAAAW4yFwAAAAEElEQVR4nGP4//8/AwMDAwAR9gL+3Q4KRgAAAABJRU5ErkJggg==";
    const std::string transparent =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAACCAYAAACZgbYnAAAAEklEQVR4nGP4////fwYGBgYGAB3sA/0CYxl2AAAAAElFTkSuQmCC";
    root["images"].push_back({{"uri", "data:image/png;base64," + (has_alpha ? transparent : opaque)}});
    json texture{{"source", root["images"].size() - 1}};
    if (!sampler.is_null()) {
      root["samplers"].push_back(sampler);
      texture["sampler"] = root["samplers"].size() - 1;
    }
    root["textures"].push_back(texture);
    return static_cast<int>(root["textures"].size()) - 1;
  }

  std::string text() {
    if (!data.empty())
      root["buffers"] =
          json::array({{{"byteLength", data.size()}, {"uri", "data:application/octet-stream;base64," + base64(data)}}});
    return root.dump(1);
  }

  /// The same as a .glb file.
  std::string glb() {
    while (data.size() % 4 != 0) data.push_back(0);
    root["buffers"] = json::array({{{"byteLength", data.size()}}});
    std::string text = root.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string file;
    const auto add = [&](uint32_t value) { file.append(reinterpret_cast<const char*>(&value), 4); };
    file += "glTF";
    add(2);
    add(static_cast<uint32_t>(12 + 8 + text.size() + 8 + data.size()));
    add(static_cast<uint32_t>(text.size()));
    file += "JSON" + text;
    add(static_cast<uint32_t>(data.size()));
    file.append("BIN\0", 4);
    file.append(reinterpret_cast<const char*>(data.data()), data.size());
    return file;
  }

  ParsedGltf parse(const ReadOptions& options = {}) { return parse_text(text(), options); }
  std::string error(const ReadOptions& options = {}) { return error_of_gltf(text(), options); }
};

inline void expect_point(const Vec3d& actual, const Vec3d& expected, double tolerance = 1e-6) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

}  // namespace alhazen::impl::test
