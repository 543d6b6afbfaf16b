#pragma once

// Triangulates simple polygons that need not be convex, after Meisters, "Polygons Have Ears" (1975).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace alhazen::impl {

/// Splits polygons into triangles. An object can be reused for many polygons and keeps its memory.
class EarClipper {
 public:
  /// Returns the triangles, two fewer than the corners, as indices into `corners`, with the winding of the polygon,
  /// which must be counter-clockwise. Corners may repeat and be collinear, and the outline may touch itself (as where a
  /// bridge joins it to a hole). A self-intersecting outline gives some triangulation of its corners. For corners in
  /// general position the time grows little faster than their number.
  std::span<const std::array<uint32_t, 3>> triangulate(std::span<const Vec2d> corners);

 private:
  struct Corner {
    uint32_t previous, next;
    uint32_t leaf;  ///< leaf of the tree
    bool convex, clipped, queued;
  };
  /// A range of `order_`; children of node i are 2 i + 1 and 2 i + 2.
  struct Node {
    Vec2d low, high;
    uint32_t first, count;
    uint32_t blockers;  ///< number of corners in the range that may block an ear
  };

  void link(std::span<const Vec2d> corners);
  void build(uint32_t node, uint32_t first, uint32_t count);
  void set_convex(uint32_t corner, bool convex);
  double area(uint32_t a, uint32_t b, uint32_t c) const;
  bool is_within(uint32_t p, uint32_t tip) const;
  bool blocks(uint32_t p, uint32_t tip) const;
  bool is_blocked(uint32_t tip, uint32_t node) const;
  bool is_ear(uint32_t corner) const;
  void update(uint32_t corner);
  void clip(uint32_t corner);
  void clip_ears();
  void queue_all();
  uint32_t least_harmful_ear();

  std::span<const Vec2d> at_;
  std::vector<Corner> corners_;
  std::vector<uint32_t> order_, queue_;
  std::vector<Node> nodes_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  uint32_t left_ = 0;          ///< corners that are not clipped
  uint32_t cursor_ = 0;        ///< a corner that is not clipped
  uint32_t left_at_scan_ = 0;  ///< number of corners when all were last queued
};

}  // namespace alhazen::impl
