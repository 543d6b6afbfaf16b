// PLY files that can be read: every format and type, skipped data, faces and strips, and warnings.

#include "io/ply/ply.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/ply_files.h"

namespace alhazen::impl::test {
namespace {

void expect_triangle(const Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(Ply, Ascii) {
  const Mesh mesh = parse_bytes(ply_header("ascii", triangle_elements) + triangle_rows);
  expect_triangle(mesh);
  EXPECT_EQ(mesh.name, "test.ply");
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, AsciiWithCarriageReturnsBlankLinesAndNoLastLineEnd) {
  std::string text = ply_header("ascii", "comment made by hand\nobj_info none\n\n" + triangle_elements) +
                     "0 0 0\n\n  1\t0 0 \n0 +1.0e0 0\n\n3 0 1 2";
  for (size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 2)) text.insert(at, "\r");
  expect_triangle(parse_bytes(text));
}

template <class Value>
void expect_type(const std::string& type) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    BinaryRows rows(order);
    for (const int value : {0, 1, 2, 3, 4, 5, 6, 7, 127}) rows.add(static_cast<Value>(value));
    rows.add<uint8_t>(3).add<int32_t>(2).add<int32_t>(0).add<int32_t>(1);
    const std::string elements = "element vertex 3\nproperty " + type + " x\nproperty " + type + " y\nproperty " +
                                 type + " z\nelement face 1\nproperty list uchar int vertex_indices\n";
    const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    const Mesh mesh = parse_bytes(ply_header(format, elements) + rows.text());
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 1, 2}, {3, 4, 5}, {6, 7, 127}})) << type << " " << format;
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{2, 0, 1})) << type << " " << format;
  }
}

TEST(Ply, CoordinatesOfEveryType) {
  for (const char* const name : {"char", "int8"}) expect_type<int8_t>(name);
  for (const char* const name : {"uchar", "uint8"}) expect_type<uint8_t>(name);
  for (const char* const name : {"short", "int16"}) expect_type<int16_t>(name);
  for (const char* const name : {"ushort", "uint16"}) expect_type<uint16_t>(name);
  for (const char* const name : {"int", "int32"}) expect_type<int32_t>(name);
  for (const char* const name : {"uint", "uint32"}) expect_type<uint32_t>(name);
  for (const char* const name : {"float", "float32"}) expect_type<float>(name);
  for (const char* const name : {"double", "float64"}) expect_type<double>(name);
}

template <class Length, class Index>
void expect_list(const std::string& length, const std::string& index) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    BinaryRows rows(order);
    for (int i = 0; i < 12; ++i) rows.add(static_cast<float>(i) + 0.25f);
    rows.add(static_cast<Length>(4));
    for (const int i : {3, 2, 1, 0}) rows.add(static_cast<Index>(i));
    const std::string elements =
        "element vertex 4\n" + xyz + "element face 1\nproperty list " + length + " " + index + " vertex_index\n";
    const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    const Mesh mesh = parse_bytes(ply_header(format, elements) + rows.text());
    EXPECT_EQ(mesh.positions.at(1), (Vec3d{3.25, 4.25, 5.25})) << format;
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{3, 2, 1, 3, 1, 0})) << length << " " << index << " " << format;
  }
}

TEST(Ply, ListsOfEveryIntegerType) {
  expect_list<int8_t, uint32_t>("char", "uint");
  expect_list<uint8_t, int32_t>("uint8", "int32");
  expect_list<int16_t, uint16_t>("short", "ushort");
  expect_list<uint16_t, int16_t>("uint16", "int16");
  expect_list<int32_t, uint8_t>("int", "uchar");
  expect_list<uint32_t, int8_t>("uint32", "int8");
}

TEST(Ply, NegativeAndLargeValues) {
  BinaryRows rows(std::endian::big);
  rows.add<int8_t>(-128).add<int16_t>(-32768).add<int32_t>(std::numeric_limits<int32_t>::min());
  rows.add<uint8_t>(3).add<uint32_t>(0).add<uint32_t>(0).add<uint32_t>(0);
  const Mesh mesh = parse_bytes(ply_header("binary_big_endian",
                                           "element vertex 1\nproperty char x\nproperty short y\nproperty int z\n"
                                           "element face 1\nproperty list uchar uint vertex_indices\n") +
                                rows.text());
  EXPECT_EQ(mesh.positions.at(0), (Vec3d{-128, -32768, -2147483648.0}));
  EXPECT_EQ(mesh.triangle_count(), 1u) << "a triangle of one point is kept";
}

TEST(Ply, AnyOrderAndUnknownPropertiesAndElements) {
  const std::string elements =
      "element material 2\nproperty list uchar float ambient\nproperty int id\n"
      "element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\nproperty list int double "
      "texcoord\n"
      "element nothing 4000000000\n"
      "element vertex 3\nproperty uchar red\nproperty float t\nproperty float z\nproperty float nz\n"
      "property list uchar int neighbours\nproperty float s\nproperty double x\nproperty float ny\nproperty float y\n"
      "property float nx\n";
  const auto expect = [](const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0.5, 2, 1}, {1.5, 3, 2}, {2.5, 4, 3}}));
    EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2f>{{0, 0.5f}, {1, 0.5f}, {2, 0.5f}}));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 2, 2, 0}));
  };
  expect(parse_bytes(ply_header("ascii", elements) +
                     "3 0.1 0.2 0.3 7\n0 8\n255 3 0 1 2 2 0.5 0.5\n1 3 2 2 0 0\n"
                     "9 0.5 1 1 2 5 6 0 0.5 0 2 0\n9 0.5 2 0 0 1 1.5 1 3 0\n9 0.5 3 0 1 5 2 2.5 0 4 1\n"));

  BinaryRows rows(std::endian::little);
  rows.add<uint8_t>(3).add(0.1f).add(0.2f).add(0.3f).add<int32_t>(7).add<uint8_t>(0).add<int32_t>(8);
  rows.add<uint8_t>(255).add<uint8_t>(3).add<int32_t>(0).add<int32_t>(1).add<int32_t>(2);
  rows.add<int32_t>(2).add(0.5).add(0.5);
  rows.add<uint8_t>(1).add<uint8_t>(3).add<int32_t>(2).add<int32_t>(2).add<int32_t>(0).add<int32_t>(0);
  for (int i = 0; i < 3; ++i) {
    const float f = static_cast<float>(i);
    rows.add<uint8_t>(9).add(0.5f).add(f + 1).add(i == 0 ? 1.0f : 0.0f);
    rows.add(static_cast<uint8_t>(i));
    for (int k = 0; k < i; ++k) rows.add<int32_t>(k);
    rows.add(f).add(i + 0.5).add(i == 1 ? 1.0f : 0.0f).add(f + 2).add(i == 2 ? 1.0f : 0.0f);
  }
  expect(parse_bytes(ply_header("binary_little_endian", elements) + rows.text()));
}

TEST(Ply, NamesOfTextureCoordinates) {
  using Names = std::pair<const char*, const char*>;
  for (const auto& [u, v] : {Names{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const std::string elements = "element vertex 1\n" + xyz + "property float " + u + "\nproperty float " + v +
                                 "\nelement face 1\nproperty list uchar int vertex_indices\n";
    EXPECT_EQ(parse_bytes(ply_header("ascii", elements) + "0 0 0 0.25 0.75\n3 0 0 0\n").uvs.at(0),
              (Vec2f{0.25f, 0.75f}));
  }
}

TEST(Ply, PolygonsAreCutIntoFans) {
  const std::string elements = "element vertex 5\n" + xyz + "element face 2\nproperty list uchar int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n5 4 3 2 1 0\n4 0 1 2 3\n";
  EXPECT_EQ(parse_bytes(ply_header("ascii", elements) + rows).indices,
            (std::vector<uint32_t>{4, 3, 2, 4, 2, 1, 4, 1, 0, 0, 1, 2, 0, 2, 3}));
}

TEST(Ply, StripsKeepTheirWinding) {
  const std::string elements =
      "element vertex 5\n" + xyz + "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n9 0 1 2 3 4 -1 4 3 2\n";
  EXPECT_EQ(parse_bytes(ply_header("ascii", elements) + rows).indices,
            (std::vector<uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 2}));
}

TEST(Ply, NumbersBeyondDoubles) {
  const Mesh mesh =
      parse_bytes(ply_header("ascii", triangle_elements) + "1e-400 -0.1 1E2\n-1e-999 .5 5.\n1e308 +3 -0\n3 0 1 2");
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, -0.1, 100}, {0, 0.5, 5}, {1e308, 3, 0}}));
}

TEST(Ply, FilesPlainAndCompressed) {
  // Larger than the buffer, so that values cross its end.
  constexpr int count = 40000;
  std::string ascii_rows;
  BinaryRows binary_rows(std::endian::little);
  for (int i = 0; i < count; ++i) {
    ascii_rows += std::to_string(i) + ".5 0 -" + std::to_string(i) + "\n";
    binary_rows.add(static_cast<float>(i) + 0.5f).add(0.0f).add(static_cast<float>(-i));
  }
  for (int i = 2; i < count; ++i) {
    ascii_rows += "3 0 " + std::to_string(i - 1) + " " + std::to_string(i) + "\n";
    binary_rows.add<uint8_t>(3).add(0).add(i - 1).add(i);
  }
  const std::string elements = "element vertex " + std::to_string(count) + "\n" + xyz + "element face " +
                               std::to_string(count - 2) + "\nproperty list uchar int vertex_indices\n";
  const TemporaryPly file;
  for (const std::string& text : {ply_header("ascii", elements) + ascii_rows,
                                  ply_header("binary_little_endian", elements) + binary_rows.text()}) {
    for (const bool compressed : {false, true}) {
      compressed ? file.write_compressed(text) : file.write(text);
      Diagnostics diagnostics;
      const Mesh mesh = read_ply(file.path(), diagnostics);
      EXPECT_TRUE(diagnostics.warnings().empty());
      EXPECT_EQ(mesh.name, file.path());
      ASSERT_EQ(mesh.positions.size(), size_t{count});
      ASSERT_EQ(mesh.triangle_count(), size_t{count - 2});
      EXPECT_EQ(mesh.positions[count - 1], (Vec3d{count - 0.5, 0, 1 - count}));
      EXPECT_EQ(mesh.indices.back(), uint32_t{count - 1});
      if (!compressed) {
        EXPECT_EQ(mesh.positions.capacity(), mesh.positions.size());
        EXPECT_EQ(mesh.indices.capacity(), mesh.indices.size());
      }
    }
  }
}

TEST(Ply, Warnings) {
  const auto warning = [](const std::string& text, size_t normals, size_t uvs, size_t triangles) {
    Diagnostics diagnostics;
    const Mesh mesh = parse_bytes(text, diagnostics);
    EXPECT_EQ(mesh.normals.size(), normals);
    EXPECT_EQ(mesh.uvs.size(), uvs);
    EXPECT_EQ(mesh.triangle_count(), triangles);
    return diagnostics.warnings().size() == 1 ? diagnostics.warnings()[0].to_string() : "not one warning";
  };
  const std::string normal = "property float nx\nproperty float ny\nproperty float nz\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";

  EXPECT_EQ(warning(ply_header("ascii", "element vertex 1\n" + xyz) + "0 0 0\n", 0, 0, 0),
            "test.ply: the mesh has no faces");
  EXPECT_EQ(warning(ply_header("ascii", "element vertex 0\n" + xyz + "element face 0\n"), 0, 0, 0),
            "test.ply: the mesh has no faces");
  EXPECT_EQ(warning(ply_header("ascii", triangle_elements) + triangle_rows + "\n 3 0 1 2\n", 0, 0, 1),
            "test.ply:15:2: data after the last element are ignored");
  for (const char* const bad : {"0 0 0", "nan 0 1", "0 1e39 0", "0 0 1e-30"})
    EXPECT_EQ(warning(ply_header("ascii", "element vertex 3\n" + xyz + normal + faces) + "0 0 0 0 0 1\n1 0 0 " + bad +
                          "\n0 1 0 0 0 1\n3 0 1 2\n",
                      0, 0, 1),
              "test.ply: the normal of vertex 1 has no direction: all normals are ignored");
  EXPECT_EQ(warning(ply_header("ascii", "element vertex 1\n" + xyz + "property float u\nproperty float v\n" + faces) +
                        "0 0 0 inf 0\n3 0 0 0\n",
                    0, 0, 1),
            "test.ply: the uv of vertex 0 is not finite: all uvs are ignored");
  EXPECT_EQ(
      warning(ply_header("ascii", "element vertex 1\n" + xyz + "property float nx\n" + faces) + "0 0 0 1\n3 0 0 0", 0,
              0, 1),
      "test.ply:3: some of nx, ny, nz are missing: the normals are ignored");
}

}  // namespace
}  // namespace alhazen::impl::test
