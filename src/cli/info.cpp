// `alhazen info`: describes the contents of a scene file without rendering it.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/listing.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "compile/compile_scene.h"
#include "pipeline/load_scene.h"
#include "render/statistics.h"
#include "scene/filters.h"
#include "util/printable.h"

namespace alhazen {

namespace {

struct InfoOptions {
  std::string scene;
  bool json = false, list = false;
  Settings asked;  ///< definitions and confinement
};

std::string name_of(FilterType type) {
  for (const auto& [name, filter] : named_filters())
    if (filter.type == type) return name;
  return {};
}

void show(const InfoOptions& options) {
  if (options.list) {
    print_listing(options.scene, options.asked, options.json);
    return;
  }
  Diagnostics diagnostics;
  const Settings& asked = options.asked;
  Scene scene = load_scene(options.scene, asked, diagnostics).scene;
  const RenderSettings settings = resolve_settings(asked, scene);
  const size_t materials = scene.materials.size(), textures = scene.textures.size(), images = scene.images.size(),
               meshes = scene.meshes.size(), instances = scene.instances.size();
  const std::string filter = name_of(scene.filter.type);
  CompileOptions as_on_cpus{.layouts = {BvhLayout::bvh8}};
  as_on_cpus.path_segments = settings.integrator == IntegratorKind::path ? settings.max_segments : 0;
  const SceneStatistics sizes = compile_scene<float>(std::move(scene), as_on_cpus, diagnostics).statistics;
  nlohmann::ordered_json j{{"scene", options.scene},
                           {"width", settings.window.width()},
                           {"height", settings.window.height()},
                           {"quality", settings.asked.quality.empty() ? "none" : settings.asked.quality},
                           {"spp", settings.samples_per_pixel},
                           {"max_depth", settings.max_segments - 1},
                           {"integrator", to_string(settings.integrator)},
                           {"sampler", to_string(settings.sampler)},
                           {"filter", filter},
                           {"triangles", sizes.triangles},
                           {"spheres", sizes.spheres}};
  for (const auto& [name, count] : sizes.others) j[name] = count;
  j.update(nlohmann::ordered_json{{"lights", sizes.lights},
                                  {"meshes", meshes},
                                  {"instances", instances},
                                  {"materials", materials},
                                  {"textures", textures},
                                  {"images", images},
                                  {"nodes", sizes.nodes},
                                  {"scene_bytes", sizes.bytes},
                                  {"tree_bytes", sizes.tree_bytes},
                                  {"build_seconds", sizes.build_seconds},
                                  {"peak_rss_bytes", peak_rss_bytes()}});
  if (options.json) {
    print_out("{}\n", j.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  } else {
    for (const auto& [key, value] : j.items())
      print_out("{:<15} {}\n", key, value.is_string() ? printable(value.get<std::string>()) : value.dump());
  }
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) tell("warning: {}\n", warning.to_string());
}

}  // namespace

void register_info(Command& program) {
  Command command = program.add_subcommand("info", "Read a scene and describe its contents");
  auto options = std::make_shared<InfoOptions>();
  command.add_option("SCENE", options->scene, "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl)")
      .required()
      .value_name("");
  command.add_flag("--json", options->json, "One JSON object instead of the list");
  command.add_flag("--list", options->list, "Cameras, variants, animations and lights of a glTF file instead");
  command.add_flag("--confine", options->asked.confine, "Read nothing outside the folder of the scene");
  add_setting_option(command, options->asked, "define");
  command.on_run([options] { show(*options); });
}

}  // namespace alhazen
