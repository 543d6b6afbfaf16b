#include "io/read_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "core/math/bounds.h"
#include "files/byte_source.h"
#include "files/standard_input.h"
#include "images/image.h"
#include "io/gltf/gltf.h"
#include "io/mitsuba/mitsuba.h"
#include "io/model.h"
#include "io/obj/obj_model.h"
#include "io/pbrt/pbrt.h"
#include "io/ply/ply.h"
#include "io/stl/stl.h"
#include "scene/kind_names.h"
#include "scene/shutter.h"

namespace alhazen::impl {

namespace {

/// The format of formats that begin in a certain way; empty for others.
std::string format_of_content(const InputPath& input) {
  std::array<char, 512> bytes{};
  FileSource file(input);
  std::string_view head(bytes.data(), file.read(bytes.data(), bytes.size()));
  if (head.starts_with("glTF")) return "gltf";
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return "ply";
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  if (head.starts_with("<?xml") || head.starts_with("<scene") || head.starts_with("<!--")) return "xml";
  if (head.starts_with("solid ")) return "stl";
  return {};
}

std::string format_of(const InputPath& input) {
  const std::string& path = input.name;
  std::string extension = extension_of(path);
  if (extension == "gz") extension = extension_of(std::filesystem::path(path).stem().string());
  for (const char* known : {"pbrt", "ply", "xml", "obj", "stl"})
    if (extension == known) return extension;
  if (extension == "gltf" || extension == "glb") return "gltf";
  const std::string format = format_of_content(input);
  if (!format.empty()) return format;
  throw InputError({path},
                   "the format is unknown by this name and by its first bytes: give a .pbrt, .gltf, .glb or .xml "
                   "(Mitsuba) scene, or a .obj, .ply or .stl model (all but glTF also as .gz)");
}

}  // namespace

namespace {

/// A mesh or an OBJ file, with a camera and light.
Scene read_model(const std::string& format, const InputPath& input, const std::string& path, const ReadOptions& options,
                 Diagnostics& diagnostics) {
  if (format == "obj") return read_obj_model(input, options.aspect, diagnostics, options.search);
  Mesh mesh = format == "stl" ? read_stl(input, diagnostics) : read_ply(input, diagnostics, PlyColours::displayed);
  return model_of(std::move(mesh), path, options.aspect);
}

void refuse_definitions(const std::string& path, const ReadOptions& options) {
  if (!options.definitions.empty()) throw InputError({path}, "parameters can be defined (-D) for Mitsuba scenes only");
}

Scene read_by_format(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  InputPath input = path_beside(path, path, options.confine);
  input.scope.record = options.record;
  check_search_folders(options.search, input.scope);
  const bool is_standard_input = path == standard_input_name;
  const std::string format = is_standard_input ? "pbrt" : format_of(input);
  if (options.time && !std::isfinite(*options.time))
    throw InputError("the time of the animation must be a finite number of seconds");
  if (options.shutter_seconds && !(*options.shutter_seconds >= 0 && std::isfinite(*options.shutter_seconds)))
    throw InputError("the time that the shutter is open must be 0 or more seconds");
  if (format != "xml") refuse_definitions(path, options);
  if (format == "gltf") return read_gltf(input, options, diagnostics);
  if (!options.is_default())
    throw InputError({path}, "cameras, variants and animations can be chosen for glTF files only");
  Scene scene = is_standard_input
                    ? parse_pbrt(standard_input(), "standard input", input.scope, diagnostics, options.search)
                : format == "pbrt" ? read_pbrt(input, diagnostics, options.search)
                : format == "xml"  ? read_mitsuba(input, options, diagnostics)
                                   : read_model(format, input, path, options, diagnostics);
  if (options.time || options.shutter_seconds) set_shutter(scene, options.time, options.shutter_seconds);
  return scene;
}

}  // namespace

Scene read_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  try {
    return read_by_format(path, options, diagnostics);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw TooLargeError({path},
                      "the scene is too large for the memory of this machine, or for a limit set on it (ulimit "
                      "-v): give it fewer or smaller meshes and images");
}

std::vector<Camera> read_camera_path(const std::string& path, const ReadOptions& options,
                                     const std::vector<double>& times) {
  if (path == standard_input_name) return {};
  const InputPath input = path_beside(path, path, options.confine);
  return format_of(input) == "gltf" ? read_gltf_camera_path(input, options, times) : std::vector<Camera>{};
}

namespace {

/// What has no name is called by its kind and its place in the file.
SceneListing names_in(const Scene& scene) {
  SceneListing listing;
  listing.cameras.emplace_back(camera_name(scene.camera.kind));
  for (const Light& light : scene.lights) listing.lights.push_back(light_name(light));
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes)
      if (shape.emission) listing.lights.push_back("area light, " + shape.where.to_string());
  return listing;
}

}  // namespace

bool offers_choices(const std::string& path, const ReadOptions& options) {
  if (path == standard_input_name) return false;
  return format_of(path_beside(path, path, options.confine)) == "gltf";
}

SceneListing list_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  const InputPath input = path_beside(path, path, options.confine);
  if (path != standard_input_name && format_of(input) == "gltf") {
    check_search_folders(options.search, input.scope);
    refuse_definitions(path, options);
    return list_gltf(input, diagnostics, options.search);
  }
  ReadOptions only_read;
  only_read.confine = options.confine;
  only_read.search = options.search;
  only_read.definitions = options.definitions;
  return names_in(read_scene(path, only_read, diagnostics));
}

InputPath path_beside(const std::string& scene, const std::string& path, bool confine) {
  if (!confine) return path;
  return {path, {std::make_shared<const Confinement>(std::filesystem::path(scene).parent_path().string()), nullptr}};
}

}  // namespace alhazen::impl
