// Tangents of glTF meshes that lack them.

#include <array>

#include "geometry/tangents.h"
#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {
namespace {

/// Two triangles with a common edge from (1, 0, 0) to (1, 1, 0), the second of them raised; the edge has two vertices
/// at each end if `is_split`. u runs along x; that of the second triangle runs back if `is_mirrored`.
Mesh strip(bool is_split, bool is_mirrored) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 1}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {is_mirrored ? 0.0f : 2.0f, 0}};
  mesh.normals.assign(4, Vec3f{-0.38268343f, 0, 0.92387953f});
  mesh.indices = {0, 1, 2, 1, 3, 2};
  if (is_split) {
    for (const size_t i : {1u, 2u}) {
      mesh.positions.push_back(Vec3d(mesh.positions[i]));
      mesh.uvs.push_back(Vec2f(mesh.uvs[i]));
      mesh.normals.push_back(Vec3f(mesh.normals[i]));
    }
    mesh.indices = {0, 1, 2, 4, 3, 5};
  }
  return mesh;
}

Vec3d tangent(const Mesh& mesh, size_t vertex) {
  const auto& t = mesh.tangents.at(vertex);
  return {static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])};
}

TEST(GltfTangents, AreSharedAcrossEdges) {
  for (const bool is_split : {false, true}) {
    Mesh mesh = strip(is_split, false);
    gltf::add_tangents(mesh, 0);
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    // In the plane of the normal, which tilts back by 22.5 degrees.
    expect_point(tangent(mesh, 1), {0.92387953, 0, 0.38268343}, 1e-6);
    expect_point(tangent(mesh, 0), {0.92387953, 0, 0.38268343}, 1e-6);
    if (is_split) {
      EXPECT_EQ(mesh.tangents[4], mesh.tangents[1]);
      EXPECT_EQ(mesh.tangents[5], mesh.tangents[2]);
    }
    for (const auto& t : mesh.tangents) EXPECT_EQ(t[3], 1);
  }
}

TEST(GltfTangents, AreTheMeanByAngle) {
  // Two triangles in a plane at one vertex with angles of 90 and 45 degrees; u of the second is rotated by 90 degrees.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, Vec3f{0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  // In the second: p2 - p0 = (0, 1) at uv (0, 1), p3 - p0 = (-1, 1) at uv (1, 1): dp/du = (-1, 0), reversed.
  gltf::add_tangents(mesh, 0);
  ASSERT_EQ(mesh.positions.size(), 6u);
  // So the two common vertices are duplicated.
  expect_point(tangent(mesh, 0), {1, 0, 0});
  EXPECT_EQ(mesh.tangents[0][3], 1);
  EXPECT_EQ(mesh.tangents[3][3], -1);
  expect_point(tangent(mesh, 3), {-1, 0, 0});
  mesh.tangents.clear();
  mesh = {};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, Vec3f{0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {-1, 2}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  // dp/du of the second: (-1, 1) = -dp/du + 2 dp/dv with dp/dv = (0, 1): dp/du = (1, 1).
  gltf::add_tangents(mesh, 0);
  const Vec3d expected = normalize(Vec3d{2, 0, 0} + normalize(Vec3d{1, 1, 0}));
  expect_point(tangent(mesh, 0), expected, 1e-6);
}

TEST(GltfTangents, OfMirroredUvsDivideVertices) {
  Mesh mesh = strip(false, true);
  gltf::add_tangents(mesh, 0);
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.uvs.size(), 6u);
  EXPECT_EQ(mesh.normals.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    const uint32_t vertex = mesh.indices[i];
    EXPECT_EQ(mesh.tangents[vertex][3], i < 3 ? 1 : -1);
    EXPECT_EQ(tangent(mesh, vertex).x > 0, i < 3);
  }
  EXPECT_EQ(mesh.positions[mesh.indices[3]].x, 1);
}

TEST(GltfTangents, StandWhatSaysNothing) {
  Mesh mesh = strip(false, false);
  mesh.uvs.assign(4, Vec2f{});
  gltf::add_tangents(mesh, 0);
  for (const auto& t : mesh.tangents) EXPECT_EQ(t, (std::array<float, 4>{0, 0, 0, 1}));
  mesh = strip(false, false);
  mesh.normals.clear();
  gltf::add_tangents(mesh, 0);
  EXPECT_TRUE(mesh.tangents.empty());
  mesh = strip(false, false);
  gltf::add_tangents(mesh, 1);
  EXPECT_TRUE(mesh.tangents.empty());
}

TEST(GltfTangents, AreMadeForNormalMapsAlone) {
  GltfFile file;
  const int texture = file.add_texture();
  json primitive = file.triangle();
  primitive["attributes"]["NORMAL"] = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  file.root["materials"] = {json::object(), {{"normalTexture", {{"index", texture}}}}};
  for (const int material : {0, 1}) {
    primitive["material"] = material;
    file.add_node({{"mesh", file.add_mesh(primitive)}});
  }
  const ParsedGltf parsed = file.parse();
  EXPECT_TRUE(parsed.mesh(0).tangents.empty());
  ASSERT_EQ(parsed.mesh(1).tangents.size(), 3u);
  expect_point(tangent(parsed.mesh(1), 0), {1, 0, 0});
  EXPECT_EQ(parsed.mesh(1).tangents[0][3], 1);
}

}  // namespace
}  // namespace alhazen::impl::test
