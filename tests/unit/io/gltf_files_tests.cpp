// Real glTF files: all valid ones are read, and all others are either read or refused with one message.

#include "io/read_scene.h"
#include "support/external_scenes.h"
#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {

namespace {

const std::vector<std::string> gltf_extensions{".gltf", ".glb"};

/// Warnings that are correct for these files.
bool is_expected(const std::string& warning) {
  return warning.find("points and lines have no area") != std::string::npos ||
         warning.find("no surface to be drawn") != std::string::npos;
}

void expect_sound(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
    for (const size_t size :
         {mesh.normals.size(), mesh.uvs.size(), mesh.second_uvs.size(), mesh.tangents.size(), mesh.colours.size()})
      ASSERT_TRUE(size == 0 || size == mesh.positions.size());
  }
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes) {
      ASSERT_LT(shape.mesh, scene.meshes.size());
      ASSERT_LT(shape.material, scene.materials.size());
    }
}

TEST(GltfFiles, OpenEveryWellFormedOne) {
  size_t opened = 0;
  for (const char* folder : {"gltf", "gltf-suites"})
    for (const auto& path : external_files(folder, gltf_extensions)) {
      Diagnostics diagnostics;
      try {
        const Scene scene = read_scene(path.string(), diagnostics);
        expect_sound(scene);
        ++opened;
      } catch (const InputError& error) {
        // The suite contains files that must be refused.
        if (path.string().find("Compatibility") == std::string::npos) ADD_FAILURE() << error.what();
      }
      for (const Diagnostics::Warning& warning : diagnostics.warnings())
        EXPECT_TRUE(is_expected(warning.message)) << warning.to_string();
    }
  if (opened == 0) GTEST_SKIP() << "the scenes are not here: set ALHAZEN_SCENES to their folder";
}

TEST(GltfFiles, SayOneSentenceOfEveryMalformedOne) {
  const auto files = external_files("gltf-malformed", gltf_extensions);
  if (files.empty()) GTEST_SKIP() << "the scenes are not here: set ALHAZEN_SCENES to their folder";
  size_t refused = 0;
  for (const auto& path : files) {
    Diagnostics diagnostics;
    try {
      expect_sound(read_scene(path.string(), diagnostics));
    } catch (const InputError& error) {
      ++refused;
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_EQ(message.find(path.parent_path().string()), 0u) << message;
    }
  }
  EXPECT_GT(refused, files.size() / 4);
}

}  // namespace

}  // namespace alhazen::impl::test
