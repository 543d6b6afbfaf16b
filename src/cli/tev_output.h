#pragma once

// --tev: the image so far is shown in tev, with all its layers.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "cli/live_outputs.h"
#include "view/tev_client.h"

namespace alhazen::impl {

/// Images with more bytes than `max_bytes` are shown without their layers, since two copies may be waiting to be sent.
std::unique_ptr<LiveOutput> make_tev_output(const TevAddress& address, uint64_t max_bytes,
                                            std::function<void(const std::string&)> warn);

/// A fraction of this machine's memory.
uint64_t max_tev_bytes();

}  // namespace alhazen::impl
