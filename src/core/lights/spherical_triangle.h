#pragma once

// Samples the points of a triangle uniformly over the solid angle that it subtends. A part of the triangle with the
// wanted share of the solid angle is cut off by an arc through a corner, then a point of the arc is chosen (Arvo 1995,
// "Stratified Sampling of Spherical Triangles"). The end of the arc follows from the formula for the solid angle by
// Van Oosterom and Strackee (1983), with the tangent of half an angle instead of inverse cosines. Edges are computed
// from the corners, not from unit vectors, so that small triangles lose no precision.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// A triangle seen from a point.
template <class Real>
struct SphericalTriangle {
  Vec3<Real> to_corner;     ///< from the point to the first corner
  Vec3<Real> edge1, edge2;  ///< from the first corner to the others
  Vec3<Real> a, b, c;       ///< unit directions to the corners
  Real distance_b;          ///< to the second corner
  Real solid_angle;         ///< at most 2 pi
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT SphericalTriangle<Real> spherical_triangle(const Vec3<Real>& point, const Vec3<Real>& corner0,
                                                                  const Vec3<Real>& corner1,
                                                                  const Vec3<Real>& corner2) {
  SphericalTriangle<Real> t;
  t.to_corner = corner0 - point;
  t.edge1 = corner1 - corner0;
  t.edge2 = corner2 - corner0;
  const Vec3<Real> to_b = corner1 - point, to_c = corner2 - point;
  const Real per_a = 1 / length(t.to_corner), per_c = 1 / length(to_c);
  t.distance_b = length(to_b);
  const Real per_b = 1 / t.distance_b;
  t.a = t.to_corner * per_a;
  t.b = to_b * per_b;
  t.c = to_c * per_c;
  const Real volume = std::abs(dot(t.a, cross(t.edge1, t.edge2))) * (per_b * per_c);
  t.solid_angle = 2 * angle_of_vector(1 + dot(t.a, t.b) + dot(t.b, t.c) + dot(t.c, t.a), volume);
  return t;
}

/// Returns the solid angle of the part between a, b and `end`, which is on the arc from a to c.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real solid_angle_up_to(const SphericalTriangle<Real>& t, const Vec3<Real>& end) {
  const Real volume = std::abs(dot(end, cross(t.a, t.edge1))) / t.distance_b;
  return 2 * angle_of_vector(1 + dot(t.a, t.b) + dot(t.b, end) + dot(t.a, end), volume);
}

/// The inverse of sample_spherical_triangle for the unit direction `w` to a point of the triangle.
template <class Real>
ALHAZEN_HD Vec2<Real> invert_spherical_triangle(const SphericalTriangle<Real>& t, const Vec3<Real>& w) {
  const Vec3<Real> crossing = cross(cross(t.b, w), cross(t.c, t.a));
  const Real size = length(crossing);
  if (!(size > 0)) return {};
  const Vec3<Real> end = crossing * ((dot(crossing, t.a + t.c) < 0 ? Real(-1) : Real(1)) / size);
  return {clamp(solid_angle_up_to(t, end) / t.solid_angle, Real(0), Real(1)),
          clamp(length_squared(w - t.b) / length_squared(end - t.b), Real(0), Real(1))};
}

/// A density over the unit square that is bilinear: the values at x = 0 and x = 1, for y = 0 and for y = 1.
template <class Real>
struct BilinearDensity {
  Real at0[2], at1[2];  ///< of y = 0 and y = 1, up to a factor

  ALHAZEN_HD ALHAZEN_HOT Real pdf(const Vec2<Real>& u) const {
    const Real mean = (at0[0] + at0[1] + at1[0] + at1[1]) * Real(0.25);
    return lerp(lerp(at0[0], at0[1], u.x), lerp(at1[0], at1[1], u.x), u.y) / mean;
  }
};

/// Maps a uniform number to a density that is linear from `a` at 0 to `b` at 1.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real sample_linear(Real u, Real a, Real b) {
  return min(u * (a + b) / (a + std::sqrt(lerp(a * a, b * b, u))), one_minus_epsilon<Real>);
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> sample_bilinear(const BilinearDensity<Real>& density, const Vec2<Real>& u) {
  const Real y = sample_linear(u.y, density.at0[0] + density.at0[1], density.at1[0] + density.at1[1]);
  return {sample_linear(u.x, lerp(density.at0[0], density.at1[0], y), lerp(density.at0[1], density.at1[1], y)), y};
}

/// The density by which the cosine at a surface with this normal is approximately sampled, over the numbers of
/// sample_spherical_triangle (Hart et al. 2020, "Practical Product Sampling by Fitting and Composing Warps"). It is
/// uniform if `normal` is zero.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BilinearDensity<Real> cosine_density(const SphericalTriangle<Real>& t,
                                                            const Vec3<Real>& normal) {
  const Real any = is_zero(normal) ? Real(1) : Real(0);
  const auto cosine = [&](const Vec3<Real>& w) { return max(dot(normal, w), Real(0.01)) + any; };
  return {{cosine(t.b), cosine(t.b)}, {cosine(t.a), cosine(t.c)}};
}

/// Returns the barycentric weights of the first two corners. Numbers that are stratified over the unit square give
/// points that are stratified over the solid angle.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> sample_spherical_triangle(const SphericalTriangle<Real>& t, const Vec2<Real>& u) {
  // The arc from the second corner ends at `end`, between the first and the third, so that the part at the first corner
  // has the solid angle u.x * t.solid_angle. `along` is orthogonal to a, in the plane of both corners.
  const Vec3<Real> along = normalize(t.edge2 - t.a * dot(t.a, t.edge2));
  const Real per_b = 1 / t.distance_b;
  const auto [sine, cosine] = sine_cosine_of_turn(u.x * t.solid_angle / 2);
  const Real volume = std::abs(dot(along, cross(t.a, t.edge1))) * per_b;
  const Real x = cosine * volume - sine * dot(along, t.edge1) * per_b, y = sine * (1 + dot(t.a, t.b));
  const Real per_square = 1 / (x * x + y * y);
  const Vec3<Real> end = t.a * ((x * x - y * y) * per_square) + along * (2 * x * y * per_square);
  // A point of the arc: the height over the plane orthogonal to b is uniform.
  const Vec3<Real> chord = end - t.b;
  const Real fall = length_squared(chord) / 2 * u.y;  // 1 - cosine of the angle to b
  const Vec3<Real> across = normalize(chord - t.b * dot(t.b, chord));
  const Vec3<Real> direction = t.b * (1 - fall) + across * safe_sqrt(fall * (2 - fall));
  // Where it meets the triangle (Moeller and Trumbore 1997).
  const Vec3<Real> p = cross(direction, t.edge2), q = cross(t.edge1, t.to_corner);
  const Real per_determinant = 1 / dot(t.edge1, p);
  const Real b1 = clamp(-dot(t.to_corner, p) * per_determinant, Real(0), Real(1));
  const Real b2 = clamp(dot(direction, q) * per_determinant, Real(0), 1 - b1);
  return {1 - b1 - b2, b1};
}

}  // namespace ALHAZEN_CORE
