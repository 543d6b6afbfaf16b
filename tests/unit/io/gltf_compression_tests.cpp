// Meshes of glTF files compressed by meshoptimizer and by Draco: intact, damaged and truncated.

#include "unit/io/gltf_support.h"

#ifdef ALHAZEN_WITH_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef ALHAZEN_WITH_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace alhazen::impl::test {

namespace {

/// Decodes with every byte of the compressed data changed in turn: gives a mesh or an error, and never crashes.
void expect_error_or_mesh(GltfFile file, size_t offset, size_t size) {
  for (size_t i = offset; i < offset + size; ++i)
    for (const uint8_t change : {uint8_t{0x01}, uint8_t{0x80}, uint8_t{0xff}}) {
      GltfFile damaged = file;
      damaged.data[i] = static_cast<uint8_t>(damaged.data[i] ^ change);
      const std::string error = damaged.error();
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}

#ifdef ALHAZEN_WITH_MESHOPTIMIZER

TEST(GltfCompression, DecodesMeshoptimizer) {
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 5};
  const std::vector<uint32_t> indices{0, 1, 2, 2, 1, 3};
  std::vector<uint8_t> vertices(meshopt_encodeVertexBufferBound(4, 12)),
      triangles(meshopt_encodeIndexBufferBound(indices.size(), 4));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 4, 12));
  meshopt_encodeIndexVersion(1);
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));

  GltfFile file;
  const int vertex_view = file.view(vertices), triangle_view = file.view(triangles);
  const auto compress = [&](int view, const std::string& mode, size_t count, size_t stride) {
    json& description = file.root["bufferViews"][static_cast<size_t>(view)];
    json extension = description;
    extension["mode"] = mode;
    extension["count"] = count;
    extension["byteStride"] = stride;
    description["extensions"]["EXT_meshopt_compression"] = extension;
  };
  compress(vertex_view, "ATTRIBUTES", 4, 12);
  compress(triangle_view, "TRIANGLES", 6, 4);
  json primitive;
  primitive["attributes"]["POSITION"] =
      file.add_accessor({{"bufferView", vertex_view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  primitive["indices"] =
      file.add_accessor({{"bufferView", triangle_view}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}});
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const ParsedGltf parsed = file.parse();
  expect_point(parsed.mesh().positions[3], {1, 1, 5});
  EXPECT_EQ(parsed.mesh().indices.size(), 6u);
  expect_error_or_mesh(file, 0, file.data.size());
  file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 1'000'000'000;
  EXPECT_NE(file.error().find("too short for 1000000000 items"), std::string::npos) << file.error();
}

#endif

#ifdef ALHAZEN_WITH_DRACO

TEST(GltfCompression, DecodesDraco) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(1);
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0, 1, 5};
  builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(0), a, b, c);
  const auto mesh = builder.Finalize();
  ASSERT_TRUE(mesh);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

  GltfFile file;
  const int view = file.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
  json primitive;
  primitive["attributes"]["POSITION"] = file.add_accessor({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const ParsedGltf parsed = file.parse();
  ASSERT_EQ(parsed.mesh().indices.size(), 3u);
  double highest = 0;
  for (const Vec3d& p : parsed.mesh().positions) highest = std::max(highest, p.z);
  EXPECT_NEAR(highest, 5, 1e-3);
  expect_error_or_mesh(file, 0, file.data.size());
  file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 7;
  EXPECT_NE(file.error().find("have no attribute 7"), std::string::npos) << file.error();
}

#endif

}  // namespace

}  // namespace alhazen::impl::test
