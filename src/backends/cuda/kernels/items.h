#pragma once

// The items of a work queue. An item is one block of samples of one pixel. Items are stored in the order in which a
// warp should take them: one block of each of the 32 pixels of a tile, then the next block of these pixels, then the
// next tile.

#include "backends/cuda/kernels/launch.h"

namespace alhazen::impl::cuda {

struct ItemGrid {
  static constexpr uint32_t tile_width = 8, tile_height = 4;  ///< pixels; a tile has as many as a warp has lanes
  static constexpr uint32_t tile_pixels = tile_width * tile_height;

  uint32_t width, rows, blocks;

  ALHAZEN_HD uint32_t tiles_x() const { return (width + tile_width - 1) / tile_width; }
  ALHAZEN_HD uint32_t tiles_y() const { return (rows + tile_height - 1) / tile_height; }
  /// Number of items, including those outside the image in tiles at its edges.
  ALHAZEN_HD uint32_t count() const { return tiles_x() * tiles_y() * tile_pixels * blocks; }

  ALHAZEN_HD uint32_t item_of(uint32_t x, uint32_t row, uint32_t block) const {
    const uint32_t tile = row / tile_height * tiles_x() + x / tile_width;
    return (tile * blocks + block) * tile_pixels + row % tile_height * tile_width + x % tile_width;
  }
};

/// The coordinates of an item: column, row of the slice, block.
struct Item {
  uint32_t x, row, block;
};

ALHAZEN_HD inline Item item_at(const ItemGrid& grid, uint32_t index) {
  const uint32_t lane = index % ItemGrid::tile_pixels, group = index / ItemGrid::tile_pixels;
  const uint32_t tile = group / grid.blocks;
  return {tile % grid.tiles_x() * ItemGrid::tile_width + lane % ItemGrid::tile_width,
          tile / grid.tiles_x() * ItemGrid::tile_height + lane / ItemGrid::tile_width, group % grid.blocks};
}

/// Claims the next item that is in the image and to be taken. Returns false if the queue is empty.
template <QueueThread Thread, class Real>
ALHAZEN_HD bool claim_item(const Thread& thread, const Launch<Real>& launch, const ItemGrid& grid, uint32_t* next_item,
                           uint32_t& index, Item& item) {
  for (;;) {
    index = thread.increment(next_item);
    if (index >= grid.count()) return false;
    item = item_at(grid, index);
    if (item.x < grid.width && item.row < grid.rows &&
        !launch.skips_block(launch.film_index(item.x, item.row), item.block))
      return true;
  }
}

/// Adds the blocks of each pixel to the film, in the order of their samples. Each thread handles the pixel index().
template <class Real>
struct FoldKernel {
  Launch<Real> launch;
  ItemGrid grid;
  const BlockSum<Real>* sums;  ///< one per item

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const uint32_t pixel = thread.index();
    if (pixel >= grid.width * grid.rows) return;
    const uint32_t x = pixel % grid.width, row = pixel / grid.width;
    const size_t film_pixel = launch.film_index(x, row);
    for (uint32_t block = 0; block < grid.blocks; ++block)
      if (!launch.skips_block(film_pixel, block))
        finish_block(thread, launch, film_pixel, sums[grid.item_of(x, row, block)]);
  }
};

}  // namespace alhazen::impl::cuda
