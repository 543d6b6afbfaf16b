// OBJ files with their materials.

#include <gtest/gtest.h>

#include "io/obj/obj_file.h"
#include "io/obj/obj_model.h"
#include "io/read_scene.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {
namespace {

struct ParsedModel {
  Scene scene;
  std::vector<std::string> warnings;
};

ParsedModel model_of_folder(const TemporaryFolder& folder, const std::string& obj, const std::string& mtl) {
  folder.write_text("m.obj", obj);
  if (!mtl.empty()) folder.write_text("m.mtl", mtl);
  Diagnostics diagnostics;
  ParsedModel parsed{read_scene(folder.file("m.obj"), diagnostics), {}};
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) parsed.warnings.push_back(warning.to_string());
  return parsed;
}

obj::File parse(const std::string& text, obj::Division division = obj::Division::named) {
  Diagnostics diagnostics;
  MemorySource source(text);
  return obj::parse_obj(source, "m.obj", division, diagnostics);
}

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, FacesShareVerticesAndCountBackFromTheLast) {
  const obj::File file = parse(corners + "f 1 2 3\nf -4 -2 -1\n");
  ASSERT_EQ(file.parts.size(), 1u);
  EXPECT_EQ(file.parts[0].mesh.positions.size(), 4u);
  EXPECT_EQ(file.parts[0].mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Obj, ConcavePolygonsAreCutRight) {
  // A fan about the first corner would cover the notch.
  const obj::File file = parse("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 2 3 4 5 1\n");
  const Mesh& mesh = file.parts[0].mesh;
  double area = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3d& p = mesh.positions[mesh.indices[i]];
    const double z = cross(mesh.positions[mesh.indices[i + 1]] - p, mesh.positions[mesh.indices[i + 2]] - p).z;
    EXPECT_GE(z, 0);
    area += z / 2;
  }
  EXPECT_NEAR(area, 10, 1e-12);
}

TEST(Obj, CornersWithUvsAndNormalsAreApartFromThoseWithout) {
  const obj::File file =
      parse(corners + "vt 0.5 0.25\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2//1 3//1\nf 1 2 3\nf 1/1 2 3\n");
  ASSERT_EQ(file.parts.size(), 3u);
  EXPECT_EQ(file.parts[0].mesh.uvs.size(), 3u);
  EXPECT_EQ(file.parts[0].mesh.normals.size(), 3u);
  EXPECT_TRUE(file.parts[1].mesh.uvs.empty());
  EXPECT_EQ(file.parts[2].mesh.triangle_count(), 2u) << "a uv of one corner alone is not used";
}

TEST(Obj, ObjectsAndMaterialsAreMeshesOfTheirOwn) {
  const std::string text =
      corners + "o left\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\no right\nf 1 2 3\no left\nusemtl a\nf 1 3 4\n";
  const obj::File file = parse(text);
  ASSERT_EQ(file.parts.size(), 3u);
  EXPECT_EQ(file.parts[0].mesh.triangle_count(), 2u);
  EXPECT_EQ(file.parts[1].material, "b");
  EXPECT_EQ(file.parts[2].object, "right");
  EXPECT_EQ(parse(text, obj::Division::none).parts.size(), 1u);
}

TEST(Obj, LinesMayBeContinuedAndEndInAnyWay) {
  EXPECT_EQ(parse("v 0 0 0\r\nv 1 0 0\rv 1 \\\n1 0 # comment\nf 1 2 \\\r\n3").parts.at(0).mesh.triangle_count(), 1u);
}

TEST(Obj, ErrorsNameLineAndColumn) {
  EXPECT_EQ(error_of("v 0 0\n"), "m.obj:1:6: a number is missing after 'v'");
  EXPECT_EQ(error_of("v 0 zero 0\n"), "m.obj:1:5: 'zero' is not a finite number");
  EXPECT_EQ(error_of("v 0 nan 0\n"), "m.obj:1:5: 'nan' is not a finite number");
  EXPECT_EQ(error_of(corners + "f 1 2 9\n"), "m.obj:5:7: vertex 9 is out of range (4 are given before this)");
  EXPECT_EQ(error_of(corners + "f 1 2 0\n"), "m.obj:5:7: vertex 0 is out of range (4 are given before this)");
  EXPECT_EQ(error_of(corners + "f 1 2 -5\n"), "m.obj:5:7: vertex -5 is out of range (4 are given before this)");
  EXPECT_EQ(error_of(corners + "f 1/1 2/1 3/1\n"),
            "m.obj:5:3: texture vertex 1 is out of range (0 are given before this)");
  EXPECT_EQ(error_of(corners + "f 1 2\n"), "m.obj:5:1: a face needs 3 corners or more, this one has 2");
  EXPECT_EQ(error_of(corners + "f 1 2 3x\n"), "m.obj:5:7: '3x' is not a corner of a face: v, v/vt, v//vn or v/vt/vn");
  EXPECT_EQ(error_of(corners + "f 1 2 99999999999999999999\n"),
            "m.obj:5:7: '99999999999999999999' is not a corner of a face: v, v/vt, v//vn or v/vt/vn");
  EXPECT_EQ(error_of("vt 1e40 0\n"), "m.obj:1:4: '1e40' is too large");
}

TEST(Obj, MaterialsBecomePrincipled) {
  const TemporaryFolder folder;
  const ParsedModel parsed =
      model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl red paint\nf 1 2 3\nusemtl lamp\nf 1 3 4\n",
                      "newmtl red paint\nKd 0.8 0 0\nPr 0.25\nPm 0.5\nNi 1.4\nd 0.5\nnewmtl lamp\nKe 5 5 5\n");
  EXPECT_TRUE(parsed.warnings.empty()) << parsed.warnings[0];
  const Scene& scene = parsed.scene;
  ASSERT_EQ(scene.groups[0].shapes.size(), 2u);
  const Material& red = scene.materials.at(scene.groups[0].shapes[0].material);
  EXPECT_EQ(red.name, "red paint");
  EXPECT_EQ(red.kind, MaterialKind::principled);
  EXPECT_EQ(scene.textures.at(red.principled.base_colour).value, (Vec3d{0.8, 0, 0}));
  EXPECT_EQ(scene.textures.at(red.principled.roughness).value.x, 0.25);
  EXPECT_EQ(scene.textures.at(red.principled.metallic).value.x, 0.5);
  EXPECT_EQ(red.principled.ior, 1.4);
  EXPECT_EQ(scene.textures.at(red.alpha).value.x, 0.5);
  EXPECT_FALSE(scene.groups[0].shapes[0].emission);
  EXPECT_EQ(scene.groups[0].shapes[1].emission.value().radiance.x, 5);
  EXPECT_EQ(scene.quality, "good") << "as a lone mesh";
  EXPECT_FALSE(scene.lights.empty());
}

TEST(Obj, HighlightsOfTheOldModelBecomeRoughness) {
  const TemporaryFolder folder;
  const ParsedModel parsed = model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n",
                                             "newmtl a\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 30\nillum 2\n");
  const Principled& p = parsed.scene.materials.at(0).principled;
  EXPECT_NEAR(parsed.scene.textures.at(p.roughness).value.x, 0.5, 1e-12) << "alpha^2 = 2 / (30 + 2)";
  EXPECT_EQ(parsed.scene.textures.at(p.specular_colour).value.x, 0.5);
}

TEST(Obj, WhatIsMissingIsNamedOnce) {
  const TemporaryFolder folder;
  const ParsedModel parsed =
      model_of_folder(folder, "mtllib none.mtl\n" + corners + "usemtl a\nf 1 2 3\nf 1 3 4\n", "");
  ASSERT_EQ(parsed.warnings.size(), 2u);
  EXPECT_EQ(parsed.warnings[0], folder.file("m.obj") + ":1:1: the materials 'none.mtl' are not found (looked in '" +
                                    folder.path().substr(0, 40) + (folder.path().size() > 40 ? "...'" : "'") +
                                    "); without them surfaces are grey; --search-path names more folders to look in");
  EXPECT_EQ(parsed.warnings[1], folder.file("m.obj") + ":6:8: no material is named 'a'; its surfaces are grey");
  const ParsedModel image = model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n",
                                            "newmtl a\nmap_Kd -s 2 2 1 no such.png\n");
  ASSERT_EQ(image.warnings.size(), 1u);
  EXPECT_EQ(image.warnings[0], folder.file("m.mtl") + ":2:1: there is no image 'no such.png' (looked for " +
                                   folder.file("no such.png") +
                                   "): magenta is shown in its place; --search-path names more folders to look in");
  EXPECT_EQ(image.scene.images.at(0).bytes, (std::vector<uint8_t>{255, 0, 255}));
  const ParsedModel bump =
      model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n", "newmtl a\nbump no.png\n");
  ASSERT_EQ(bump.warnings.size(), 1u);
  EXPECT_EQ(bump.warnings[0], folder.file("m.mtl") + ":2:1: there is no image 'no.png' (looked for " +
                                  folder.file("no.png") +
                                  "): the material is rendered without it; --search-path names more folders to look "
                                  "in");
  EXPECT_EQ(bump.scene.materials.at(0).displacement, no_index);
}

TEST(Obj, FilesAreSearchedInFurtherFolders) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("model"));
  std::filesystem::create_directories(folder.file("more"));
  folder.write_text("model/m.obj", "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n");
  folder.write_text("more/m.mtl", "newmtl a\nmap_Kd C:\\maps\\a.ppm\n");
  ReadOptions options;
  options.search.folders = {folder.file("more")};
  const auto read = [&] {
    Diagnostics diagnostics;
    return read_scene(folder.file("model/m.obj"), options, diagnostics);
  };
  EXPECT_EQ(read().images.at(0).bytes, (std::vector<uint8_t>{255, 0, 255}));
  options.search.strict = true;
  try {
    read();
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(folder.file("more/m.mtl") + ":2:1: there is no image 'C:/maps/a.ppm'"), 0u) << message;
    EXPECT_NE(message.find("; it is not in a folder of --search-path either"), std::string::npos) << message;
  }
}

TEST(Obj, WhatIsOutsideTheFolderIsAnErrorWhereItIsNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("model"));
  folder.write_text("m.mtl", "newmtl a\n");
  folder.write_text("a.png", "x");
  folder.write_text("model/in.mtl", "newmtl a\nKd 1 1 1\nmap_Kd ../a.png\n");
  const auto error_place = [&](const std::string& library) {
    folder.write_text("model/m.obj", corners + "mtllib " + library + "\nusemtl a\nf 1 2 3\n");
    ReadOptions options;
    options.confine = true;
    Diagnostics diagnostics;
    try {
      read_scene(folder.file("model/m.obj"), options, diagnostics);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder.path().size() + 1, 48);
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_place("../m.mtl").substr(0, 40), "model/m.obj:5:1: the materials '../m.mtl");
  EXPECT_EQ(error_place("in.mtl").substr(0, 37), "model/in.mtl:3:1: the image '../a.png");
}

TEST(Obj, OpaqueMaterialsOfMayaAreNotGlass) {
  const TemporaryFolder folder;
  const auto material = [&](const std::string& mtl) {
    return model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n", "newmtl a\n" + mtl)
        .scene.materials.at(0);
  };
  const std::string maya = "illum 4\nKd 0.50 0.50 0.50\nKa 0.00 0.00 0.00\nTf 1.00 1.00 1.00\n";
  EXPECT_EQ(material(maya + "Ni 1.00\n").principled.transmission, no_index);
  EXPECT_EQ(material(maya).principled.transmission, no_index);
  EXPECT_NE(material(maya + "Ni 1.50\n").principled.transmission, no_index);
  EXPECT_NE(material(maya + "Ni 1.00\nd 0.5\n").principled.transmission, no_index);
}

TEST(Obj, OpacityCountsBeforeTransparency) {
  const TemporaryFolder folder;
  const auto opacity = [&](const std::string& mtl) {
    const Scene scene = model_of_folder(folder, "mtllib m.mtl\n" + corners + "usemtl a\nf 1 2 3\n", mtl).scene;
    const uint32_t alpha = scene.materials.at(0).alpha;
    return alpha == no_index ? 1 : scene.textures.at(alpha).value.x;
  };
  EXPECT_EQ(opacity("newmtl a\nd 0.25\nTr 0.5\n"), 0.25);
  EXPECT_EQ(opacity("newmtl a\nTr 0.5\nd 0.25\n"), 0.25);
  EXPECT_EQ(opacity("newmtl a\nTr 0.75\nnewmtl b\nd 1\n"), 0.25);
  EXPECT_EQ(opacity("newmtl b\nTr 0.75\nnewmtl a\n"), 1);
}

TEST(Obj, NamesMayHaveNumberSigns) {
  const obj::File file = parse(
      "# comment\nmtllib my#1.mtl\nv 0 0 0 # first\nv 1 0 0 #\nv 1 1 0\n#v 9 9 9\no Box #2\n"
      "usemtl Material #25\nf 1 2 3 # face\n");
  EXPECT_EQ(file.libraries.at(0).text, "my#1.mtl");
  ASSERT_EQ(file.parts.size(), 1u);
  EXPECT_EQ(file.parts[0].object, "Box #2");
  EXPECT_EQ(file.parts[0].material, "Material #25");
  EXPECT_EQ(error_of("v 0 0 # 1\n"), "m.obj:1:7: a number is missing after 'v'");
  EXPECT_EQ(error_of("v 0 0 1#2\n"), "m.obj:1:7: '1#2' is not a finite number");
}

TEST(Obj, ErrorsOfMaterials) {
  const auto error = [](const std::string& mtl) {
    const TemporaryFolder folder;
    try {
      model_of_folder(folder, "mtllib m.mtl\n" + corners + "f 1 2 3\n", mtl);
    } catch (const InputError& failure) {
      return std::string(failure.what()).substr(folder.path().size() + 1);
    }
    return std::string("no error");
  };
  EXPECT_EQ(error("Kd 1 1 1\n"), "m.mtl:1:1: a statement before the first 'newmtl' belongs to no material");
  EXPECT_EQ(error("newmtl\n"), "m.mtl:1:7: the name of the material is missing after 'newmtl'");
  EXPECT_EQ(error("newmtl a\nKd -1 1 1\n"), "m.mtl:2:4: a colour cannot be negative");
  EXPECT_EQ(error("newmtl a\nKd spectral a.rfl\n"),
            "m.mtl:2:4: colours as 'spectral' are not supported; give red, green and blue");
  EXPECT_EQ(error("newmtl a\nmap_Kd -zoom 3 a.png\n"), "m.mtl:2:8: unknown option '-zoom' of an image");
  EXPECT_EQ(error("newmtl a\nmap_Kd -s 1 1\n"), "m.mtl:2:14: the name of the image is missing");
  EXPECT_EQ(error("newmtl a\nd 1.5\n"), "m.mtl:2:3: 'd' must be from 0 to 1");
  EXPECT_EQ(error("newmtl a\nTr -0.5\n"), "m.mtl:2:4: 'Tr' must be from 0 to 1");
  EXPECT_EQ(error("newmtl a\nNs\n"), "m.mtl:2:3: a number is missing after 'Ns'");
}

TEST(Obj, ColoursOfVerticesAreShown) {
  Diagnostics diagnostics;
  const Scene scene = parse_obj_model("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0.5 0 0\nf 1 2 3\n", "m.obj", diagnostics);
  EXPECT_EQ(scene.textures.at(scene.materials.at(0).principled.base_colour).kind, TextureKind::vertex_colour);
  ASSERT_EQ(scene.meshes[0].colours.size(), 3u);
  EXPECT_NEAR(static_cast<double>(scene.meshes[0].colours[2][0]), 0.2140, 1e-4) << "decoded from sRGB";
}

TEST(Obj, WithoutFacesThereIsNoImage) {
  Diagnostics diagnostics;
  try {
    parse_obj_model("v 0 0 0\n", "m.obj", diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "m.obj: the mesh has no faces, so there is no image");
  }
}

}  // namespace
}  // namespace alhazen::impl::test
