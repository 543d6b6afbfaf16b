#pragma once

// Limits on what a scene file or the user may ask of a render.

#include <cstdint>

namespace alhazen::impl {

inline constexpr int64_t max_bounces = 1'000'000;
inline constexpr int64_t max_samples_per_pixel = int64_t{1} << 24;

}  // namespace alhazen::impl
