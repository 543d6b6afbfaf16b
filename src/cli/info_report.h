#pragma once

// What `alhazen info` prints.

#include <string>
#include <vector>

#include "io/read_options.h"
#include "pipeline/describe_scene.h"
#include "render/settings.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

struct SceneReport {
  std::string file;
  const Scene& scene;
  RenderSettings settings;
  SceneDescription contents;
  SceneListing choices;
  std::vector<Diagnostics::Warning> warnings;  ///< of the reader: what the file has and is not supported
};

/// For people. Long lists end after 20 lines with a count of the rest, unless `all`.
std::string report_text(const SceneReport& report, bool all);

/// One JSON object, whose keys docs/formats.md explains, and a line feed.
std::string report_json(const SceneReport& report);

}  // namespace alhazen::impl
