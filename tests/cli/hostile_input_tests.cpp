// Untrusted scenes: references to things that are not files, files outside the folder, names with control characters,
// and limits of the system. The program prints one error message of its own and exits with code 2 without delay.

#include <sys/stat.h>
#include <zlib.h>

#include "cli/fixture.h"
#include "support/effort.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

/// Characters that must not reach a terminal, whatever the input: C0 except line feeds, DEL, and, since these tests use
/// ASCII only, bytes over 0x7f.
bool is_plain(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
}

class Hostile : public Command {
 protected:
  /// Runs `bash -c line` in the folder, with the program as $A.
  CommandResult shell(const std::string& line) const {
    CommandOptions options;
    options.folder = folder_.path();
    options.timeout = 60;
    return run_command({"/bin/bash", "-c", std::string("A='") + ALHAZEN_BINARY + "'; ulimit -c 0; " + line}, options);
  }

  /// Expects that a scene is refused: exit code 2 soon, one error that names `file`, and nothing of `secret`.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& words) const {
    CommandOptions options;
    options.timeout = 20;
    options.address_space = test::is_sanitized ? 0 : size_t{2} << 30;
    const CommandResult result = run(arguments, options);
    SCOPED_TRACE(result.everything().substr(0, 2000));
    EXPECT_FALSE(result.timed_out);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(words), std::string::npos) << words;
    EXPECT_EQ(result.err.find("SECRET"), std::string::npos);
    EXPECT_TRUE(is_plain(result.err));
  }

  void expect_scene_refused(const std::string& text, const std::string& words,
                            const std::vector<std::string>& options = {}) const {
    SCOPED_TRACE(text);
    folder_.write_text("bad.pbrt", text);
    std::vector<std::string> arguments{"info", "bad.pbrt"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_refused(arguments, words);
  }
};

std::vector<std::string> scenes_that_name(const std::string& file) {
  const std::string world = "WorldBegin ", name = "\"string filename\" \"" + file + "\"";
  return {"Include \"" + file + "\" WorldBegin",
          world + "Import \"" + file + "\"",
          world + "Shape \"plymesh\" " + name,
          world + "Texture \"t\" \"spectrum\" \"imagemap\" " + name,
          world + "LightSource \"infinite\" " + name,
          world + "LightSource \"projection\" " + name,
          world + "LightSource \"goniometric\" " + name,
          world + "AreaLightSource \"diffuse\" " + name + " Shape \"sphere\"",
          world + "Material \"diffuse\" \"string normalmap\" \"" + file + "\"",
          world + "Material \"diffuse\" \"spectrum reflectance\" \"" + file + "\"",
          "Camera \"realistic\" \"string lensfile\" \"" + file + "\" WorldBegin"};
}

TEST_F(Hostile, WhatIsNoFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(folder_.file("pipe.x").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_.file("zero.x"));
  fs::create_directory(folder_.file("folder.x"));
  for (const std::string& text : scenes_that_name("pipe.x")) expect_scene_refused(text, "is a pipe");
  for (const std::string& text : scenes_that_name("zero.x")) expect_scene_refused(text, "is a device");
  for (const std::string& text : scenes_that_name("folder.x")) expect_scene_refused(text, "is a folder");
  for (const char* extension : {".pbrt", ".ply", ".gltf", ".glb", ".pbrt.gz", ".ply.gz", ".other"}) {
    const std::string name = std::string("scene") + extension;
    fs::create_symlink("/dev/zero", folder_.file("zero-" + name));
    fs::create_symlink("pipe.x", folder_.file("pipe-" + name));
    fs::create_directory(folder_.file("folder-" + name));
    expect_refused({"info", "zero-" + name}, "is a device");
    expect_refused({"info", "pipe-" + name}, "is a pipe");
    expect_refused({"info", "folder-" + name}, "is a folder");
  }
  for (const char* file : {"zero.x", "pipe.x", "folder.x"}) {
    expect_refused({"render", "scene.pbrt", "-o", "a.exr", "--environment", file}, " is a ");
    expect_refused({"compare", file, file}, " is a ");
    expect_refused({"study", "compare", file, file}, file == std::string("folder.x") ? "no study.json" : " is a ");
    folder_.write_text(
        "a.gltf", std::string("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"") +
                      file +
                      "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": "
                      "[{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], "
                      "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], \"nodes\": "
                      "[{\"mesh\": 0}], \"scenes\": [{\"nodes\": [0]}]}");
    expect_refused({"info", "a.gltf"}, "a.gltf:1:");
  }
  EXPECT_FALSE(exists("a.exr"));
}

TEST_F(Hostile, ConfinedToItsFolderASceneReachesNothingElse) {
  folder_.write_text("secret.spd", "SECRET 500 1");
  folder_.write_text("secret", "SECRET");
  fs::create_directories(folder_.file("in/sub"));
  fs::create_symlink("../secret", folder_.file("in/link.x"));
  fs::create_symlink("..", folder_.file("in/up"));
  folder_.write_text("in/part.pbrt", "Shape \"sphere\"");
  const auto expect = [&](const std::string& text, bool is_refused) {
    SCOPED_TRACE(text);
    folder_.write_text("in/a.pbrt", text);
    if (is_refused) return expect_refused({"info", "in/a.pbrt", "--confine"}, "outside the scene's folder");
    const CommandResult result = run({"info", "in/a.pbrt", "--confine"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
  };
  for (const std::string& file : {std::string("../secret.spd"), std::string("link.x"), std::string("up/secret"),
                                  std::string("sub/../../secret.spd"), folder_.file("secret.spd"),
                                  std::string("/etc/passwd.x"), std::string("../not-there.x")})
    for (const std::string& text : scenes_that_name(file)) {
      // A spectrum without an extension is looked up by name.
      if (text.find("spectrum reflectance") != std::string::npos && file == "up/secret") continue;
      expect(text, true);
    }
  expect("WorldBegin Include \"part.pbrt\" Import \"sub/../part.pbrt\"", false);
  expect("WorldBegin Include \"" + folder_.file("in/part.pbrt") + "\"", false);
  // Links within the folder are followed if they are relative; absolute ones lead outside.
  fs::create_symlink("../part.pbrt", folder_.file("in/sub/relative.pbrt"));
  expect("WorldBegin Include \"sub/relative.pbrt\"", false);
  // Without --confine files may be anywhere, as in pbrt.
  folder_.write_text("part.pbrt", "Shape \"sphere\"");
  folder_.write_text("in/a.pbrt", "WorldBegin Include \"../part.pbrt\"");
  EXPECT_EQ(run({"info", "in/a.pbrt"}).exit_code, 0);
  EXPECT_EQ(run({"info", "in/a.pbrt", "--confine"}).exit_code, 2);
  // The scene itself, and files given on the command line.
  fs::create_symlink("../secret", folder_.file("in/link.pbrt"));
  expect_refused({"info", "in/link.pbrt", "--confine"}, "outside the scene's folder");
  folder_.write_text("in/a.pbrt", "WorldBegin Shape \"sphere\"");
  expect_refused({"render", "in/a.pbrt", "-o", "a.exr", "--confine", "--environment", "secret"},
                 "outside the scene's folder");
}

TEST_F(Hostile, ConfinedGltf) {
  folder_.write("secret.bin", Bytes(36, 0));
  fs::create_directories(folder_.file("in/%2e%2e"));
  fs::create_directories(folder_.file("in/sub"));
  fs::create_symlink("../secret.bin", folder_.file("in/link.bin"));
  folder_.write("in/own.bin", Bytes(36, 0));
  const auto info = [&](const std::string& uri, const std::vector<std::string>& options) {
    folder_.write_text(
        "in/a.gltf",
        "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"" + uri +
            "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
            "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], \"meshes\": [{\"primitives\": "
            "[{\"attributes\": {\"POSITION\": 0}}]}], \"nodes\": [{\"mesh\": 0}], \"scenes\": [{\"nodes\": "
            "[0]}], \"images\": [{\"uri\": \"" +
            uri + "\"}], \"textures\": [{\"source\": 0}]}");
    std::vector<std::string> arguments{"info", "in/a.gltf"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  };
  for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "%2E./secret.bin", "..%2fsecret.bin", "link.bin",
                          "sub/../../secret.bin", "%2e%2e%2fsecret.bin"}) {
    const CommandResult result = info(uri, {"--confine"});
    EXPECT_EQ(result.exit_code, 2) << uri << result.everything();
    EXPECT_EQ(result.err.rfind("in/a.gltf:1:", 0), 0u) << result.err;
    EXPECT_NE(result.err.find("outside the scene's folder"), std::string::npos) << uri << result.err;
  }
  EXPECT_EQ(info("../secret.bin", {}).exit_code, 0);
  EXPECT_EQ(info("own.bin", {"--confine"}).exit_code, 0);
  EXPECT_EQ(run({"info", "--list", "in/a.gltf", "--confine"}).exit_code, 0);
}

TEST_F(Hostile, NamesDoNotReachTheTerminalAsTheyAre) {
  const std::string evil = "\x1b]0;t\x07\x1b[31m\x9b\xc2\x9b\x7f\xe2\x80\xae\xff";
  folder_.write_text("a.pbrt", "WorldBegin\nNamedMaterial \"" + evil + "\"\nShape \"sphere\"\n");
  folder_.write_text("b.pbrt", "WorldBegin\n" + evil + "\n");
  folder_.write_text("c.pbrt", "WorldBegin\nTexture \"" + evil + "\" \"float\" \"" + evil + "\"\n");
  folder_.write_text("d.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"" + evil + "\"\n");
  folder_.write_text("e.pbrt", std::string("\x7f"
                                           "ELF\0\x1b[2J\xff\xfe",
                                           12));
  folder_.write_text("f.ply", "ply\nformat " + evil + " 1.0\n");
  folder_.write_text("g.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                         evil + " 0 0\n");
  const std::string escaped = "\\u001b]0;t\\u0007\\n  9 fake\\u009b\\u202e\\u007f";
  folder_.write_text("h.gltf", "{\"asset\": {\"version\": \"" + escaped + "\"}}");
  folder_.write_text("i.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"" + escaped +
                                   "\"], \"extensionsRequired\": [\"" + escaped + "\"]}");
  folder_.write_text("j.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"" + escaped +
                                   "\"], \"cameras\": [{\"type\": \"perspective\", \"name\": \"" + escaped +
                                   "\", \"perspective\": {\"yfov\": 1, \"znear\": 1}}], \"nodes\": [{\"camera\": 0}], "
                                   "\"scenes\": [{\"nodes\": [0]}], \"animations\": [{\"name\": \"" +
                                   escaped + "\", \"channels\": [], \"samplers\": []}]}");
  folder_.write_text("k.spd", evil + " 1");
  folder_.write_text("k.pbrt", "WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"k.spd\"");
  folder_.write_text("l.pbrt", "Camera \"realistic\" \"string lensfile\" \"k.spd\" WorldBegin");
  folder_.write_text("m.pbrt", "WorldBegin\nAttributeBegin \"" + evil);
  const std::string named = evil + "n.pbrt";
  folder_.write_text(named, "Camera \"perspective\"\nWorldBegin\n");
  std::vector<std::vector<std::string>> all;
  for (const char* file : {"a.pbrt", "b.pbrt", "c.pbrt", "d.pbrt", "e.pbrt", "f.ply", "g.ply", "h.gltf", "i.gltf",
                           "j.gltf", "k.pbrt", "l.pbrt", "m.pbrt"}) {
    all.push_back({"info", file});
    all.push_back({"info", "--json", file});
    all.push_back({"info", "--list", file});
    all.push_back({"info", "--list", "--json", file});
    all.push_back({"render", file, "-o", "o.exr", "--spp", "1", "--size", "4x4", "-v"});
    all.push_back({"render", file, "--camera", evil, "--animation", evil, "--variant", evil});
  }
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"info", named},
        {"info", "--json", named},
        {"render", named, "-o", named + ".exr", "-v", "--stats", "--spp", "1", "--size", "4x4"},
        {"render", named, "-o", "o.exr", "-v", "--stats=json", "--spp", "1", "--size", "4x4"},
        {"render", named, "-o", named + "/x.exr"},
        {"render", evil + ".pbrt"},
        {evil},
        {"render", "scene.pbrt", "--spp", evil},
        {"render", "scene.pbrt", evil},
        {"render", "scene.pbrt", "--backend", evil},
        {"render", "scene.pbrt", "--size", evil},
        {"render", "scene.pbrt", "-" + evil},
        {"compare", evil, evil},
        {"study", "compare", evil, evil},
        {"study", "report", "--only", evil},
        {"study", "tune", evil}})
    all.push_back(more);
  for (const std::vector<std::string>& arguments : all) {
    const CommandResult result = run(arguments);
    EXPECT_TRUE(is_plain(result.out)) << arguments[0] << " " << arguments.back() << "\n" << result.everything();
    EXPECT_TRUE(is_plain(result.err)) << arguments[0] << " " << arguments.back() << "\n" << result.everything();
    EXPECT_EQ(result.out.find("\n  9 fake"), std::string::npos) << result.out;
    EXPECT_LE(result.exit_code, 2) << result.everything();
  }
}

TEST_F(Hostile, TextOfGigabytesInASmallFile) {
  if (test::is_sanitized) GTEST_SKIP() << "the address sanitizer needs more address space than the test allows";
  {
    const std::string part(size_t{1} << 20, 'x');
    gzFile file = gzopen(folder_.file("a.pbrt.gz").c_str(), "wb1");
    gzputs(file, "WorldBegin\n#");
    for (int i = 0; i < 300; ++i) gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
    gzputs(file, "\nShape \"sphere\"\nShap");
    gzclose(file);
  }
  CommandOptions options;
  options.address_space = size_t{1} << 30;
  options.timeout = 60;
  const CommandResult result = run({"info", "a.pbrt.gz"}, options);
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_NE(result.err.find("a.pbrt.gz:4:1: unknown directive"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(" 4 | Shap\n   | ^"), std::string::npos) << result.err;
}

/// Whatever the limits, the program exits by itself with one error message of its own.
TEST_F(Hostile, ThreadsThatTheSystemRefuses) {
  if (test::is_sanitized) GTEST_SKIP() << "the address sanitizer needs more address space than the test allows";
  const CommandResult refused =
      shell("ulimit -v 400000; $A render scene.pbrt --size 8x8 --threads 512 --spp 1 -q -o a.exr");
  EXPECT_EQ(refused.exit_code, 2) << refused.everything();
  EXPECT_EQ(refused.err.find("the system does not give 512 threads: give --threads "), 0u) << refused.err;
  EXPECT_FALSE(exists("a.exr"));
  for (const int megabytes : {120, 160, 200, 240, 280, 320, 400, 600, 1200})
    for (const char* arguments : {"render scene.pbrt --size 8x8 --spp 1 -q -o b.exr", "info scene.pbrt",
                                  "render scene.pbrt --size 8x8 --spp 1 -q -o b.exr --threads 24"}) {
      const CommandResult result = shell("ulimit -v " + std::to_string(megabytes * 1024) + "; $A " + arguments);
      EXPECT_LE(result.exit_code, 2) << megabytes << " MiB: " << arguments << "\n" << result.everything();
      EXPECT_EQ(result.err.find("libgomp"), std::string::npos) << result.err;
    }
}

/// Also a single thread needs another that reports progress, and the command line itself needs memory.
TEST_F(Hostile, LimitsOnMemoryAreToldInSentences) {
  if (test::is_sanitized) GTEST_SKIP() << "the address sanitizer needs more address space than the test allows";
  std::vector<std::string> limits{"-d 250", "-d 500", "-d 1000"};
  for (int kilobytes = 2000; kilobytes <= 10000; kilobytes += 1000) limits.push_back("-d " + std::to_string(kilobytes));
  for (int kilobytes = 20000; kilobytes <= 100000; kilobytes += 10000)
    limits.push_back("-v " + std::to_string(kilobytes));
  for (const std::string& limit : limits)
    for (const char* arguments : {"--version", "render scene.pbrt --size 8x8 --spp 1 -t 1 -q -o a.exr"}) {
      const CommandResult result = shell("ulimit " + limit + "; $A " + arguments);
      SCOPED_TRACE(limit + " " + arguments + "\n" + result.everything());
      if (result.err.find("error while loading shared libraries") != std::string::npos) continue;
      EXPECT_LE(result.exit_code, 2);
      EXPECT_EQ(result.err.find("terminate"), std::string::npos);
      EXPECT_EQ(result.err.find("alhazen: Resource temporarily unavailable\n"), std::string::npos);
      if (result.exit_code != 0) {
        EXPECT_NE(result.err.find("limit"), std::string::npos);
      }
    }
}

TEST_F(Hostile, SmallStacks) {
  if (test::is_sanitized) GTEST_SKIP() << "frames of the sanitizer are larger";
  for (const char* kilobytes : {"96", "128", "512", "unlimited"})
    for (const char* arguments :
         {"scene.pbrt -t 4", "scene.pbrt -t 4 --precision double --backend openmp --strategy reduction",
          "scene.pbrt -t 4 --integrator recursive --max-depth 1000", "scene.pbrt --backend serial"}) {
      const CommandResult result = shell(std::string("ulimit -s ") + kilobytes + "; $A render " + arguments +
                                         " --size 16x16 --spp 4 -q -o a.exr");
      EXPECT_EQ(result.exit_code, 0) << kilobytes << " " << arguments << "\n" << result.everything();
    }
  const std::string deep(100'000, '[');
  folder_.write_text("deep.gltf", deep);
  EXPECT_EQ(shell("ulimit -s 128; $A info deep.gltf").exit_code, 2);
  std::string blocks = "WorldBegin\n";
  for (int i = 0; i < 100'000; ++i) blocks += "AttributeBegin\n";
  folder_.write_text("deep.pbrt", blocks);
  const CommandResult nested = shell("ulimit -s 128; $A info deep.pbrt");
  EXPECT_EQ(nested.exit_code, 2);
  EXPECT_NE(nested.err.find("deep.pbrt:4098:1"), std::string::npos) << nested.err;
}

/// The message says what is too large.
TEST_F(Hostile, ScenesTooLargeForMemory) {
  if (test::is_sanitized) GTEST_SKIP() << "the address sanitizer needs more address space than the test allows";
  std::string text = "WorldBegin\nObjectBegin \"o\"\n";
  for (int i = 0; i < 1000; ++i) text += "Shape \"sphere\"\n";
  text += "ObjectEnd\n";
  for (int i = 0; i < 3000; ++i) text += "ObjectInstance \"o\"\n";
  folder_.write_text("large.pbrt", text);
  const CommandResult result = shell("ulimit -v 700000; $A render large.pbrt -t 1 --size 8x8 -q -o a.exr");
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_EQ(result.err.find("large.pbrt: the scene is too large for the memory"), 0u) << result.err;
  EXPECT_NE(result.err.find("places 3000000 shapes"), std::string::npos) << result.err;
}

TEST_F(Hostile, MatricesBeyondAllMeasure) {
  const auto expect = [&](const std::string& node, bool is_refused) {
    folder_.write_text(
        "a.gltf",
        "{\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [\n" + node +
            ", {\"mesh\": 0}], \"scenes\": [{\"nodes\": [0]}], \"meshes\": [{\"primitives\": [{\"attributes\": "
            "{\"POSITION\": 0}}]}], \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, "
            "\"type\": \"VEC3\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"buffers\": "
            "[{\"byteLength\": 36, \"uri\": \"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}");
    const CommandResult result = run({"info", "a.gltf"});
    EXPECT_EQ(result.exit_code, is_refused ? 2 : 0) << node << result.everything();
    EXPECT_TRUE(!is_refused || result.err.starts_with("a.gltf:3:1: ")) << node << result.err;
  };
  expect("{\"mesh\": 0, \"scale\": [1e300, 1e300, 1e300], \"translation\": [1e300, 0, 1e308]}", true);
  expect("{\"mesh\": 0, \"scale\": [1e30, 1e30, 1e30]}", true);
  expect("{\"mesh\": 0, \"scale\": [1e200, 1e-200, 1]}", true);
  expect("{\"children\": [1], \"scale\": [1e30, 1, 1]}", true);
  expect("{\"mesh\": 0, \"matrix\": [1e30, 0, 0, 0, 0, 1e30, 0, 0, 0, 0, 1e30, 0, 0, 0, 0, 1]}", true);
  expect("{\"mesh\": 0, \"matrix\": [1e308, 1e308, 0, 0, -1e308, 1e308, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}", true);
  // Quaternions may have any length.
  expect("{\"mesh\": 0, \"rotation\": [0, 1e200, 0, 1e200]}", false);
  expect("{\"mesh\": 0, \"rotation\": [0, 1e-200, 0, 1e-200]}", false);
  expect("{\"mesh\": 0, \"scale\": [0, 0, 0]}", false);

  const std::pair<const char*, const char*> lines[] = {
      {"Scale 1e200 1 1\nScale 1e200 1 1\nShape \"sphere\"", "a.pbrt:3:1: "},
      {"Scale 0 1 1", "a.pbrt:2:1: "},
      {"Transform [ 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ]", "a.pbrt:2:1: "},
      {"ConcatTransform [ 1e308 1e308 0 0 1e308 -1e308 0 0 0 0 1 0 0 0 0 1 ]", "a.pbrt:2:1: "},
      {"LookAt 0 0 0 0 0 0 0 1 0", "a.pbrt:2:1: "},
      {"Scale 1e39 1e39 1e39 Shape \"sphere\"", "a.pbrt:2:"}};
  for (const auto& [text, place] : lines) {
    folder_.write_text("a.pbrt", std::string("WorldBegin\n") + text);
    const CommandResult result = run({"render", "a.pbrt", "--spp", "1", "-o", "a.exr", "--progress", "none"});
    EXPECT_EQ(result.exit_code, 2) << text << result.everything();
    EXPECT_EQ(result.err.find(place), 0u) << text << result.err;
  }
}

}  // namespace

}  // namespace alhazen::impl::test
