// STL files, and PLY files with colours, as models.

#include <gtest/gtest.h>

#include <cstring>

#include "io/model.h"
#include "io/ply/parse_ply.h"
#include "io/read_scene.h"
#include "io/stl/stl.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {
namespace {

Mesh parse(const std::string& bytes) {
  Diagnostics diagnostics;
  return parse_stl(bytes, "m.stl", diagnostics);
}

std::string error_of(const std::string& bytes) {
  try {
    parse(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string ascii =
    "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex -0 1e0 0\nendloop\nendfacet\nendsolid part\n";

/// Two triangles of a square; the colours are those of the facets.
std::string binary(const std::string& header, uint16_t first, uint16_t second) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(uint32_t{2});
  const float positions[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};
  for (size_t facet = 0; facet < 2; ++facet) {
    for (int i = 0; i < 3; ++i) add(0.0f);
    for (const float value : positions[facet]) add(value);
    add(facet == 0 ? first : second);
  }
  return bytes;
}

TEST(Stl, AsciiAndBinaryGiveTheSameMesh) {
  const Mesh a = parse(ascii), b = parse(binary("made by a test", 0, 0));
  EXPECT_EQ(a.positions.size(), 4u);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(a.normals.empty() && b.colours.empty());
  EXPECT_EQ(parse(binary("solid in spite of its name", 0, 0).replace(40, 1, 1, '\0')).triangle_count(), 2u);
}

TEST(Stl, ColoursOfBothDialects) {
  const auto red_and_blue = [](const Mesh& mesh, size_t facet) {
    const auto& colour = mesh.colours.at(mesh.indices.at(3 * facet));
    return Vec2d{static_cast<double>(colour[0]), static_cast<double>(colour[2])};
  };
  // Of VisCAM: the highest bit says that the facet has a colour, whose red is highest.
  const Mesh viscam = parse(binary("", 0x8000 | 31 << 10, 0));
  EXPECT_EQ(viscam.colours.size(), 6u) << "corners of different colours are apart";
  EXPECT_EQ(red_and_blue(viscam, 0), (Vec2d{1, 0}));
  EXPECT_EQ(red_and_blue(viscam, 1), (Vec2d{0.5, 0.5}));
  // Of Magics: the bit says that the facet has the colour of the header; else red is lowest.
  const Mesh magics = parse(binary(std::string("COLOR=\0\0\xff\xff", 10), 0x8000, 31));
  EXPECT_EQ(red_and_blue(magics, 0), (Vec2d{0, 1}));
  EXPECT_EQ(red_and_blue(magics, 1), (Vec2d{1, 0}));
}

TEST(Stl, Errors) {
  EXPECT_EQ(error_of("short"),
            "m.stl: the file has 5 bytes; a binary STL file has 84 or more, and an ASCII one begins with 'solid'");
  const std::string whole = binary("", 0, 0);
  EXPECT_EQ(error_of(whole.substr(0, whole.size() - 1)),
            "m.stl: the file is truncated: its header gives 2 facets, which take 184 bytes, and it has 183");
  std::string infinite = whole;
  const uint32_t bits = 0x7f800000;
  std::memcpy(infinite.data() + 84 + 50 + 12, &bits, 4);
  EXPECT_EQ(error_of(infinite), "m.stl: facet 1 has a coordinate that is not finite");
  EXPECT_EQ(error_of("solid\nvertex 0 0 0\nendsolid\n"), "m.stl:2:1: 'vertex' is outside 'outer loop'");
  EXPECT_EQ(error_of("solid\nouter loop\nvertex 0 0 0\nendloop\nendsolid\n"),
            "m.stl:4:1: a facet has three vertices; this one has 1");
  EXPECT_EQ(error_of("solid\nouter loop\nvertex 0 0 x\nendloop\nendsolid\n"), "m.stl:3:12: 'x' is not a finite number");
  EXPECT_EQ(error_of("solid\nfacts\nendsolid\n"),
            "m.stl:2:1: 'facts' is not a word of STL: solid, facet, outer loop, "
            "vertex, endloop, endfacet, endsolid");
  EXPECT_EQ(error_of("solid\nfacet normal 0 0 1\n").substr(0, 10), "m.stl:3:1:");
}

TEST(Models, OfPlyAreShownInTheirColours) {
  const TemporaryFolder folder;
  folder.write_text(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0 255\n1 0 0 188 0 0 255\n1 1 0 0 0 255 51\n"
      "3 0 1 2\n");
  Diagnostics diagnostics;
  const Scene scene = read_scene(folder.file("m.ply"), diagnostics);
  const Material& material = scene.materials.at(scene.groups[0].shapes.at(0).material);
  EXPECT_EQ(scene.textures.at(material.reflectance).kind, TextureKind::vertex_colour);
  EXPECT_EQ(scene.textures.at(material.alpha).kind, TextureKind::vertex_alpha);
  const auto& colours = scene.meshes.at(0).colours;
  EXPECT_EQ(colours.at(0)[0], 1);
  EXPECT_NEAR(static_cast<double>(colours.at(1)[0]), 0.5029, 1e-3) << "decoded from sRGB";
  EXPECT_NEAR(static_cast<double>(colours.at(2)[3]), 0.2, 1e-6) << "alpha is linear";
}

TEST(Models, ColoursOfPlyAreReadOnlyWhereTheyAreWanted) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float red\nproperty float green\nproperty float blue\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0.5 0 0\n1 0 0 2 0 0\n1 1 0 -1 0 1\n3 0 1 2\n";
  const auto red = [&](PlyColours colours) {
    Diagnostics diagnostics;
    MemorySource source(text);
    std::vector<float> values;
    for (const auto& colour : parse_ply(source, "m.ply", diagnostics, colours).colours) values.push_back(colour[0]);
    return values;
  };
  EXPECT_TRUE(red(PlyColours::none).empty());
  EXPECT_EQ(red(PlyColours::linear), (std::vector<float>{0.5f, 1, 0})) << "clamped to [0, 1]";
  EXPECT_EQ(red(PlyColours::displayed), red(PlyColours::linear)) << "floats are linear";
}

TEST(Models, AreRecognizedByTheirFirstBytes) {
  const TemporaryFolder folder;
  folder.write_text("model", ascii);
  Diagnostics diagnostics;
  EXPECT_EQ(read_scene(folder.file("model"), diagnostics).meshes.at(0).triangle_count(), 2u);
  folder.write_text("other", "hello");
  try {
    read_scene(folder.file("other"), diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              folder.file("other") +
                  ": the format is unknown by this name and by its first bytes: give a .pbrt, .gltf, .glb or .xml "
                  "(Mitsuba) scene, or a .obj, .ply or .stl model (all but glTF also as .gz)");
  }
}

}  // namespace
}  // namespace alhazen::impl::test
