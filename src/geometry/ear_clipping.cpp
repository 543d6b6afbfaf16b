#include "geometry/ear_clipping.h"

#include <algorithm>

namespace alhazen::impl {

namespace {

constexpr uint32_t leaf_size = 4;

double cross(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Returns whether a box is outside the half-plane to the left of a -> b.
bool is_right_of(const Vec2d& low, const Vec2d& high, const Vec2d& a, const Vec2d& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  // The corner of the box that is farthest to the left.
  const Vec2d corner{dy > 0 ? low.x : high.x, dx > 0 ? high.y : low.y};
  return dx * (corner.y - a.y) - dy * (corner.x - a.x) < 0;
}

}  // namespace

double EarClipper::area(uint32_t a, uint32_t b, uint32_t c) const { return cross(at_[a], at_[b], at_[c]); }

void EarClipper::link(std::span<const Vec2d> corners) {
  at_ = corners;
  const uint32_t count = static_cast<uint32_t>(corners.size());
  left_ = count;
  left_at_scan_ = count;
  cursor_ = 0;
  triangles_.clear();
  queue_.clear();
  corners_.resize(count);
  order_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    corners_[i] = {i == 0 ? count - 1 : i - 1, i + 1 == count ? 0 : i + 1, 0, true, false, false};
    order_[i] = i;
  }
  nodes_.clear();
  build(0, 0, count);
}

/// Builds a tree over all corners, halved along the longer side of its boxes.
void EarClipper::build(uint32_t node, uint32_t first, uint32_t count) {
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  Node made{at_[order_[first]], at_[order_[first]], first, count, 0};
  for (uint32_t i = first; i < first + count; ++i) {
    const Vec2d& p = at_[order_[i]];
    made.low = {std::min(made.low.x, p.x), std::min(made.low.y, p.y)};
    made.high = {std::max(made.high.x, p.x), std::max(made.high.y, p.y)};
  }
  nodes_[node] = made;
  if (count <= leaf_size) {
    for (uint32_t i = first; i < first + count; ++i) corners_[order_[i]].leaf = node;
    return;
  }
  const bool along_x = made.high.x - made.low.x > made.high.y - made.low.y;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t a, uint32_t b) {
    const double va = along_x ? at_[a].x : at_[a].y, vb = along_x ? at_[b].x : at_[b].y;
    return va != vb ? va < vb : a < b;
  });
  build(2 * node + 1, first, count / 2);
  build(2 * node + 2, first + count / 2, count - count / 2);
}

/// Updates, in every node above the corner, the count of corners that may block an ear: those that are not convex.
void EarClipper::set_convex(uint32_t corner, bool convex) {
  Corner& c = corners_[corner];
  if (c.convex == convex) return;
  c.convex = convex;
  for (uint32_t node = c.leaf;; node = (node - 1) / 2) {
    nodes_[node].blockers += convex ? -1u : 1u;
    if (node == 0) return;
  }
}

/// Returns whether the outline next to `p`, which coincides with a corner of the triangle at `tip`, continues within
/// the angle of that corner.
bool EarClipper::is_within(uint32_t p, uint32_t tip) const {
  const uint32_t triangle[3] = {corners_[tip].previous, tip, corners_[tip].next};
  for (int k = 0; k < 3; ++k) {
    const uint32_t corner = triangle[k], after = triangle[(k + 1) % 3], before = triangle[(k + 2) % 3];
    if (at_[corner] != at_[p]) continue;
    for (const uint32_t neighbour : {corners_[p].previous, corners_[p].next})
      if (area(corner, after, neighbour) > 0 && area(before, corner, neighbour) > 0) return true;
  }
  return false;
}

bool EarClipper::blocks(uint32_t p, uint32_t tip) const {
  const uint32_t a = corners_[tip].previous, c = corners_[tip].next;
  if (p == a || p == tip || p == c) return false;
  if (area(a, tip, p) < 0 || area(tip, c, p) < 0 || area(c, a, p) < 0) return false;
  if (at_[p] == at_[a] || at_[p] == at_[tip] || at_[p] == at_[c]) return is_within(p, tip);
  return true;
}

bool EarClipper::is_blocked(uint32_t tip, uint32_t node) const {
  const Node& n = nodes_[node];
  if (n.blockers == 0) return false;
  const Vec2d &a = at_[corners_[tip].previous], &b = at_[tip], &c = at_[corners_[tip].next];
  if (n.high.x < std::min({a.x, b.x, c.x}) || n.low.x > std::max({a.x, b.x, c.x}) ||
      n.high.y < std::min({a.y, b.y, c.y}) || n.low.y > std::max({a.y, b.y, c.y}))
    return false;
  if (is_right_of(n.low, n.high, a, b) || is_right_of(n.low, n.high, b, c) || is_right_of(n.low, n.high, c, a))
    return false;
  if (n.count > leaf_size) return is_blocked(tip, 2 * node + 1) || is_blocked(tip, 2 * node + 2);
  for (uint32_t i = n.first; i < n.first + n.count; ++i)
    if (!corners_[order_[i]].convex && blocks(order_[i], tip)) return true;
  return false;
}

/// An ear contains no other corner. It suffices to test corners that are not convex: if any corner is inside, one of
/// these is. A corner that repeats its neighbour, or at which the outline reverses, is clipped as well, since it has no
/// area.
bool EarClipper::is_ear(uint32_t corner) const {
  const Corner& c = corners_[corner];
  const Vec2d &a = at_[c.previous], &b = at_[corner], &d = at_[c.next];
  if (cross(a, b, d) == 0) return (a.x - b.x) * (d.x - b.x) + (a.y - b.y) * (d.y - b.y) >= 0;
  return c.convex && !is_blocked(corner, 0);
}

void EarClipper::update(uint32_t corner) {
  Corner& c = corners_[corner];
  set_convex(corner, area(c.previous, corner, c.next) > 0);
  if (!c.queued) queue_.push_back(corner);
  c.queued = true;
}

void EarClipper::clip(uint32_t corner) {
  Corner& c = corners_[corner];
  triangles_.push_back({c.previous, corner, c.next});
  set_convex(corner, true);
  c.clipped = true;
  --left_;
  corners_[c.previous].next = c.next;
  corners_[c.next].previous = c.previous;
  if (cursor_ == corner) cursor_ = c.next;
  update(c.previous);
  update(c.next);
}

/// Clips ears first in, first out: all along the outline before the corners that become ears thereby.
void EarClipper::clip_ears() {
  for (size_t i = 0; i < queue_.size() && left_ > 3; ++i) {
    const uint32_t corner = queue_[i];
    corners_[corner].queued = false;
    if (!corners_[corner].clipped && is_ear(corner)) clip(corner);
  }
  for (const uint32_t corner : queue_) corners_[corner].queued = false;
  queue_.clear();
}

void EarClipper::queue_all() {
  left_at_scan_ = left_;
  uint32_t corner = cursor_;
  do {
    update(corner);
    corner = corners_[corner].next;
  } while (corner != cursor_);
}

/// The corner to clip if no ear is left, as in a self-intersecting outline: one without area if the next few have one,
/// else a convex one, else any. Testing all of them each time would take quadratic time.
uint32_t EarClipper::least_harmful_ear() {
  constexpr int looked_at = 64;
  uint32_t convex = cursor_, corner = cursor_;
  for (int i = 0; i < looked_at; ++i, corner = corners_[corner].next) {
    if (area(corners_[corner].previous, corner, corners_[corner].next) == 0) return corner;
    if (!corners_[convex].convex && corners_[corner].convex) convex = corner;
  }
  return convex;
}

std::span<const std::array<uint32_t, 3>> EarClipper::triangulate(std::span<const Vec2d> corners) {
  link(corners);
  queue_all();
  while (true) {
    clip_ears();
    if (left_ <= 3) break;
    // Only the neighbours of an ear can become ears, but this holds only in exact arithmetic and for simple outlines.
    // So all are tested again when few are left or an eighth has been clipped, which bounds the cost.
    if (left_ < left_at_scan_ && (left_ <= 64 || left_ <= left_at_scan_ / 8 * 7))
      queue_all();
    else
      clip(least_harmful_ear());
  }
  triangles_.push_back({corners_[cursor_].previous, cursor_, corners_[cursor_].next});
  return triangles_;
}

}  // namespace alhazen::impl
