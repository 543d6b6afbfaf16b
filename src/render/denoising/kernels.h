#pragma once

// The loops of the built-in denoiser that are compiled once per instruction set (render/kernels/denoise.cpp).

#include <cstddef>
#include <vector>

#include "render/denoising/window.h"

namespace alhazen::impl::denoising {

/// Cells of pixels are the unit of work of a thread.
inline constexpr int cell_size = 32;
inline constexpr int cell_side = cell_size + 2 * patch_radius;  ///< with the patches of its pixels

/// Asks for the distances of the patches around some pixels of a cell, the anchors, to those in their windows.
struct PatchRequest {
  const float* values[3];     ///< of the corner of the cell, less patch_radius in both directions
  const float* variances[3];  ///< likewise
  size_t stride;              ///< from row to row
  int width, height;          ///< of the cell
  int anchors;
  const int* x;  ///< of each anchor, from the corner of the cell
  const int* y;
  WindowRow* distances;  ///< of each anchor: squared differences over the variances that noise has, less 1
};

struct Kernels {
  /// Fits `colours`, which are those of a half, with `weights` and writes what the fit predicts for each pixel of the
  /// window.
  void (*fit_window)(const WindowInputs& inputs, int half, const WindowColours& colours, const WindowRow& weights,
                     WindowRow* predicted);
  void (*patch_distances)(const PatchRequest& request);
};

/// The kernels for the instruction sets of this processor, the best last. Every set gives the same bits.
std::vector<Kernels> all_kernels();
inline Kernels select_kernels() { return all_kernels().back(); }

}  // namespace alhazen::impl::denoising
