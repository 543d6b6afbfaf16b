#include "io/obj/obj_model.h"

#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "io/model.h"
#include "io/obj/material.h"
#include "io/obj/obj_file.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace obj {

namespace {

class ModelReader {
 public:
  ModelReader(const InputPath& path, const FileSearch& search, Diagnostics& diagnostics)
      : folder_(std::filesystem::path(path.name).parent_path().string()),
        scope_(path.scope),
        search_(search),
        diagnostics_(diagnostics) {}

  Scene run(File file, const std::string& name, double aspect) {
    for (const Library& library : file.libraries) read_library(library);
    Materials materials(scene_, folder_, scope_, search_, diagnostics_);
    for (Part& part : file.parts) {
      if (part.mesh.indices.empty()) continue;
      Shape shape;
      shape.where = part.where;
      const MaterialUse use = material_of(materials, part);
      shape.material = use.material;
      shape.emission = use.emission;
      shape.mesh = static_cast<uint32_t>(scene_.meshes.size());
      if (!part.object.empty()) part.mesh.name += ": " + part.object;
      scene_.meshes.push_back(std::move(part.mesh));
      scene_.groups[0].shapes.push_back(std::move(shape));
    }
    show_as_model(scene_, name, aspect);
    return std::move(scene_);
  }

 private:
  /// The text is the name of one file, which may have blanks, or else of several.
  void read_library(const Library& library) {
    if (read_materials(library, library.text)) return;
    bool all = true;
    for (size_t begin = 0; begin < library.text.size();) {
      const size_t end = std::min(library.text.find_first_of(" \t", begin), library.text.size());
      if (end > begin) all = read_materials(library, library.text.substr(begin, end - begin)) && all;
      begin = end + 1;
    }
    if (!all || library.text.empty())
      diagnostics_.warn(library.where, "the materials " + quoted(library.text) + " are not found (looked in " +
                                           quoted(folder_.empty() ? "." : folder_) +
                                           "); without them surfaces are grey" + search_hint(search_));
  }

  bool read_materials(const Library& library, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.empty()) return false;
    const FoundFile found = find_file(folder_, name, scope_, search_);
    if (found.problem.is_missing) return false;
    if (!found.problem.message.empty())
      throw InputError(library.where, "the materials " + quoted(name) + " " + found.problem.message);
    for (MtlMaterial& material : read_mtl(found.path, diagnostics_)) {
      const std::string key = material.name;
      descriptions_.emplace(key, std::move(material));
    }
    return true;
  }

  MaterialUse material_of(Materials& materials, const Part& part) {
    const bool has_colours = !part.mesh.colours.empty();
    const auto [entry, is_new] = uses_.try_emplace({part.material, has_colours});
    if (!is_new) return entry->second;
    const auto found = descriptions_.find(part.material);
    if (found == descriptions_.end() && !part.material.empty())
      diagnostics_.warn(part.material_place,
                        "no material is named " + quoted(part.material) + "; its surfaces are grey");
    entry->second = materials.add(found == descriptions_.end() ? MtlMaterial{} : found->second, has_colours);
    return entry->second;
  }

  std::string folder_;
  InputScope scope_;
  FileSearch search_;
  Diagnostics& diagnostics_;
  Scene scene_;
  std::map<std::string, MtlMaterial> descriptions_;
  std::map<std::pair<std::string, bool>, MaterialUse> uses_;
};

}  // namespace

}  // namespace obj

Scene read_obj_model(const InputPath& path, double aspect, Diagnostics& diagnostics, const FileSearch& search) {
  return obj::ModelReader(path, search, diagnostics)
      .run(obj::read_obj(path, obj::Division::named, diagnostics), path.name, aspect);
}

Scene parse_obj_model(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  MemorySource source(text);
  return obj::ModelReader(name, {}, diagnostics)
      .run(obj::parse_obj(source, name, obj::Division::named, diagnostics), name, 0);
}

}  // namespace alhazen::impl
