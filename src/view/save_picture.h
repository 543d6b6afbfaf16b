#pragma once

#include <memory>
#include <string>

#include "view/page_server.h"
#include "view/view_renderer.h"

namespace alhazen::impl {

/// Answers a request for "save.png", "save.exr" and other formats that images are written as, with the query
/// "exposure=STOPS&tone_map=NAME", either of which may be left out. `image` may be null: there is none yet.
PageResponse save_picture(const std::string& scene_file, const ViewImage* image, const std::string& path,
                          const std::string& query);

}  // namespace alhazen::impl
