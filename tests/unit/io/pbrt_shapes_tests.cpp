// Shapes of pbrt scenes, and what they emit.

#include <cmath>
#include <limits>
#include <numbers>

#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

constexpr double pi = std::numbers::pi;

const Mesh& mesh_of(const Parsed& p, size_t shape = 0) {
  EXPECT_EQ(shapes(p).at(shape).type, ShapeType::mesh);
  return p.scene.meshes.at(shapes(p)[shape].mesh);
}

Vec3d face_normal(const Mesh& mesh, size_t triangle) {
  const Vec3d &a = mesh.positions[mesh.indices[3 * triangle]], &b = mesh.positions[mesh.indices[3 * triangle + 1]],
              &c = mesh.positions[mesh.indices[3 * triangle + 2]];
  return cross(b - a, c - a);
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (size_t i = 0; i < mesh.triangle_count(); ++i) area += length(face_normal(mesh, i)) / 2;
  return area;
}

TEST(PbrtShapes, Sphere) {
  const Parsed p = parse_world("Rotate 30 1 1 0 Scale 2 -2 2 Shape \"sphere\" \"float radius\" 3");
  const Shape& shape = shapes(p).at(0);
  EXPECT_EQ(shape.type, ShapeType::sphere);
  EXPECT_EQ(shape.radius, 3);
  EXPECT_EQ(shape.where.line, 2);
  EXPECT_EQ(shape.where.to_string(), "test.pbrt:2:30");
  EXPECT_TRUE(p.scene.meshes.empty());
}

TEST(PbrtShapes, SkewedSpheresBecomeMeshesWithOutwardNormals) {
  const Parsed p = parse_world("Scale 1 2 1 Shape \"sphere\" Shape \"sphere\"");
  const Mesh& mesh = mesh_of(p);
  EXPECT_EQ(p.scene.meshes.size(), 1u) << "alike shapes share one mesh";
  EXPECT_NEAR(area_of(mesh), 4 * pi, 0.02);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    expect_near(convert<double>(mesh.normals[i]), mesh.positions[i], 1e-6);
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    EXPECT_GT(dot(face_normal(mesh, i), mesh.positions[mesh.indices[3 * i]]), 0);
}

TEST(PbrtShapes, SpheresOfSkewedInstancesBecomeMeshes) {
  const Parsed p = parse_world(
      "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd ObjectBegin \"q\" Shape \"sphere\" ObjectEnd\n"
      "ObjectInstance \"q\" Scale 1 1 3 ObjectInstance \"o\"");
  EXPECT_EQ(p.scene.groups[1].shapes[0].type, ShapeType::mesh);
  EXPECT_EQ(p.scene.groups[2].shapes[0].type, ShapeType::sphere);
}

TEST(PbrtShapes, PartialSphereHasTheParametrisationOfPbrt) {
  const Parsed p =
      parse_world("Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 1 \"float phimax\" 90");
  const Mesh& mesh = mesh_of(p);
  EXPECT_NEAR(area_of(mesh), pi / 2 * 2 * 2, 0.01);  // phimax * radius * (zmax - zmin)
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d& q = mesh.positions[i];
    EXPECT_NEAR(static_cast<double>(mesh.uvs[i].x), std::atan2(q.y, q.x) / (pi / 2), 1e-6);
    EXPECT_NEAR(static_cast<double>(mesh.uvs[i].y), (std::acos(q.z / 2) - 2 * pi / 3) / (pi / 3 - 2 * pi / 3), 1e-6);
  }
}

TEST(PbrtShapes, DiskAsAMeshHasExactlyTheAreaOfTheCircleAndFacesUp) {
  const Parsed p = parse_world(
      "AreaLightSource \"diffuse\" Shape \"disk\" \"float radius\" 2 \"float height\" 5 "
      "Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float phimax\" 90");
  EXPECT_NEAR(area_of(mesh_of(p)), 4 * pi, 1e-12);
  EXPECT_NEAR(area_of(mesh_of(p, 1)), 3 * pi / 4, 1e-12);
  for (size_t i = 0; i < mesh_of(p).triangle_count(); ++i) EXPECT_GT(face_normal(mesh_of(p), i).z, 0);
  for (const Vec3d& q : mesh_of(p).positions) EXPECT_EQ(q.z, 5);
  EXPECT_EQ(mesh_of(p).uvs.front().y, 0) << "v is 0 at the rim";
}

TEST(PbrtShapes, Cylinder) {
  const Parsed p = parse_world(
      "Rotate 30 1 1 0 Scale 2 -1 0.5 Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 4 \"float zmax\" 1 "
      "\"float phimax\" 200 Shape \"cylinder\"");
  const Shape& shape = shapes(p).at(0);
  EXPECT_EQ(shape.type, ShapeType::cylinder);
  EXPECT_EQ(shape.radius, 2);
  EXPECT_EQ(shape.z_min, 1);
  EXPECT_EQ(shape.z_max, 4);
  EXPECT_EQ(shape.phi_max, 200);
  EXPECT_EQ(shapes(p).at(1).z_min, -1);
  EXPECT_EQ(shapes(p).at(1).z_max, 1);
  EXPECT_EQ(shapes(p).at(1).phi_max, 360);
  EXPECT_TRUE(p.scene.meshes.empty());
}

TEST(PbrtShapes, Disk) {
  const Parsed p = parse_world(
      "Rotate 30 1 1 0 Scale 2 -1 0.5 Shape \"disk\" \"float radius\" 2 \"float innerradius\" 0.5 \"float height\" 3 "
      "\"float phimax\" 200 Shape \"disk\"");
  const Shape& shape = shapes(p).at(0);
  EXPECT_EQ(shape.type, ShapeType::disk);
  EXPECT_EQ(shape.radius, 2);
  EXPECT_EQ(shape.inner_radius, 0.5);
  EXPECT_EQ(shape.z_min, 3);
  EXPECT_EQ(shape.z_max, 3);
  EXPECT_EQ(shape.phi_max, 200);
  EXPECT_EQ(shapes(p).at(1).inner_radius, 0);
  EXPECT_EQ(shapes(p).at(1).z_min, 0);
  EXPECT_TRUE(p.scene.meshes.empty());
}

TEST(PbrtShapes, DisksThatEmitOrMoveOrAreExtremelyThinBecomeMeshes) {
  const std::string move = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All ";
  for (const std::string& text :
       {std::string("AreaLightSource \"diffuse\" Shape \"disk\""), move + "Shape \"disk\"",
        std::string("Rotate 30 1 1 0 Scale 1e-5 1 1 Shape \"disk\""),
        "ObjectBegin \"o\" Shape \"disk\" ObjectEnd ObjectInstance \"o\" " + move + "ObjectInstance \"o\""})
    EXPECT_EQ(parse_world(text).scene.groups.back().shapes.at(0).type, ShapeType::mesh) << text;
}

TEST(PbrtShapes, CylindersThatEmitOrMoveOrAreExtremelyThinBecomeMeshes) {
  const std::string move = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All ";
  for (const std::string& text :
       {std::string("AreaLightSource \"diffuse\" Shape \"cylinder\""), move + "Shape \"cylinder\"",
        std::string("Rotate 30 1 1 0 Shape \"cylinder\" \"float radius\" 1e-5"),
        "ObjectBegin \"o\" Shape \"cylinder\" ObjectEnd ObjectInstance \"o\" " + move + "ObjectInstance \"o\""})
    EXPECT_EQ(parse_world(text).scene.groups.back().shapes.at(0).type, ShapeType::mesh) << text;
  const Parsed along_an_axis = parse_world("Shape \"cylinder\" \"float radius\" 1e-5");
  EXPECT_EQ(shapes(along_an_axis).at(0).type, ShapeType::cylinder) << "no rounding is magnified";
}

TEST(PbrtShapes, CylinderAsAMesh) {
  const Parsed p = parse_world(
      "AreaLightSource \"diffuse\" Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4");
  const Mesh& mesh = mesh_of(p);
  EXPECT_NEAR(area_of(mesh), 2 * pi * 2 * 3, 0.02);
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    EXPECT_GT(dot(face_normal(mesh, i), convert<double>(mesh.normals[mesh.indices[3 * i]])), 0);
}

TEST(PbrtShapes, TriangleMesh) {
  const Parsed p = parse_world(
      "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 2 3 0 ] \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0.5 ]\n"
      "\"point2 uv\" [ 0 0 1 0 1 1 0 1 ] \"vector3 S\" [ 1 0 0 1 0 0 1 0 0 1 0 0 ]");
  const Mesh& mesh = mesh_of(p);
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 2, 3, 0}));
  ASSERT_EQ(mesh.positions.size(), 4u);
  expect_near(mesh.positions[3], {0, 1, 0.5});
  EXPECT_EQ(mesh.uvs[2], (Vec2f{1, 1}));
  EXPECT_TRUE(mesh.normals.empty());
}

TEST(PbrtShapes, OneTriangleNeedsNoIndices) {
  const Parsed p = parse_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]");
  EXPECT_EQ(mesh_of(p).indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(PbrtShapes, WindingFollowsTheNormals) {
  const Parsed p = parse_world(
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "
      "\"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]");
  EXPECT_LT(face_normal(mesh_of(p), 0).z, 0);
}

TEST(PbrtShapes, FlatBilinearPatchIsTwoTriangles) {
  const Parsed p = parse_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 2 0 0 0 3 0 2 3 0 ]");
  const Mesh& mesh = mesh_of(p);
  EXPECT_EQ(mesh.triangle_count(), 2u);
  EXPECT_DOUBLE_EQ(area_of(mesh), 6);
  EXPECT_GT(face_normal(mesh, 0).z, 0);
  EXPECT_EQ(mesh.uvs[1], (Vec2f{1, 0}));
  EXPECT_EQ(mesh.uvs[2], (Vec2f{0, 1}));
}

TEST(PbrtShapes, CurvedBilinearPatchIsAGridOnIt) {
  const Parsed p = parse_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]");
  const Mesh& mesh = mesh_of(p);
  EXPECT_GT(mesh.triangle_count(), 32u);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(mesh.positions[i].z, mesh.positions[i].x * mesh.positions[i].y, 1e-12);
    const auto normal = convert<double>(mesh.normals[i]);
    expect_near(normal, normalize(Vec3d{-mesh.positions[i].y, -mesh.positions[i].x, 1}), 1e-6);
  }
}

/// An octahedron: its Loop surface is smooth, closed and symmetric.
const std::string octahedron =
    "\"point3 P\" [ 1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1 ]\n"
    "\"integer indices\" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5 ]";

TEST(PbrtShapes, LoopSubdivisionOfAnOctahedron) {
  const Parsed p = parse_world("Shape \"loopsubdiv\" \"integer levels\" 4 " + octahedron);
  const Mesh& mesh = mesh_of(p);
  EXPECT_EQ(mesh.triangle_count(), 8u * 256);
  EXPECT_EQ(mesh.positions.size(), 2u + 4 * 256);
  // The limit of a vertex of valence 4 is (v + its ring) weighted 1 - n g and g, with g = 1 / (n + 3 / (8 beta)): half
  // of v, as the ring is symmetric about the origin.
  expect_near(mesh.positions[0], {0.5, 0, 0}, 1e-12);
  double least = 1, most = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    least = std::min(least, length(mesh.positions[i]));
    most = std::max(most, length(mesh.positions[i]));
    EXPECT_GT(dot(convert<double>(mesh.normals[i]), normalize(mesh.positions[i])), 0.9);
  }
  EXPECT_GT(least / most, 0.8);
}

TEST(PbrtShapes, LoopSubdivisionKeepsAFlatSheetFlat) {
  const Parsed p = parse_world(
      "Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] "
      "\"integer indices\" [ 0 1 2 0 2 3 ]");
  for (const Vec3d& q : mesh_of(p).positions) EXPECT_EQ(q.z, 0);
  for (const Vec3f& n : mesh_of(p).normals) EXPECT_EQ(n, (Vec3f{0, 0, 1}));
}

/// A tube has the area of the cone frustum around it: 2 pi * the mean radius * the slant height.
TEST(PbrtShapes, StraightCurveIsATube) {
  const Parsed p = parse_world(
      "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ] \"string type\" \"cylinder\" "
      "\"float width0\" 0.4 \"float width1\" 0.2");
  const Mesh& mesh = mesh_of(p);
  EXPECT_NEAR(area_of(mesh), pi * (0.2 + 0.1) * std::hypot(3, 0.1), 0.01);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d& q = mesh.positions[i];
    EXPECT_NEAR(std::hypot(q.y, q.z), 0.2 - q.x / 30, 0.01);
    EXPECT_GT(q.y * static_cast<double>(mesh.normals[i].y) + q.z * static_cast<double>(mesh.normals[i].z), 0.09);
    EXPECT_NEAR(static_cast<double>(mesh.uvs[i].x), q.x / 3, 1e-6);
  }
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3d a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                c = mesh.positions[mesh.indices[i + 2]];
    Vec3d outward = a + b + c;
    outward.x = 0;
    EXPECT_GT(dot(cross(b - a, c - a), outward), 0) << "wound counter-clockwise as seen from outside";
  }
}

/// A quarter of a circle of radius 1, which a cubic follows to 0.03 %, as a ribbon perpendicular to its plane.
TEST(PbrtShapes, RibbonHasItsAreaAndNormals) {
  const Parsed p = parse_world(
      "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [ 1 0 0  1 0.5522847 0  0.5522847 1 0  0 1 0 ] "
      "\"normal3 N\" [ 0 0 1  0 0 1 ] \"float width\" 0.1");
  const Mesh& mesh = mesh_of(p);
  EXPECT_NEAR(area_of(mesh), 0.1 * pi / 2, 1e-3);
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(static_cast<double>(n.z), 1, 1e-6);
  EXPECT_NE(error_of("WorldBegin Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]")
                .find("\"N\""),
            std::string::npos);
}

/// The curve of a uniform B-spline begins at (p0 + 4 p1 + p2) / 6, with degree 2 at (p0 + p1) / 2.
TEST(PbrtShapes, SplinesAndDegrees) {
  const auto first_point = [](const std::string& parameters) {
    const Parsed p = parse_world("Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 0.01 " + parameters);
    return (mesh_of(p).positions[0] + mesh_of(p).positions[1]) / 2;
  };
  const std::string points = "\"point3 P\" [ 0 0 0  6 0 0  6 12 0  0 12 0  0 0 0 ] ";
  expect_near(first_point(points + "\"string basis\" \"bspline\" \"normal3 N\" [ 0 0 1 0 0 1 0 0 1 ]"), {5, 2, 0},
              1e-9);
  expect_near(first_point(points + "\"string basis\" \"bspline\" \"integer degree\" 2 "
                                   "\"normal3 N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ]"),
              {3, 0, 0}, 1e-9);
  expect_near(first_point(points + "\"integer degree\" 2 \"normal3 N\" [ 0 0 1 0 0 1 0 0 1 ]"), {0, 0, 0}, 1e-9);
  EXPECT_NE(error_of("WorldBegin Shape \"curve\" " + points).find("\"P\" has 5 points"), std::string::npos);
  EXPECT_TRUE(shapes(parse_world("Shape \"curve\" \"point3 P\" [ 1 1 1 1 1 1 1 1 1 1 1 1 ]")).empty());
}

TEST(PbrtShapes, Alpha) {
  const Parsed p = parse_world("Shape \"sphere\" \"float alpha\" 0 Shape \"sphere\" \"float alpha\" 1");
  EXPECT_EQ(shapes(p).size(), 1u);
  EXPECT_FALSE(p.warned("alpha"));
  const Parsed half = parse_world(
      "NamedMaterial \"later\" Shape \"sphere\" \"float alpha\" 0.5 Shape \"sphere\" Shape \"sphere\" \"float alpha\" "
      "0.5\n"
      "MakeNamedMaterial \"later\" \"string type\" \"dielectric\"");
  ASSERT_EQ(shapes(half).size(), 3u);
  EXPECT_EQ(material_of(half, shapes(half)[0]).kind, MaterialKind::dielectric);
  EXPECT_EQ(constant_of(half, material_of(half, shapes(half)[0]).alpha).x, 0.5);
  EXPECT_EQ(material_of(half, shapes(half)[1]).alpha, no_index);
  EXPECT_EQ(shapes(half)[0].material, shapes(half)[2].material);
}

TEST(PbrtAreaLights, EmissionOfTheShapesThatFollow) {
  const Parsed p = parse_world(
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2 \"bool twosided\" true\n"
      "Shape \"sphere\" AttributeEnd Shape \"sphere\" AreaLightSource \"diffuse\" Shape \"sphere\"");
  ASSERT_TRUE(shapes(p)[0].emission);
  expect_near(shapes(p)[0].emission->radiance, {2, 4, 6});
  EXPECT_TRUE(shapes(p)[0].emission->two_sided);
  EXPECT_FALSE(shapes(p)[1].emission);
  expect_near(shapes(p)[2].emission->radiance, {1, 1, 1});
}

TEST(PbrtAreaLights, PowerIsDistributedOverTheArea) {
  const Parsed p = parse_world(
      "Scale 2 2 2 AreaLightSource \"diffuse\" \"float power\" 100 Shape \"sphere\" "
      "Shape \"disk\" \"float radius\" 3");
  expect_near(shapes(p)[0].emission->radiance, splat(100 / (pi * 4 * pi * 4)), 1e-12);
  expect_near(shapes(p)[1].emission->radiance, splat(100 / (pi * pi * 36)), 1e-12);
}

}  // namespace
}  // namespace alhazen::impl::test
