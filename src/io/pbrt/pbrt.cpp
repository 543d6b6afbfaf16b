#include "io/pbrt/pbrt.h"

#include <filesystem>
#include <memory>
#include <utility>

#include "io/pbrt/parser.h"

namespace alhazen {

namespace {

Scene parse(std::string text, const std::string& name, const std::string& folder, const std::string& path,
            Diagnostics& diagnostics) {
  auto source = std::make_shared<pbrt::SourceFile>();
  source->name = name;
  source->text = std::move(text);
  pbrt::Build build(folder, diagnostics);
  build.scene.name = name;
  pbrt::Parser(build).parse_top(std::move(source), path);
  return build.finish();
}

}  // namespace

Scene read_pbrt(const std::string& path, Diagnostics& diagnostics) {
  return parse(pbrt::read_text(path), path, std::filesystem::path(path).parent_path().string(), path, diagnostics);
}

Scene parse_pbrt(const std::string& text, const std::string& name, const std::string& folder,
                 Diagnostics& diagnostics) {
  return parse(text, name, folder, {}, diagnostics);
}

}  // namespace alhazen
