// Faces of more than three corners: concave ones are covered exactly once, the others become fans.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "geometry/ear_clipping.h"
#include "io/ply/parse_ply.h"
#include "support/effort.h"
#include "support/random.h"

namespace alhazen::impl::test {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

double area_of(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

double area_of(const std::vector<Vec2d>& polygon) {
  double sum = 0;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) sum += area_of(polygon[0], polygon[i], polygon[i + 1]);
  return sum;
}

/// Correctly oriented triangles whose total area is that of the polygon cover it once. Their number must be right, and
/// each edge of the polygon must be an edge of one of them.
void expect_cover(const std::vector<Vec2d>& polygon, const Triangles& triangles, const char* name) {
  const double area = area_of(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << name;
  double sum = 0;
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : triangles) {
    const double part = area_of(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GE(part, -1e-12 * area) << name;
    sum += std::abs(part);
    for (size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  EXPECT_NEAR(sum, area, 1e-9 * area) << name;
  for (uint32_t i = 0; i < polygon.size(); ++i)
    EXPECT_EQ((edges[{i, static_cast<uint32_t>((i + 1) % polygon.size())}]), 1) << name << ", edge " << i;
}

void expect_triangulated(const std::vector<Vec2d>& polygon, const char* name) {
  EarClipper clipper;
  const auto triangles = clipper.triangulate(polygon);
  expect_cover(polygon, {triangles.begin(), triangles.end()}, name);
}

std::vector<Vec2d> star(int points, double inner) {
  std::vector<Vec2d> polygon;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points, radius = i % 2 == 0 ? 1 : inner;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return polygon;
}

std::vector<Vec2d> comb(int teeth) {
  std::vector<Vec2d> polygon{{0, -1}, {static_cast<double>(teeth), -1}};
  for (int i = teeth; i-- > 0;) {
    polygon.push_back({i + 0.75, 5});
    polygon.push_back({i + 0.25, 0});
  }
  return polygon;
}

std::vector<Vec2d> spiral(int steps) {
  std::vector<Vec2d> polygon;
  const auto at = [&](int i, double radius) {
    const double angle = 0.1 * i;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  };
  for (int i = 0; i < steps; ++i) at(i, 1 + 0.02 * i);
  for (int i = steps; i-- > 0;) at(i, 0.5 + 0.02 * i);
  return polygon;
}

TEST(EarClipping, Polygons) {
  expect_triangulated({{0, 0}, {1, 0}, {0, 1}}, "triangle");
  expect_triangulated({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, "square");
  expect_triangulated({{0, 0}, {2, 1}, {4, 0}, {2, 4}}, "dart");
  expect_triangulated({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {4, 3}, {4, 4}, {0, 4}}, "C");
  expect_triangulated({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}, "L with corners on its sides");
  expect_triangulated(star(5, 0.3), "star");
  expect_triangulated(star(50, 0.02), "thin star");
  expect_triangulated(comb(40), "comb");
  expect_triangulated(spiral(200), "spiral");
}

TEST(EarClipping, EveryStart) {
  const std::vector<Vec2d> c{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {4, 3}, {4, 4}, {0, 4}};
  for (size_t first = 0; first < c.size(); ++first) {
    std::vector<Vec2d> turned(c);
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    expect_triangulated(turned, "C");
  }
}

/// Checks areas alone: an edge that occurs twice in the outline belongs to two triangles.
double covered_area(const std::vector<Vec2d>& polygon) {
  EarClipper clipper;
  double sum = 0;
  for (const auto& [a, b, c] : clipper.triangulate(polygon)) {
    const double area = area_of(polygon[a], polygon[b], polygon[c]);
    EXPECT_GE(area, 0);
    sum += area;
  }
  return sum;
}

TEST(EarClipping, OutlinesThatTouchThemselves) {
  // A square with a square hole, joined by a bridge that is traversed twice.
  EXPECT_EQ(covered_area({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}), 12);
  // Two holes on one bridge.
  EXPECT_EQ(covered_area({{0, 0},
                          {9, 0},
                          {9, 4},
                          {0, 4},
                          {0, 0},
                          {1, 1},
                          {1, 3},
                          {3, 3},
                          {3, 1},
                          {5, 1},
                          {5, 3},
                          {7, 3},
                          {7, 1},
                          {5, 1},
                          {3, 1},
                          {1, 1}}),
            28);
  // Two squares with a common corner, as one outline.
  EXPECT_EQ(covered_area({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}), 2);
  // A corner that touches the opposite side.
  EXPECT_EQ(covered_area({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}), 8);
  // Corners that repeat, and a needle out and back.
  EXPECT_EQ(covered_area({{0, 0}, {0, 0}, {2, 1}, {4, 0}, {4, 0}, {4, 0}, {2, 4}, {2, 4}}), 6);
  EXPECT_EQ(covered_area({{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 9}, {2, 4}, {0, 4}}), 16);
}

/// Random radii about a centre, seen from outside of it: simple, with about every other corner reflex.
TEST(EarClipping, RandomOutlines) {
  test::Random random(1);
  for (int count = 4; count < 200; ++count) {
    std::vector<Vec2d> polygon;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count, radius = random.magnitude_between(0.2, 5);
      polygon.push_back({100 + radius * std::cos(angle), radius * std::sin(angle)});
    }
    expect_triangulated(polygon, "random");
  }
}

/// Random self-intersecting and degenerate outlines: triangulation ends, with the right number of triangles.
TEST(EarClipping, AnyOutlineEnds) {
  test::Random random(2);
  EarClipper clipper;
  for (const int count : {3, 4, 5, 17, 1000}) {
    std::vector<Vec2d> crossing, line, point, grid;
    for (int i = 0; i < count; ++i) {
      crossing.push_back({random.uniform<double>(), random.uniform<double>()});
      line.push_back({random.uniform<double>(), 0});
      point.push_back({1, 1});
      grid.push_back({static_cast<double>(random.below(3)), static_cast<double>(random.below(3))});
    }
    for (const std::vector<Vec2d>& polygon : {crossing, line, point, grid})
      EXPECT_EQ(clipper.triangulate(polygon).size(), polygon.size() - 2);
  }
}

/// 100,000 corners: quadratic time would take a minute.
TEST(EarClipping, LargePolygonsTakeLittleTime) {
  test::Random random(3);
  std::vector<Vec2d> rough, crossing;
  const int count = static_cast<int>(test::effort(100'000));
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = random.magnitude_between(0.5, 1);
    rough.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    crossing.push_back({random.uniform<double>(), random.uniform<double>()});
  }
  EarClipper clipper;
  for (const std::vector<Vec2d>& polygon :
       {rough, comb(count / 2), spiral(count / 2), star(count / 2, 0.001), crossing}) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(clipper.triangulate(polygon).size(), polygon.size() - 2);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 10);
  }
}

std::string ply_of(const std::string& vertices, const std::string& faces, bool faces_first = false) {
  const auto lines = [](const std::string& text) { return std::to_string(std::count(text.begin(), text.end(), '\n')); };
  const std::string vertex =
      "element vertex " + lines(vertices) + "\nproperty double x\nproperty double y\nproperty double z\n";
  const std::string face = "element face " + lines(faces) + "\nproperty list uchar int vertex_indices\n";
  return "ply\nformat ascii 1.0\n" + (faces_first ? face + vertex : vertex + face) + "end_header\n" +
         (faces_first ? faces + vertices : vertices + faces);
}

Mesh parse(const std::string& text) {
  MemorySource source(text);
  Diagnostics diagnostics;
  return parse_ply(source, "test.ply", diagnostics);
}

using Indices = std::vector<uint32_t>;

TEST(PlyPolygons, FansWhereTheyAreRight) {
  const std::string dart = "0 0 0\n2 1 0\n4 0 0\n2 4 0\n";
  EXPECT_EQ(parse(ply_of(dart, "4 1 2 3 0\n")).indices, Indices({1, 2, 3, 1, 3, 0})) << "seen whole from its notch";
  EXPECT_EQ(parse(ply_of(dart, "4 3 0 1 2\n")).indices, Indices({3, 0, 1, 3, 1, 2}));
  const std::string bent = "0 0 0\n1 0 0\n1 1 0.4\n0 1 0\n";
  EXPECT_EQ(parse(ply_of(bent, "4 0 1 2 3\n4 1 2 3 0\n")).indices, Indices({0, 1, 2, 0, 2, 3, 1, 2, 3, 1, 3, 0}));
  const std::string hexagon = "0 0 0\n1 0 0\n2 0 0\n2 2 0\n1 2 0\n0 2 0\n";
  EXPECT_EQ(parse(ply_of(hexagon, "6 0 1 2 3 4 5\n")).indices, Indices({0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5}));
  EXPECT_EQ(parse(ply_of("0 0 0\n1 1 0\n1 0 0\n0 1 0\n", "4 0 1 2 3\n")).indices, Indices({0, 1, 2, 0, 2, 3}))
      << "crosses itself and has no area";
}

TEST(PlyPolygons, ConcaveFacesInEveryPlane) {
  for (const char* const dart :
       {"0 0 0\n2 1 0\n4 0 0\n2 4 0\n", "0 0 0\n0 2 1\n0 4 0\n0 2 4\n", "0 0 0\n1 0 2\n0 0 4\n4 0 2\n",
        "1e9 1e9 0\n1000000002 1000000001 0\n1000000004 1e9 0\n1000000002 1000000004 0\n",
        "0 0 0\n2e-30 1e-30 0\n4e-30 0 0\n2e-30 4e-30 0\n", "0 0 0.1\n2 1 -0.1\n4 0 0.2\n2 4 0\n"})
    for (const bool faces_first : {false, true}) {
      EXPECT_EQ(parse(ply_of(dart, "4 0 1 2 3\n", faces_first)).indices, Indices({3, 0, 1, 3, 1, 2})) << dart;
      EXPECT_EQ(parse(ply_of(dart, "4 3 2 1 0\n", faces_first)).indices.size(), 6u);
      EXPECT_EQ(parse(ply_of(dart, "4 2 1 0 3\n", faces_first)).indices.size(), 6u);
    }
}

/// The area of the mesh is that of its faces, also if they are mixed with triangles and quads and repeat vertices.
TEST(PlyPolygons, FacesOfManyKinds) {
  const std::string vertices = "0 0 1\n4 0 1\n4 1 1\n1 1 1\n1 3 1\n4 3 1\n4 4 1\n0 4 1\n";
  const Mesh mesh = parse(ply_of(vertices,
                                 "3 0 1 2\n8 0 1 2 3 4 5 6 7\n4 0 1 2 3\n4 4 5 6 7\n8 3 4 5 6 7 0 1 2\n"
                                 "9 0 1 2 3 4 5 5 6 7\n8 7 6 5 4 3 2 1 0\n"));
  double area = 0, along_z = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3d& p = mesh.positions[mesh.indices[i]];
    const Vec3d normal = cross(mesh.positions[mesh.indices[i + 1]] - p, mesh.positions[mesh.indices[i + 2]] - p) / 2.0;
    area += length(normal);
    along_z += normal.z;
  }
  // A triangle of 2, two quads of 3.5, four times the C of 10, the last of which is flipped.
  EXPECT_EQ(mesh.triangle_count(), 1u + 6 + 2 + 2 + 6 + 7 + 6);
  EXPECT_NEAR(area, 2 + 2 * 3.5 + 4 * 10, 1e-12);
  EXPECT_NEAR(along_z, 2 + 2 * 3.5 + 2 * 10, 1e-12);
}

/// Lines that end with a carriage return alone, in all three formats; the byte after the header may be a line feed.
TEST(PlyLineEnds, CarriageReturns) {
  std::string ascii = ply_of("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n");
  const Mesh expected = parse(ascii);
  std::string pairs = ascii;
  for (size_t at = pairs.find('\n'); at != pairs.npos; at = pairs.find('\n', at + 2)) pairs.insert(at, "\r");
  std::string mixed = ascii.substr(0, ascii.find("0 0 0"));
  std::replace(ascii.begin(), ascii.end(), '\n', '\r');
  mixed += ascii.substr(mixed.size());
  for (const std::string& text : {ascii, pairs, mixed, ascii.substr(0, ascii.size() - 1)}) {
    const Mesh mesh = parse(text);
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.indices, expected.indices);
  }
  for (const char* const end : {"\r", "\r\n", "\n"}) {
    std::string binary =
        "ply@format binary_little_endian 1.0@comment by hand@element vertex 3@property uchar x@property "
        "uchar y@property uchar z@element face 1@property list uchar uchar vertex_indices@end_header@";
    for (size_t at = binary.find('@'); at != binary.npos; at = binary.find('@')) binary.replace(at, 1, end);
    const Mesh mesh = parse(binary + std::string("\n\r\0"
                                                 "\1\0\0"
                                                 "\0\1\0"
                                                 "\3\0\1\2",
                                                 13));
    EXPECT_EQ(mesh.positions[0], (Vec3d{10, 13, 0}));
    EXPECT_EQ(mesh.indices, expected.indices);
  }
}

}  // namespace
}  // namespace alhazen::impl::test
