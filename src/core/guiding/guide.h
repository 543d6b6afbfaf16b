#pragma once

// What path guiding has learned about a scene, in arrays that any device can read: a tree of space whose leaves are
// regions, and for each region a tree of directions (Müller, Gross, Novák 2017, "Practical Path Guiding for Efficient
// Light-Transport Simulation"). The sums from which it is learned are integers in fixed point, so that neither their
// order nor the number of threads matters. docs/guiding.md describes the method.

#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "core/sampling/hash.h"

namespace ALHAZEN_CORE {

/// A node of a tree of directions. Quarter k of its square is the right half if k is odd, and the lower half (the
/// larger y) if k >= 2.
struct GuideQuad {
  float share[4];     ///< of the light of the node, by quarters; their sum is 1 but for rounding
  uint32_t child[4];  ///< node of the quarter; 0 if it is not divided
};

/// Trees of directions are at most this deep, so that a sample keeps random bits for its place in a leaf.
inline constexpr uint32_t max_quad_depth = 14;

/// A leaf of the tree of space.
struct GuideRegion {
  uint32_t quad;     ///< root of its tree of directions
  float bsdf_share;  ///< probability of sampling the BSDF instead of that tree; 1 until something is known
};

/// The number of BSDF shares at which a region estimates whether a larger one would be better, and the shares.
inline constexpr uint32_t tried_shares = 4;
ALHAZEN_HD constexpr float tried_share(uint32_t i) { return 0.125f + 0.25f * static_cast<float>(i); }

/// What the vertices of a region sum up.
struct GuideTally {
  uint64_t vertices;
  /// How fast the second moment of what the vertices contribute falls with the share, at each of the tried ones; in
  /// two's complement.
  uint64_t slopes[tried_shares];
};

template <class Real>
struct GuideView {
  const uint32_t* cells = nullptr;  ///< nodes of the tree of space: the first of two children, or leaf_cell | region
  const GuideRegion* regions = nullptr;
  const GuideQuad* quads = nullptr;
  uint64_t* light = nullptr;      ///< four sums per node of `quads`, of its quarters that are not divided
  GuideTally* tallies = nullptr;  ///< one per region
  uint32_t cells_count = 0, regions_count = 0, quads_count = 0;
  Vec3<Real> low{}, scale{};  ///< (p - low) * scale is in the unit cube for points of the scene
  Real to_fixed = 0;          ///< 1 / (mean radiance of the image); 0 where nothing is summed up

  static constexpr uint32_t leaf_cell = 0x80000000u;
};

/// Units of the sums per mean radiance of the image, for slopes per its square; and the limit of what one vertex adds,
/// in the same: 2^27 times that can be summed up.
inline constexpr double guide_units = 1 << 20, guide_limit = 1 << 16;

/// The first 32 bits of a number of [0, 1) after the binary point; numbers beyond are clamped, NaN is 0.
template <class Real>
ALHAZEN_HD inline uint32_t bits_of_fraction(Real x) {
  return static_cast<uint32_t>((x > 0 ? min(x, Real(0.99999994)) : Real(0)) * Real(4294967296.0));
}

// ---- directions ------------------------------------------------------------------------------------------------

/// The point of the unit square for a unit vector: the octahedral map (Meyer et al. 2010, "On Floating-Point Normal
/// Vectors"), which takes no trigonometric functions.
template <class Real>
ALHAZEN_HD inline Vec2<Real> guide_square(const Vec3<Real>& d) {
  const Real scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  Real x = d.x * scale, y = d.y * scale;
  if (d.z < 0) {
    const Real folded = std::copysign(1 - std::abs(y), x);
    y = std::copysign(1 - std::abs(x), y);
    x = folded;
  }
  return {clamp((x + 1) * Real(0.5), Real(0), one_minus_epsilon<Real>),
          clamp((y + 1) * Real(0.5), Real(0), one_minus_epsilon<Real>)};
}

template <class Real>
struct GuideDirection {
  Vec3<Real> direction;
  Real density;  ///< area of the square per solid angle in steradians
};

/// A point of the octahedron |x| + |y| + |z| = 1 at the distance r from the centre; area of the plane z = 0 is seen
/// under 1 / r^3 times as much solid angle.
template <class Real>
ALHAZEN_HD inline GuideDirection<Real> guide_direction(const Vec2<Real>& square) {
  Real x = 2 * square.x - 1, y = 2 * square.y - 1;
  const Real z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const Real unfolded = std::copysign(1 - std::abs(y), x);
    y = std::copysign(1 - std::abs(x), y);
    x = unfolded;
  }
  const Real r = std::sqrt(x * x + y * y + z * z), inverse = 1 / r;
  return {{x * inverse, y * inverse, z * inverse}, r * r * r * Real(0.25)};
}

/// The same density for a unit vector.
template <class Real>
ALHAZEN_HD inline Real guide_density(const Vec3<Real>& d) {
  const Real r = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  return r * r * r * Real(0.25);
}

/// The quarter of the square that holds a point with these bits, which then become those within the quarter.
ALHAZEN_HD inline uint32_t take_quarter(uint32_t& x, uint32_t& y) {
  const uint32_t quarter = (x >> 31) | (y >> 31) << 1;
  x <<= 1, y <<= 1;
  return quarter;
}

/// Density of `sample_guide` at a point of the square.
template <class Real>
ALHAZEN_HD inline Real guide_pdf(const GuideView<Real>& guide, uint32_t quad, const Vec2<Real>& square) {
  uint32_t x = bits_of_fraction(square.x), y = bits_of_fraction(square.y);
  Real pdf = 1;
  do {
    const GuideQuad& node = guide.quads[quad];
    const uint32_t quarter = take_quarter(x, y);
    pdf *= 4 * static_cast<Real>(node.share[quarter]);
    quad = node.child[quarter];
  } while (quad != 0);
  return pdf;
}

template <class Real>
struct GuideSample {
  Vec2<Real> square;
  Real pdf;  ///< with respect to area of the square
};

/// Samples the tree of directions with the root `quad`.
template <class Real>
ALHAZEN_HD inline GuideSample<Real> sample_guide(const GuideView<Real>& guide, uint32_t quad, Vec2<Real> u) {
  GuideSample<Real> s{{}, 1};
  Real size = 1;
  do {
    const GuideQuad& node = guide.quads[quad];
    const Real left = static_cast<Real>(node.share[0]) + static_cast<Real>(node.share[2]);
    const Real right = static_cast<Real>(node.share[1]) + static_cast<Real>(node.share[3]);
    const Real split_x = left / (left + right);
    const uint32_t is_right = u.x < split_x ? 0 : 1;
    u.x = is_right ? (u.x - split_x) / (1 - split_x) : u.x / split_x;
    const Real upper = static_cast<Real>(node.share[is_right]), both = is_right ? right : left;
    const Real split_y = upper / both;
    const uint32_t is_lower = u.y < split_y ? 0 : 1;
    u.y = is_lower ? (u.y - split_y) / (1 - split_y) : u.y / split_y;
    u = {min(u.x, one_minus_epsilon<Real>), min(u.y, one_minus_epsilon<Real>)};
    const uint32_t quarter = is_right + 2 * is_lower;
    s.pdf *= 4 * static_cast<Real>(node.share[quarter]);
    size *= Real(0.5);
    s.square.x += static_cast<Real>(is_right) * size;
    s.square.y += static_cast<Real>(is_lower) * size;
    quad = node.child[quarter];
  } while (quad != 0);
  s.square = {min(s.square.x + u.x * size, one_minus_epsilon<Real>),
              min(s.square.y + u.y * size, one_minus_epsilon<Real>)};
  return s;
}

// ---- space -----------------------------------------------------------------------------------------------------

/// A point of the tree's cube, by the bits of its coordinates.
struct GuidePlace {
  uint32_t bits[3];
};

template <class Real>
ALHAZEN_HD inline GuidePlace guide_place(const GuideView<Real>& guide, const Vec3<Real>& position) {
  const Vec3<Real> p = (position - guide.low) * guide.scale;
  return {{bits_of_fraction(p.x), bits_of_fraction(p.y), bits_of_fraction(p.z)}};
}

/// The region of a point. Levels of the tree halve the x, y and z axes in turn; `depth` becomes the number of levels
/// above the region.
template <class Real>
ALHAZEN_HD inline uint32_t guide_region(const GuideView<Real>& guide, GuidePlace place, uint32_t& depth) {
  uint32_t axis = 0, node = guide.cells[0];
  for (depth = 0; !(node & GuideView<Real>::leaf_cell); ++depth) {
    const uint32_t side = place.bits[axis] >> 31;
    place.bits[axis] <<= 1;
    axis = axis == 2 ? 0 : axis + 1;
    node = guide.cells[node + side];
  }
  return node & ~GuideView<Real>::leaf_cell;
}

// ---- learning --------------------------------------------------------------------------------------------------

/// Adds to a sum that other threads add to as well.
ALHAZEN_HD inline void add_to_sum(uint64_t* sum, uint64_t value) {
#if defined(__CUDA_ARCH__)
  atomicAdd(reinterpret_cast<unsigned long long*>(sum), static_cast<unsigned long long>(value));
#else
  __atomic_fetch_add(sum, value, __ATOMIC_RELAXED);
#endif
}

/// A vertex of a path that was scattered in a direction of which its region learns.
template <class Real>
struct GuideVertex {
  Vec3<Real> position;
  uint32_t region;    ///< that holds it
  Vec2<Real> square;  ///< of the direction
  Real throughput;    ///< luminance, before scattering
  Real radiance;      ///< luminance that the path had gathered before its next vertex; negative: not known yet
  Real pdf_of_bsdf, pdf_of_guide;  ///< of the direction, with respect to solid angle
  Real share;                      ///< of the BSDF in what was sampled
};

/// The vertices of a path, until its end tells what they are worth.
template <class Real>
struct GuideTrail {
  static constexpr uint32_t max_vertices = 12;  ///< later ones are not learned from
  uint32_t count = 0;
  GuideVertex<Real> vertices[max_vertices];

  ALHAZEN_HD void begin() { count = 0; }
  /// Called before the path's next segment, with the luminance that it has gathered.
  ALHAZEN_HD ALHAZEN_HOT void start_segment(Real radiance) {
    if (count > 0 && vertices[count - 1].radiance < 0) vertices[count - 1].radiance = radiance;
  }
};

/// Adds what a vertex contributed, f L |cos| / pdf as luminance, to the sums of a region. The point is moved at random
/// within a box of the size of its region, so that regions share what they know (Müller 2019, in Vorba et al., "Path
/// Guiding in Production", SIGGRAPH courses, chapter 10).
template <class Real>
ALHAZEN_HD inline void learn_from_vertex(const GuideView<Real>& guide, const GuideVertex<Real>& vertex, Real gathered,
                                         uint32_t hash) {
  add_to_sum(&guide.tallies[vertex.region].vertices, 1);
  const Real unlimited = gathered / vertex.throughput * guide.to_fixed;
  if (!(unlimited * Real(guide_units) >= 1)) return;
  const Real weight = min(unlimited, Real(guide_limit));
  GuidePlace place = guide_place(guide, vertex.position);
  uint32_t depth;
  guide_region(guide, place, depth);
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t halvings = (depth + 2 - axis) / 3;
    if (halvings == 0) continue;
    hash = mix32(hash + axis);
    const uint32_t size = halvings < 32 ? 0xffffffffu >> halvings : 0, offset = (hash & size) - size / 2;
    const uint32_t moved = place.bits[axis] + offset;
    // At the faces of the cube the box is folded back.
    const bool is_outside = (offset >> 31) ? moved > place.bits[axis] : moved < place.bits[axis];
    place.bits[axis] = is_outside ? place.bits[axis] - offset : moved;
  }
  const uint32_t region = guide_region(guide, place, depth);
  GuideTally& tally = guide.tallies[region];
  uint32_t x = bits_of_fraction(vertex.square.x), y = bits_of_fraction(vertex.square.y);
  uint32_t quad = guide.regions[region].quad;
  for (;;) {
    const uint32_t quarter = take_quarter(x, y), child = guide.quads[quad].child[quarter];
    if (child == 0) {
      add_to_sum(guide.light + (static_cast<size_t>(quad) * 4 + quarter),
                 static_cast<uint64_t>(weight * Real(guide_units) + Real(0.5)));
      break;
    }
    quad = child;
  }
  // The derivative of the second moment of w by the share, but for its sign, at each of the shares that are tried.
  const Real pdf = vertex.share * vertex.pdf_of_bsdf + (1 - vertex.share) * vertex.pdf_of_guide;
  const Real squared = min(weight * weight, Real(guide_limit));
  for (uint32_t i = 0; i < tried_shares; ++i) {
    const Real share = static_cast<Real>(tried_share(i));
    const Real tried = share * vertex.pdf_of_bsdf + (1 - share) * vertex.pdf_of_guide;
    const Real slope = squared * (pdf / tried) * ((vertex.pdf_of_bsdf - vertex.pdf_of_guide) / tried);
    if (!(tried > 0 && tried < infinity<Real>)) continue;
    const Real limit = Real(guide_limit);
    add_to_sum(&tally.slopes[i],
               static_cast<uint64_t>(static_cast<int64_t>(clamp(slope, -limit, limit) * Real(guide_units))));
  }
}

}  // namespace ALHAZEN_CORE
