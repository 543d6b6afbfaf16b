// `alhazen info`: describes the contents of a scene file without rendering it.

#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/info_report.h"
#include "cli/listing.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "pipeline/load_scene.h"

namespace alhazen::impl {

namespace {

struct InfoOptions {
  std::string scene;
  Settings settings;
  bool json = false, list = false, all = false;
};

void show(const InfoOptions& options) {
  if (options.list) {
    print_listing(options.scene, options.settings, options.json);
    return;
  }
  Diagnostics diagnostics;
  const Scene scene = load_scene(options.scene, options.settings, diagnostics).scene;
  const SceneReport report{options.scene,
                           scene,
                           resolve_settings(options.settings, scene),
                           describe(scene),
                           list_choices(options.scene, options.settings),
                           diagnostics.warnings()};
  print_out("{}", options.json ? report_json(report) : report_text(report, options.all));
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) tell("warning: {}\n", warning.to_string());
}

}  // namespace

void register_info(Command& program) {
  Command command = program.add_subcommand("info", "Read a scene and describe its contents");
  auto options = std::make_shared<InfoOptions>();
  command.add_option("SCENE", options->scene, "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl)")
      .required()
      .value_name("");
  command.add_flag("--json", options->json, "One JSON object instead of the report; docs/formats.md has its keys");
  command.add_flag("--all", options->all, "Every object, material, light and image, not only the first 20 of each");
  command.add_flag("--list", options->list, "Cameras, variants, animations and lights instead, with their numbers");
  for (const char* name : {"camera", "time", "animation", "variant", "define", "confine", "search-path", "strict"})
    add_setting_option(command, options->settings, name);
  command.on_run([options] { show(*options); });
}

}  // namespace alhazen::impl
