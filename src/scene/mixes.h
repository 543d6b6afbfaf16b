#pragma once

// Mixes of materials, which may be made of further mixes.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alhazen {

/// The mixes among materials, each behind the mixes that it is made of. `of_itself` receives one that is made of
/// itself, where there is one (the order is cut short then), else no_index.
std::vector<uint32_t> order_of_mixes(const std::vector<Material>& materials, uint32_t& of_itself);

/// Throws where mixes are made of themselves.
void check_mixes(const Scene& scene);

}  // namespace alhazen
