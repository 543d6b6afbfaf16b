#pragma once

// --write-every: the files are written anew while the image is rendered.

#include <functional>
#include <memory>
#include <string>

#include "cli/live_outputs.h"
#include "pipeline/write_outputs.h"

namespace alhazen::impl {

/// Writes the files of `output` at each look, with what the image so far decides about its display. Pipes and devices
/// are left out, since their readers expect one image. `warn` is told of the first failure.
std::unique_ptr<LiveOutput> make_rewritten_outputs(OutputOptions output, std::function<void(const std::string&)> warn);

/// Whether a file of this name can be written more than once: it is a regular one, or is not there yet.
bool can_be_rewritten(const std::string& path);

}  // namespace alhazen::impl
