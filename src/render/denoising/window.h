#pragma once

// Windows of pixels, as the regression of the built-in denoiser takes them.

namespace alhazen::impl::denoising {

/// Pixels within `window_radius` of a pixel contribute to it by how similar they are; the neighbourhoods by which they
/// are compared, patches, have the radius `patch_radius`.
inline constexpr int window_radius = 9, patch_radius = 3;
inline constexpr int window_side = 2 * window_radius + 1, window_size = window_side * window_side;
/// Sums have this many lanes, so that their order does not depend on the instruction set.
inline constexpr int lanes = 8;
inline constexpr int padded_window = (window_size + lanes - 1) / lanes * lanes;

/// One value for each pixel of a window, row by row, and zeros.
struct WindowRow {
  alignas(64) float values[padded_window];
};

/// Albedo (3), normal (3), depth.
inline constexpr int feature_count = 7;
/// A constant, the slopes over the features, and those over x and y.
inline constexpr int max_unknowns = 1 + feature_count + 2;

/// What the regression is over, relative to the centre of the window. The fit takes features as noisy as the colours,
/// whose noise is in part the same: at an edge, both are by how many samples hit which side. The prediction takes
/// filtered ones.
struct WindowInputs {
  int count = 0;  ///< of unknowns; features that are constant in the window have none
  WindowRow rows[max_unknowns];
  WindowRow noisy[2][feature_count];  ///< of each half, for rows 1 to count - 3
  float floor[max_unknowns];          ///< squared spread that counts as little
};

struct WindowColours {
  WindowRow channels[3];
  WindowRow variance;  ///< sum over the channels
};

}  // namespace alhazen::impl::denoising
