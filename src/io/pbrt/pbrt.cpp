#include "io/pbrt/pbrt.h"

#include <filesystem>
#include <memory>
#include <utility>

#include "io/pbrt/parser.h"

namespace alhazen::impl {

namespace {

Scene parse(pbrt::SourceFile source, const std::string& folder, const InputScope& scope, Diagnostics& diagnostics,
            const FileSearch& search) {
  pbrt::Build build(folder, scope, diagnostics);
  build.search = search;
  build.scene.name = source.name;
  pbrt::Parser(build).parse_top(std::make_shared<const pbrt::SourceFile>(std::move(source)));
  return build.finish();
}

}  // namespace

Scene read_pbrt(const InputPath& path, Diagnostics& diagnostics, const FileSearch& search) {
  const std::string folder = std::filesystem::path(path.name).parent_path().string();
  return parse({path.name, path, {}}, folder, path.scope, diagnostics, search);
}

Scene parse_pbrt(const std::string& text, const std::string& name, const std::string& folder, Diagnostics& diagnostics,
                 const FileSearch& search) {
  return parse({name, {}, text}, folder, {}, diagnostics, search);
}

Scene parse_pbrt(const std::string& text, const std::string& name, const InputScope& scope, Diagnostics& diagnostics,
                 const FileSearch& search) {
  return parse({name, {}, text}, "", scope, diagnostics, search);
}

}  // namespace alhazen::impl
