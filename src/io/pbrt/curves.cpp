#include "io/pbrt/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/pbrt/meshes.h"

namespace alhazen::impl::pbrt {

namespace {

using std::numbers::pi;
using Segment = std::array<Vec3d, 4>;

Vec3d bezier(const Segment& p, double t) {
  const double s = 1 - t;
  return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
}

Vec3d bezier_derivative(const Segment& p, double t) {
  const double s = 1 - t;
  return ((p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t)) * 3;
}

/// Number of straight pieces for an error within a twentieth of the curve's width, or a thousandth of its length if
/// that is more (Wang 1984: n^2 = d (d - 1) / 8 * the largest second difference / tolerance).
uint32_t pieces_of(const Segment& p, double width) {
  const double bend = std::max(length(p[0] - p[1] * 2 + p[2]), length(p[1] - p[2] * 2 + p[3]));
  const double reach = length(p[1] - p[0]) + length(p[2] - p[1]) + length(p[3] - p[2]);
  const double tolerance = std::max(0.05 * width, 0.001 * reach);
  if (!(bend > 0) || !(tolerance > 0)) return 1;
  return static_cast<uint32_t>(std::clamp(std::ceil(std::sqrt(0.75 * bend / tolerance)), 1.0, 32.0));
}

/// A point on the curve with its frame.
struct Station {
  Vec3d point, tangent;  ///< tangent: unit length
  double u;
  Vec3d normal{};  ///< unit length, perpendicular to the tangent
};

Vec3d slerp(const Vec3d& a, const Vec3d& b, double t) {
  const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0)), sine = std::sin(angle);
  if (!(sine > 1e-6)) return a;
  return a * (std::sin((1 - t) * angle) / sine) + b * (std::sin(t * angle) / sine);
}

std::vector<Station> stations_of(const Curve& curve) {
  std::vector<Station> stations;
  const double count = static_cast<double>(curve.segments.size());
  for (size_t i = 0; i < curve.segments.size(); ++i) {
    const Segment& p = curve.segments[i];
    if (p[0] == p[1] && p[1] == p[2] && p[2] == p[3]) continue;
    const uint32_t pieces = pieces_of(p, std::max(curve.width0, curve.width1));
    for (uint32_t k = i == 0 ? 0 : 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      Station station{bezier(p, t), bezier_derivative(p, t), (static_cast<double>(i) + t) / count};
      // The derivative vanishes where control points coincide; the chord to the other end replaces it.
      if (!(length_squared(station.tangent) > 0))
        station.tangent = bezier(p, std::min(t + 0.01, 1.0)) - bezier(p, std::max(t - 0.01, 0.0));
      const double size = length(station.tangent);
      if (!(size > 0) || !std::isfinite(size)) continue;
      station.tangent = station.tangent / size;
      if (!curve.normals.empty()) station.normal = slerp(curve.normals[i], curve.normals[i + 1], t);
      stations.push_back(station);
    }
  }
  return stations;
}

Vec3d across(const Vec3d& v, const Vec3d& tangent) {
  const Vec3d rest = v - tangent * dot(v, tangent);
  const double size = length(rest);
  return size > 1e-9 ? rest / size : frame_about(tangent).tangent;
}

/// Computes rotation-minimizing normals by double reflection (Wang, Juttler, Zheng, Liu 2008, "Computation of Rotation
/// Minimizing Frames").
void add_minimal_normals(std::vector<Station>& stations) {
  stations[0].normal = frame_about(stations[0].tangent).tangent;
  for (size_t i = 1; i < stations.size(); ++i) {
    const Station& before = stations[i - 1];
    Station& here = stations[i];
    Vec3d normal = before.normal, tangent = before.tangent;
    const auto reflect = [&](const Vec3d& axis) {
      const double squared = length_squared(axis);
      if (!(squared > 0)) return;
      normal = normal - axis * (2 * dot(axis, normal) / squared);
      tangent = tangent - axis * (2 * dot(axis, tangent) / squared);
    };
    reflect(here.point - before.point);
    reflect(here.tangent - tangent);
    here.normal = across(normal, here.tangent);
  }
}

void add_vertex(Mesh& mesh, const Vec3d& position, const Vec3d& normal, double u, double v) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(convert<float>(normal));
  mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(v)});
}

/// Adds quads between rings of `count` vertices; if closed, the last vertex is joined to the first.
void join_rings(Mesh& mesh, uint32_t rings, uint32_t count, bool closed) {
  for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (uint32_t k = 0; k + (closed ? 0 : 1) < count; ++k) {
      const uint32_t a = ring * count + k, b = ring * count + (k + 1) % count;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + count, a, b + count, a + count});
    }
  }
}

Mesh tube(std::vector<Station> stations, const Curve& curve) {
  Mesh mesh;
  add_minimal_normals(stations);
  const uint32_t sides = curve.sides;
  // The mean width of a convex outline is its length over pi (Cauchy).
  const double widened = pi / (sides * std::sin(pi / sides));
  for (const Station& s : stations) {
    const double radius = 0.5 * std::lerp(curve.width0, curve.width1, s.u) * widened;
    const Vec3d bitangent = cross(s.tangent, s.normal);
    for (uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * pi * k / sides, part = 2.0 * k / sides;
      const Vec3d out = s.normal * std::cos(angle) + bitangent * std::sin(angle);
      add_vertex(mesh, s.point + out * radius, out, s.u, part <= 1 ? part : 2 - part);
    }
  }
  join_rings(mesh, static_cast<uint32_t>(stations.size()), sides, true);
  return mesh;
}

Mesh strip(const std::vector<Station>& stations, const Curve& curve) {
  Mesh mesh;
  for (const Station& s : stations) {
    const Vec3d normal = across(s.normal, s.tangent);
    const Vec3d side = cross(normal, s.tangent) * (0.5 * std::lerp(curve.width0, curve.width1, s.u));
    add_vertex(mesh, s.point - side, normal, s.u, 0);
    add_vertex(mesh, s.point + side, normal, s.u, 1);
  }
  join_rings(mesh, static_cast<uint32_t>(stations.size()), 2, false);
  return mesh;
}

/// Elevates a quadratic segment to degree 3.
Segment raised(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {a, lerp(a, b, 2.0 / 3), lerp(b, c, 1.0 / 3), c};
}

/// The segment of the uniform B-spline with control points from `p`, computed by its blossom.
Segment segment_of_spline(const Vec3d* p, int degree) {
  if (degree == 2) return raised(lerp(p[0], p[1], 0.5), p[1], lerp(p[1], p[2], 0.5));
  const Vec3d b1 = lerp(p[1], p[2], 1.0 / 3), b2 = lerp(p[1], p[2], 2.0 / 3);
  return {lerp(lerp(p[0], p[1], 2.0 / 3), b1, 0.5), b1, b2, lerp(b2, lerp(p[2], p[3], 1.0 / 3), 0.5)};
}

std::vector<Segment> read_segments(ParameterList& list) {
  const int degree = list.integer("degree", 3);
  if (degree != 2 && degree != 3) fail(list.place_of("degree"), "\"degree\" of a curve must be 2 or 3");
  const std::string basis = list.string("basis", "bezier");
  if (basis != "bezier" && basis != "bspline")
    fail(list.place_of("basis"), "unknown basis \"" + basis + "\"; use bezier or bspline");
  const Place place = list.place_of("P");
  const Points3 points = list.take_points3("P");
  const size_t order = static_cast<size_t>(degree), count = points.size();
  const bool is_bezier = basis == "bezier";
  if (count < order + 1 || (is_bezier && (count - 1) % order != 0))
    fail(place, "\"P\" has " + std::to_string(count) + " points; a curve of degree " + std::to_string(degree) +
                    " and basis " + basis + " takes " + std::to_string(degree + 1) +
                    (is_bezier ? " and " + std::to_string(degree) + " more for each further segment" : " or more"));
  std::vector<Segment> segments;
  for (size_t i = 0; i + order < count; i += is_bezier ? order : 1) {
    const Vec3d* p = points.data() + i;
    if (!is_bezier)
      segments.push_back(segment_of_spline(p, degree));
    else
      segments.push_back(degree == 2 ? raised(p[0], p[1], p[2]) : Segment{p[0], p[1], p[2], p[3]});
  }
  return segments;
}

std::vector<Vec3d> read_ribbon_normals(ParameterList& list, size_t count) {
  const Place place = list.place_of("N");
  std::vector<Vec3d> normals;
  for (const Vec3f& n : list.take_normals("N")) {
    const Vec3d normal = convert<double>(n);
    if (!(length_squared(normal) > 0)) fail(place, "\"N\" of a ribbon has a normal of length 0");
    normals.push_back(normalize(normal));
  }
  if (normals.size() != count)
    fail(place, "\"N\" has " + std::to_string(normals.size()) + " normals; a ribbon of this many points takes " +
                    std::to_string(count) + ", one at each end of a segment");
  return normals;
}

}  // namespace

Mesh tessellated_curve(const Curve& curve) {
  std::vector<Station> stations = stations_of(curve);
  if (stations.size() < 2) return {};
  return curve.normals.empty() ? tube(std::move(stations), curve) : strip(stations, curve);
}

uint32_t read_curve(Build& build, ParameterList& list) {
  Curve curve;
  const std::string type = list.string("type", "flat");
  if (type != "flat" && type != "cylinder" && type != "ribbon")
    fail(list.place_of("type"), "unknown type of curve \"" + type + "\"; use flat, cylinder or ribbon");
  curve.segments = read_segments(list);
  if (type == "ribbon")
    curve.normals = read_ribbon_normals(list, curve.segments.size() + 1);
  else
    list.ignore({"N"});
  curve.sides = type == "flat" ? 6 : 12;
  const double width = list.number("width", 1);
  curve.width0 = list.number("width0", width);
  curve.width1 = list.number("width1", width);
  if (!(curve.width0 >= 0 && curve.width1 >= 0))
    fail(list.place_of(curve.width0 >= 0 ? "width1" : "width0"), "the width of a curve cannot be negative");
  list.ignore({"splitdepth"});
  if (!(std::max(curve.width0, curve.width1) > 0)) return no_index;
  Mesh mesh = tessellated_curve(curve);
  return mesh.indices.empty() ? no_index : add_mesh(build, list, std::move(mesh));
}

}  // namespace alhazen::impl::pbrt
