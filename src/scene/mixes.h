#pragma once

// Mixes of materials, which may contain further mixes.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alhazen::impl {

/// The mixes among the materials, each after the mixes that it contains. `of_itself` receives one that contains itself,
/// if any (the order is incomplete then), else no_index.
std::vector<uint32_t> order_of_mixes(const std::vector<Material>& materials, uint32_t& of_itself);

/// Throws if a mix contains itself.
void check_mixes(const Scene& scene);

}  // namespace alhazen::impl
