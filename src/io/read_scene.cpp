#include "io/read_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "files/byte_source.h"
#include "images/image.h"
#include "io/gltf/gltf.h"
#include "io/mitsuba/mitsuba.h"
#include "io/model.h"
#include "io/obj/obj_model.h"
#include "io/pbrt/pbrt.h"
#include "io/ply/ply.h"
#include "io/stl/stl.h"

namespace alhazen {

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

Scene read_by_format(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  InputPath input = path_beside(path, path, options.confine);
  input.scope.record = options.record;
  const std::string format = format_of(input);
  if (options.time && !std::isfinite(*options.time))
    throw InputError("the time of the animation must be a finite number of seconds");
  if (format != "xml" && !options.definitions.empty())
    throw InputError({path}, "parameters can be defined (-D) for Mitsuba scenes only");
  if (format == "gltf") return read_gltf(input, options, diagnostics);
  if (!options.is_default())
    throw InputError({path}, "cameras, variants, animations and their time can be chosen for glTF files only");
  if (format == "xml") return read_mitsuba(input, options, diagnostics);
  if (format == "pbrt") return read_pbrt(input, diagnostics);
  if (format == "obj") return read_obj_model(input, options.aspect, diagnostics);
  Mesh mesh = format == "stl" ? read_stl(input, diagnostics) : read_ply(input, diagnostics, PlyColours::displayed);
  return model_of(std::move(mesh), path, options.aspect);
}

}  // namespace

Scene read_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  try {
    return read_by_format(path, options, diagnostics);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw InputError({path},
                   "the scene is too large for the memory of this machine, or for a limit set on it (ulimit "
                   "-v): give it fewer or smaller meshes and images");
}

SceneListing list_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  const InputPath input = path_beside(path, path, options.confine);
  if (format_of(input) == "gltf") return list_gltf(input, diagnostics);
  // These formats offer no choices, but unreadable files are reported all the same.
  ReadOptions only_read;
  only_read.confine = options.confine;
  only_read.definitions = options.definitions;
  read_scene(path, only_read, diagnostics);
  return {};
}

InputPath path_beside(const std::string& scene, const std::string& path, bool confine) {
  if (!confine) return path;
  return {path, {std::make_shared<const Confinement>(std::filesystem::path(scene).parent_path().string()), nullptr}};
}

}  // namespace alhazen
