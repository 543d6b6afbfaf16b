// How the program reacts to bad input: it prints one error with the location, returns the documented exit code and
// leaves existing files unchanged.

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "cli/fixture.h"
#include "support/effort.h"

namespace alhazen::impl::test {

namespace {

/// Lines that begin an error: excerpts below it are indented, warnings are marked.
std::vector<std::string> errors_of(const std::string& err) {
  std::vector<std::string> errors;
  for (const std::string& line : lines_of(err))
    if (!line.empty() && line[0] != ' ' && line.rfind("warning: ", 0) != 0 && line.rfind("Run 'alhazen", 0) != 0)
      errors.push_back(line);
  return errors;
}

/// The location before the message.
enum class Place { none, file, line_and_column };

/// Returns whether `error` is `file: ...` or `file:line:column: ...`.
bool names_place(const std::string& error, Place place) {
  if (place == Place::none) return true;
  const size_t message = error.find(": ");
  if (message == 0 || message == std::string::npos) return false;
  if (place == Place::file) return true;
  size_t end = message;
  for (int number = 0; number < 2; ++number) {
    const size_t last_other = error.find_last_not_of("0123456789", end - 1);
    if (last_other == std::string::npos || last_other == 0 || error[last_other] != ':' || last_other + 1 == end)
      return false;
    end = last_other;
  }
  return true;
}

class BadInput : public Command {
 protected:
  /// Expects that the arguments fail with `exit_code` and one error that contains `words`.
  void expect_error(const std::vector<std::string>& arguments, int exit_code, const std::vector<std::string>& words,
                    Place place = Place::none) {
    folder_.write_text("target.exr", target);
    std::vector<std::string> all = arguments;
    if (all.at(0) == "render" && std::find(all.begin(), all.end(), "--progress") == all.end())
      all.insert(all.end(), {"--progress", "none"});
    const CommandResult result = run(all);
    SCOPED_TRACE(result.everything());
    EXPECT_FALSE(result.timed_out);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> errors = errors_of(result.err);
    ASSERT_EQ(errors.size(), 1u);
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word;
    EXPECT_TRUE(names_place(errors[0], place)) << errors[0];
    expect_untouched();
  }

  void expect_untouched() const {
    const Bytes now = read_file(folder_.file("target.exr"));
    EXPECT_EQ(std::string(now.begin(), now.end()), target);
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      EXPECT_EQ(entry.path().filename().string().find(".tmp"), std::string::npos) << "left behind: " << entry.path();
  }

  /// Writes `text` to the file `name` and renders it to the target.
  void expect_bad_scene(const std::string& name, const std::string& text, const std::vector<std::string>& words,
                        Place place = Place::line_and_column) {
    SCOPED_TRACE(text.substr(0, 200));
    folder_.write_text(name, text);
    expect_error({"render", name, "-o", "target.exr"}, 2, words, place);
  }

  void expect_bad_world(const std::string& text, const std::vector<std::string>& words) {
    expect_bad_scene("bad.pbrt", "WorldBegin\n" + text, words);
  }

  /// Runs `render scene.pbrt -o target.exr` with `arguments` appended.
  void expect_bad_usage(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    std::vector<std::string> all{"render", "scene.pbrt", "-o", "target.exr", "--spp", "1"};
    if (std::find(arguments.begin(), arguments.end(), "--spp") != arguments.end()) all.resize(4);
    all.insert(all.end(), arguments.begin(), arguments.end());
    SCOPED_TRACE(arguments.empty() ? "" : arguments[0]);
    expect_error(all, 2, words);
  }

  /// Expects success with warnings that contain `words`, and returns the image.
  Image expect_warning(const std::string& scene, const std::vector<std::string>& words) {
    folder_.write_text("odd.pbrt", scene);
    const CommandResult result =
        run({"render", "odd.pbrt", "-o", "odd.exr", "--spp", "2", "--size", "8x8", "--progress", "none", "-q"});
    SCOPED_TRACE(result.everything());
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(errors_of(result.err).size(), 0u);
    EXPECT_FALSE(result.err.empty());
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word;
    return image("odd.exr");
  }

  const std::string target = "a picture of yesterday";
};

float brightest(const Image& image) {
  float most = 0;
  for (const auto& plane : image.planes)
    for (const float value : plane) most = std::max(most, value);
  return most;
}

TEST_F(BadInput, MalformedPbrt) {
  expect_bad_scene("empty.pbrt", "", {"empty.pbrt:1:1", "WorldBegin"});
  expect_bad_scene("binary.pbrt", std::string("\x7f\x45\x4c\x46\x02\x01\x01\0\0\0\xff\xfe\x80", 13),
                   {"binary.pbrt:1:1"});
  expect_bad_scene("bad.pbrt", "Film \"rgb\" \"integer xresolution\" [ 10", {"bad.pbrt:1:3"});
  expect_bad_scene("bad.pbrt", "Film \"rgb", {"bad.pbrt:1:6", "not closed"});
  expect_bad_scene("bad.pbrt", "Camera \"perspective\" \"float fov\" \"wide\"\nWorldBegin", {"bad.pbrt:1:34"});
  expect_bad_scene("bad.pbrt", "Film \"rgb\" \"integer xresolution\" 0 WorldBegin", {"bad.pbrt:1:12", "1 to 100000"});
  expect_bad_scene("bad.pbrt", "Film \"rgb\" \"integer xresolution\" 40000 \"integer yresolution\" 25000 WorldBegin",
                   {"bad.pbrt:1:", "10^9"});
  expect_bad_scene("bad.pbrt", "Integrator \"path\" \"integer maxdepth\" 2147483647\nWorldBegin",
                   {"bad.pbrt:1:19", "maxdepth", "at most 1000000"});
  expect_bad_scene("bad.pbrt", "Sampler \"sobol\" \"integer pixelsamples\" 2147483647\nWorldBegin",
                   {"bad.pbrt:1:17", "pixelsamples"});
  expect_bad_scene("bad.pbrt", "Sampler \"stratified\" \"integer xsamples\" 5000 \"integer ysamples\" 5000\nWorldBegin",
                   {"bad.pbrt:1:1", "xsamples"});
  expect_bad_scene("bad.pbrt", "Include \"bad.pbrt\"\nWorldBegin", {"bad.pbrt:1:"});
  expect_bad_scene("bad.pbrt", "Include \"missing.pbrt\"\nWorldBegin", {"bad.pbrt:1:1", "missing.pbrt"});
  expect_bad_world("Shape \"sphere\" \"float radius\" 0", {"bad.pbrt:2:", "radius"});
  expect_bad_world("Shape \"sphere\" \"float radius\" -1", {"bad.pbrt:2:", "radius"});
  expect_bad_world("Shape \"spere\"", {"bad.pbrt:2:1", "sphere"});
  expect_bad_world("Shape", {"bad.pbrt:2:6"});
  expect_bad_world("AttributeBegin", {"bad.pbrt:2:1", "not closed"});
  expect_bad_world("Material \"diffuse\" \"rgb reflectance\" [ 1 2 ]", {"bad.pbrt:2:20"});
  expect_bad_world("NamedMaterial \"gold\"\nShape \"sphere\"", {"bad.pbrt:2:1", "gold"});
  expect_bad_world("LightSource \"projection\" \"string filename\" \"missing.png\"", {"bad.pbrt:2:", "missing.png"});
  expect_bad_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 nan 1 0 ] \"integer indices\" [ 0 1 2 ]",
                   {"bad.pbrt:2:", "nan"});
  expect_bad_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 1e60 1e60 1e60 ] \"integer indices\" [ 0 1 2 ]",
                   {"bad.pbrt:2:"});
  expect_bad_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
                   {"bad.pbrt:2:"});
  expect_bad_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 0 ]",
                   {"bad.pbrt:2:"});
  expect_bad_world("Shape \"plymesh\" \"string filename\" \"missing.ply\"", {"bad.pbrt:2:", "missing.ply"});
  expect_bad_world("Translate 1 2", {"bad.pbrt:2:"});
  expect_bad_world("LightSource \"infinite\" \"rgb L\" [ -1 0 0 ]", {"bad.pbrt:2:"});
}

TEST_F(BadInput, TruncatedPbrtAtAnyPlaceIsAnErrorOrAScene) {
  const std::string whole = cornell_box(8);
  for (size_t size = 0; size < whole.size(); size += 149) {
    folder_.write_text("target.exr", target);
    folder_.write_text("cut.pbrt", whole.substr(0, size));
    const CommandResult result =
        run({"render", "cut.pbrt", "-o", "target.exr", "--spp", "1", "--progress", "none", "-q"});
    SCOPED_TRACE("after " + std::to_string(size) + " bytes: " + result.everything());
    if (result.exit_code == 0) continue;  // nothing essential was cut off: the rest is a scene
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(errors_of(result.err).size(), 1u);
    EXPECT_EQ(result.err.rfind("cut.pbrt:", 0), 0u);
    expect_untouched();
  }
}

const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(BadInput, MalformedPly) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  expect_bad_scene("bad.ply", "", {"bad.ply:1:1"});
  expect_bad_scene("bad.ply", "plY\n", {"bad.ply:1:1"});
  expect_bad_scene("bad.ply", "ply\nformat ascii 1.0\n", {"bad.ply:"});
  expect_bad_scene("bad.ply", "ply\nformat ascii 2.0\nend_header\n", {"bad.ply:2"});
  expect_bad_scene("bad.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n", {"bad.ply:2"});
  expect_bad_scene("bad.ply", "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n", {"bad.ply:3"});
  expect_bad_scene("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty number x\nend_header\n",
                   {"bad.ply:4"});
  expect_bad_scene("bad.ply", ply_header + "0 0 0\n1 0 0\n", {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + vertices, {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + vertices + "3 0 1", {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + vertices + "3 0 1 3\n", {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + vertices + "3 0 1 -1\n", {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + vertices + "300 0 1 2\n", {"bad.ply:"});
  expect_bad_scene("bad.ply", ply_header + "0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n", {"bad.ply:11"});
  expect_bad_scene("bad.ply", ply_header + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"bad.ply:11"});
  expect_bad_scene("bad.ply", ply_header + "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", {"bad.ply:11"});
  std::string binary = ply_header;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  expect_bad_scene("bad.ply", binary + std::string(20, '\0'), {"bad.ply"}, Place::file);
  std::string nan_vertex(36, '\0');
  nan_vertex[2] = '\xc0';
  nan_vertex[3] = '\x7f';
  expect_bad_scene("bad.ply", binary + nan_vertex + std::string(13, '\0'), {"bad.ply"}, Place::file);
  std::string many = ply_header;
  many.replace(many.find("vertex 3"), 8, "vertex 4000000000");
  expect_bad_scene("bad.ply", many + vertices, {"bad.ply:13:1", "4000000000"});
  expect_bad_scene("bad.ply.gz", "\x1f\x8b\x08 and then no more", {"bad.ply.gz"}, Place::file);
  folder_.write_text("mesh.ply", ply_header + vertices);
  expect_bad_world("Shape \"plymesh\" \"string filename\" \"mesh.ply\"", {"mesh.ply:"});
}

TEST_F(BadInput, FilesThatAreNoScenes) {
  std::filesystem::create_directory(folder_.file("folder.pbrt"));
  expect_error({"render", "missing.pbrt", "-o", "target.exr"}, 2, {"missing.pbrt: ", "No such file"}, Place::file);
  expect_error({"render", "folder.pbrt", "-o", "target.exr"}, 2, {"folder.pbrt: ", "folder"}, Place::file);
  expect_error({"render", ".", "-o", "target.exr"}, 2, {".: "}, Place::file);
  expect_error({"render", "/dev/null", "-o", "target.exr"}, 2, {"/dev/null: "}, Place::file);
  folder_.write_text("scene.blend", "v 0 0 0\n");
  expect_error({"render", "scene.blend", "-o", "target.exr"}, 2, {"scene.blend: ", ".pbrt"}, Place::file);
  expect_error({"render", "", "-o", "target.exr"}, 2, {});
  folder_.write_text("photo.png", "no picture");
  expect_bad_scene("bad.pbrt", "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"photo.png\"",
                   {"photo.png: "}, Place::file);
}

TEST_F(BadInput, ListsOfWhatCannotBeRead) {
  folder_.write_text("junk.ply", "junk");
  folder_.write_text("broken.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\"\n");
  for (const std::string name : {"nothere.pbrt", "nothere.ply", "nothere.gltf", "junk.ply", "broken.pbrt"}) {
    expect_error({"info", name, "--list"}, 2, {name + ":"}, Place::file);
    expect_error({"render", name, "--list"}, 2, {name + ":"}, Place::file);
  }
  const CommandResult result = run({"info", "scene.pbrt", "--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out,
            "cameras: 1\n  0 perspective\nvariants: 0\nanimations: 0\nlights: 1\n  0 area light, scene.pbrt:34:3\n");
}

TEST_F(BadInput, OddScenesAreWarnedOf) {
  const std::string camera = "Camera \"perspective\" \"float fov\" 60\nWorldBegin\n";
  const Image empty = expect_warning(camera, {"odd.pbrt", "no shapes"});
  EXPECT_EQ(brightest(empty), 0);
  const Image flat = expect_warning(
      camera +
          "Shape \"trianglemesh\" \"point3 P\" [ -1 0 3 0 0 3 1 0 3  0 1 3 ] \"integer indices\" [ 0 1 2  0 1 3 ]\n"
          "LightSource \"infinite\" \"rgb L\" [ 0.5 0.5 0.5 ]\n",
      {"odd.pbrt:3:1", "no area"});
  EXPECT_GT(brightest(flat), 0.4f);
  const Image dark = expect_warning(camera + "Translate 0 0 4\nShape \"sphere\"\n", {"odd.pbrt", "no lights"});
  EXPECT_EQ(brightest(dark), 0);
}

TEST_F(BadInput, Sizes) {
  expect_bad_usage({"--size", "0x10"}, {"--size", "WIDTHxHEIGHT", "'0x10'"});
  expect_bad_usage({"--size", "10x0"}, {"--size", "WIDTHxHEIGHT", "'10x0'"});
  expect_bad_usage({"--size", "-4x10"}, {"-4x10"});
  expect_bad_usage({"--size", "10"}, {"WIDTHxHEIGHT"});
  expect_bad_usage({"--size", "10x"}, {"WIDTHxHEIGHT"});
  expect_bad_usage({"--size", "10x10x10"}, {"WIDTHxHEIGHT"});
  expect_bad_usage({"--size", "axb"}, {"WIDTHxHEIGHT"});
  expect_bad_usage({"--size", "40000x25000"}, {"10^9"});
  expect_bad_usage({"--size", "1000000000x1"}, {"100000"});
  expect_bad_usage({"--size", "99999999999999999999x1"}, {"WIDTHxHEIGHT"});
  expect_bad_usage({"--crop", "0.5,0.5,0,1"}, {"crop"});
  expect_bad_usage({"--crop", "0,1,0"}, {"--crop"});
  expect_bad_usage({"--crop", "nan,1,0,1"}, {"crop"});
  expect_bad_usage({"--crop", "0,0.001,0,0.001", "--size", "10x10", "--pixelbounds", "0,1,0,1"}, {"not both"});
  expect_bad_usage({"--pixelbounds", "30,40,0,10"}, {"no pixel"});
  expect_bad_usage({"--pixelbounds", "5,4,0,10"}, {"no pixel"});
}

TEST_F(BadInput, MoreMemoryThanThereIs) {
  if (test::is_sanitized) GTEST_SKIP() << "the address sanitizer needs more address space than the test allows";
  folder_.write_text("target.exr", target);
  CommandOptions options;
  options.address_space = size_t{3} << 30;
  // 108 bytes per pixel: more than is allowed here, and more than some machines have.
  const CommandResult result = render({"-o", "target.exr", "--size", "12000x12000", "--precision", "double", "-t", "1",
                                       "--aov", "albedo,normal,depth,bounces,samples,variance", "--progress", "none"},
                                      options);
  EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << result.everything();
  EXPECT_EQ(errors_of(result.err).size(), 1u) << result.err;
  EXPECT_NE(result.err.find("--crop"), std::string::npos) << result.err;
  expect_untouched();
}

TEST_F(BadInput, Settings) {
  expect_bad_usage({"--spp", "0"}, {"--spp"});
  expect_bad_usage({"--spp", "-3"}, {"--spp", "-3"});
  expect_bad_usage({"--spp", "many"}, {"--spp"});
  expect_bad_usage({"--spp", "1.5"}, {"--spp"});
  expect_bad_usage({"--spp", "99999999999"}, {"--spp"});
  expect_bad_usage({"--max-depth", "-1"}, {"--max-depth"});
  expect_bad_usage({"--max-depth", "2000", "--integrator", "recursive"}, {"1000"});
  expect_bad_usage({"--seed", "-1"}, {"--seed"});
  expect_bad_usage({"--seed", "4294967296"}, {"--seed"});
  expect_bad_usage({"--seed", "x"}, {"--seed"});
  expect_bad_usage({"--integrator", "bdpt"}, {"bdpt", "path, iterative, recursive, branching"});
  expect_bad_usage({"--sampler", "halton"}, {"halton", "sobol, zsobol, independent"});
  expect_bad_usage({"--backend", "gpu"}, {"gpu", "serial", "openmp"});
  expect_bad_usage({"--backend", "openmp", "--strategy", "columns"}, {"columns", "tiles, rows"});
  expect_bad_usage({"--backend", "serial", "--strategy", "rows"}, {"serial", "rows"});
  expect_bad_usage({"--backend", "serial", "--schedule", "dynamic"}, {"serial", "schedule", "'dynamic'"});
  expect_bad_usage({"--precision", "half"}, {"half", "float, double"});
  expect_bad_usage({"--schedule", "random"}, {"random", "static, dynamic, guided"});
  expect_bad_usage({"--schedule", "dynamic,0"}, {"chunk"});
  expect_bad_usage({"--schedule", "dynamic,x"}, {"chunk"});
  expect_bad_usage({"--schedule", "dynamic,"}, {"chunk"});
  expect_bad_usage({"--aov", "colour"}, {"colour", "albedo, normal"});
  expect_bad_usage({"--threads", "-1"}, {"--threads"});
  expect_bad_usage({"--threads", "5000"}, {"--threads"});
  expect_bad_usage({"--exr-type", "double"}, {"double", "half, float"});
  expect_bad_usage({"--tone-map", "hable"}, {"hable", "none, reinhard, filmic, aces, agx"});
  expect_bad_usage({"--exposure", "bright"}, {"--exposure", "'bright'", "auto"});
  for (const char* white : {"warm", "999", "25001", "nan", "-1"})
    expect_bad_usage({"--white-balance", white}, {"--white-balance", "1000 to 25000 kelvin"});
  for (const char* depth : {"12", "16.0", "many"}) expect_bad_usage({"--png-depth", depth}, {"--png-depth", "8 or 16"});
  for (const char* quality : {"0", "101", "best", "9.5"})
    expect_bad_usage({"--jpeg-quality", quality}, {"--jpeg-quality", "1 to 100"});
  expect_bad_usage({"--progress", "loud"}, {"loud", "auto, plain, json, none"});
  expect_bad_usage({"-q", "--progress", "loud"}, {"loud", "auto, plain, json, none"});
  expect_bad_usage({"--stats=xml"}, {"xml", "text, json"});
  expect_bad_usage({"--time-limit", "-1"}, {"--time-limit"});
  for (const char* number : {"nan", "-nan", "inf", "-inf"}) {
    expect_bad_usage({"--time-limit", number}, {"--time-limit"});
    expect_bad_usage({"--time", number}, {"--time"});
    expect_bad_usage({"--exposure", number}, {"exposure"});
    expect_bad_usage({"--checkpoint", std::string("state,") + number}, {"checkpoint"});
    expect_bad_usage({"--crop", std::string("0,") + number + ",0,1"}, {"crop"});
    expect_bad_usage({"--spp", number}, {"--spp"});
    expect_error({"study", "tune", "scene.pbrt", "--budget", number}, 2, {"--budget"});
    expect_error({"study", "compare", "a", "b", "--threshold", number}, 2, {"--threshold"});
  }
  for (const char* crop : {"0,2,0,1", "-1,1,0,1", "0,1,0,1.001", "0,1,-1e-9,1", "0.5,0.5,0,1", "1,0,0,1"})
    expect_bad_usage({"--crop", crop}, {"crop window", "within 0 and 1"});
  expect_bad_usage({"--resume"}, {"--checkpoint"});
  expect_bad_usage({"--checkpoint", "state,soon"}, {"--checkpoint"});
  expect_bad_usage({"--checkpoint", "state,-1"}, {"checkpoint"});
  expect_bad_usage({"--checkpoint", ",5"}, {"--checkpoint"});
  expect_bad_usage({"--checkpoint", ""}, {"--checkpoint"});
  expect_bad_usage({"--no-such-option"}, {"--no-such-option"});
  expect_bad_usage({"another.pbrt"}, {"another.pbrt"});
  expect_bad_usage({"--spp"}, {"--spp"});
}

TEST_F(BadInput, Usage) {
  expect_error({"render"}, 2, {"SCENE"});
  expect_error({"paint", "scene.pbrt"}, 2, {"paint"});
  expect_error({"render", "scene.pbrt", "b", "--no-such", "c"}, 2, {"not expected: b --no-such c"});
  expect_error({"study", "paint"}, 2, {"no subcommand 'study paint'"});
  expect_error({"study"}, 2, {"subcommand"});
  expect_error({"info"}, 2, {"SCENE"});
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(errors_of(run({}).err).size(), 1u);
}

TEST_F(BadInput, Targets) {
  std::filesystem::create_directory(folder_.file("folder.exr"));
  expect_bad_usage({"-o", "no/such/folder/a.exr"}, {"no/such/folder/a.exr", "does not exist"});
  expect_bad_usage({"-o", "folder.exr"}, {"folder.exr", "folder"});
  expect_bad_usage({"-o", "a.tiff"}, {"a.tiff", ".exr, .png, .jpg, .hdr or .pfm"});
  expect_bad_usage({"-o", "a"}, {".exr, .png, .jpg, .hdr or .pfm"});
  expect_bad_usage({"-o", ""}, {"--output needs a value"});
  expect_bad_usage({"-o", "a.jpg", "--size", "65501x1"}, {"a.jpg", "at most 65500 pixels"});
  expect_bad_usage({"-o", "scene.pbrt/a.exr"}, {"scene.pbrt/a.exr"});
  std::filesystem::create_symlink("loop.exr", folder_.file("loop.exr"));
  std::filesystem::create_symlink("pong.exr", folder_.file("ping.exr"));
  std::filesystem::create_symlink("ping.exr", folder_.file("pong.exr"));
  std::filesystem::create_symlink("no/such/folder/a.exr", folder_.file("lost.exr"));
  expect_bad_usage({"-o", "loop.exr"}, {"loop.exr: ", "circle"});
  expect_bad_usage({"-o", "ping.exr"}, {"ping.exr: ", "circle"});
  expect_bad_usage({"-o", "lost.exr"}, {"lost.exr: ", "does not exist"});
  expect_bad_usage({"-o", std::string(300, 'a') + ".exr"}, {"shorter name"});
  expect_bad_usage({"-o", std::string(300, 'a') + "/a.exr"}, {"shorter name"});
  std::string deep;
  for (int i = 0; i < 2500; ++i) deep += "./";
  expect_bad_usage({"-o", deep + "a.exr"}, {"shorter name"});
  expect_bad_usage({"--checkpoint", "loop.exr"}, {"loop.exr: ", "circle"});
  expect_bad_usage({"--checkpoint", std::string(300, 'a')}, {"shorter name"});
}

/// Two names of one file: one of the two contents would be lost.
TEST_F(BadInput, TheSameFileTwice) {
  folder_.write_text("a.exr", "an older picture");
  std::filesystem::create_symlink("a.exr", folder_.file("link.exr"));
  std::filesystem::create_symlink("new.exr", folder_.file("dangling.exr"));
  std::filesystem::create_hard_link(folder_.file("a.exr"), folder_.file("hard.exr"));
  std::filesystem::create_directory(folder_.file("sub"));
  std::filesystem::create_directory_symlink(".", folder_.file("here"));
  for (const auto& [one, other] : std::vector<std::pair<std::string, std::string>>{{"a.exr", "a.exr"},
                                                                                   {"a.exr", "./a.exr"},
                                                                                   {"a.exr", folder_.file("a.exr")},
                                                                                   {"a.exr", "sub/../a.exr"},
                                                                                   {"a.exr", "link.exr"},
                                                                                   {"a.exr", "hard.exr"},
                                                                                   {"new.exr", "./new.exr"},
                                                                                   {"new.exr", "here/new.exr"},
                                                                                   {"dangling.exr", "new.exr"}}) {
    expect_bad_usage({"-o", one, "-o", other}, {other + ": ", "same file"});
    expect_bad_usage({"-o", one, "--checkpoint", other, "--overwrite"}, {other + ": ", "same file"});
  }
  EXPECT_EQ(read_file(folder_.file("a.exr")).size(), std::string("an older picture").size());
  if (!std::filesystem::exists("/dev/null")) return;
  std::filesystem::create_symlink("/dev/null", folder_.file("null.exr"));
  std::filesystem::create_symlink("/dev/null", folder_.file("null.png"));
  EXPECT_EQ(render({"-o", "null.exr", "-o", "null.png", "--spp", "1"}).exit_code, 0) << "nothing is lost in /dev/null";
}

TEST_F(BadInput, OverWhatIsRead) {
  const Bytes scene = read_file(folder_.file("scene.pbrt"));
  Image sky{4, 2, {"R", "G", "B"}, std::vector(3, std::vector<float>(8, 0.5f))};
  write_exr(folder_.file("sky.exr"), source_of(sky), {});
  const Bytes map = read_file(folder_.file("sky.exr"));
  std::filesystem::create_symlink("scene.pbrt", folder_.file("link"));
  std::filesystem::create_hard_link(folder_.file("scene.pbrt"), folder_.file("hard.png"));
  for (const std::string name : {"scene.pbrt", "./scene.pbrt", "link", "hard.png"})
    expect_bad_usage({"--checkpoint", name, "--overwrite"}, {name + ": ", "same file", "the scene"});
  expect_bad_usage({"-o", "hard.png"}, {"hard.png: ", "same file", "the scene"});
  expect_bad_usage({"-o", "sky.exr", "--environment", "sky.exr"}, {"sky.exr: ", "same file", "environment"});
  expect_bad_usage({"--checkpoint", "sky.exr", "--environment", "./sky.exr", "--overwrite"},
                   {"sky.exr: ", "same file", "environment"});
  EXPECT_EQ(read_file(folder_.file("scene.pbrt")), scene);
  EXPECT_EQ(read_file(folder_.file("sky.exr")), map);
}

/// Textures, meshes, included files and everything else that the scene refers to, by any name; images and buffers of
/// glTF.
TEST_F(BadInput, OverWhatTheSceneNames) {
  const Image grey{2, 2, {"R", "G", "B"}, std::vector(3, std::vector<float>(4, 0.5f))};
  write_png(folder_.file("tex.png"), source_of(grey), {});
  folder_.write_text("part.pbrt", "Shape \"sphere\"");
  folder_.write_text("m.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder_.write_text("a.pbrt",
                     "WorldBegin LightSource \"infinite\"\n"
                     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"tex.png\"\n"
                     "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                     "Include \"part.pbrt\"\nShape \"plymesh\" \"string filename\" \"m.ply\"\n");
  folder_.write("a.bin", Bytes(36, 0));
  folder_.write_text(
      "a.gltf",
      "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"a.bin\"}], "
      "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
      "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], \"meshes\": [{\"primitives\": "
      "[{\"attributes\": {\"POSITION\": 0}}]}], \"nodes\": [{\"mesh\": 0}], \"scenes\": [{\"nodes\": [0]}]}");
  std::filesystem::create_hard_link(folder_.file("tex.png"), folder_.file("hard.png"));
  std::filesystem::create_symlink("tex.png", folder_.file("link.png"));
  const auto expect = [&](const std::string& scene, const std::vector<std::string>& options, const std::string& name) {
    std::vector<std::string> all{"render", scene, "--spp", "1", "--size", "8x8", "-q"};
    all.insert(all.end(), options.begin(), options.end());
    expect_error(all, 2, {name + ": ", "same file", "the scene is read from"}, Place::file);
  };
  std::vector<Bytes> before;
  const std::vector<std::string> files{"tex.png", "part.pbrt", "m.ply", "a.bin"};
  for (const std::string& file : files) before.push_back(read_file(folder_.file(file)));
  for (const std::string name : {"tex.png", "./tex.png", "hard.png", "link.png"}) expect("a.pbrt", {"-o", name}, name);
  for (const std::string name : {"tex.png", "part.pbrt", "m.ply"})
    expect("a.pbrt", {"-o", "target.exr", "--checkpoint", name, "--overwrite"}, name);
  expect("a.pbrt", {"-o", "target.exr", "-o", "tex.png", "--confine"}, "tex.png");
  expect("a.gltf", {"-o", "target.exr", "--checkpoint", "a.bin", "--overwrite"}, "a.bin");
  for (size_t i = 0; i < files.size(); ++i) EXPECT_EQ(read_file(folder_.file(files[i])), before[i]) << files[i];
  expect_untouched();
}

TEST_F(BadInput, ReadOnlyFolder) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  std::filesystem::create_directory(folder_.file("locked"));
  std::filesystem::permissions(folder_.file("locked"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_bad_usage({"-o", "locked/a.exr"}, {"locked/a.exr"});
  std::filesystem::permissions(folder_.file("locked"), std::filesystem::perms::owner_all);
}

TEST_F(BadInput, FullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  for (const char* name : {"full.exr", "full.png"}) {
    std::filesystem::create_symlink("/dev/full", folder_.file(name));
    expect_error({"render", "scene.pbrt", "--spp", "1", "-o", name, "-q"}, 1, {name, "No space left"});
  }
}

TEST_F(BadInput, Checkpoints) {
  expect_bad_usage({"--checkpoint", "state", "--resume"}, {"state: ", "checkpoint"});
  expect_bad_usage({"--checkpoint", "no/such/folder/state"}, {"no/such/folder/state"});
  std::filesystem::create_directory(folder_.file("folder"));
  expect_bad_usage({"--checkpoint", "folder"}, {"folder"});
  expect_bad_usage({"--checkpoint", "folder", "--resume"}, {"folder"});
  folder_.write_text("state", "something else");
  expect_bad_usage({"--checkpoint", "state", "--resume"}, {"state: ", "not a checkpoint"});
  expect_bad_usage({"--overwrite"}, {"--checkpoint"});
  expect_bad_usage({"--checkpoint", "state", "--resume", "--overwrite"}, {"--resume", "--overwrite"});
  ASSERT_EQ(render({"-o", "a.exr", "--spp", "4", "--checkpoint", "state", "--overwrite"}).exit_code, 0);
  std::string other = cornell_box(24);
  other.replace(other.find("0.725"), 5, "0.525");
  folder_.write_text("other.pbrt", other);
  expect_error({"render", "other.pbrt", "-o", "target.exr", "--spp", "8", "--checkpoint", "state", "--resume"}, 2,
               {"state: ", "another scene"}, Place::file);
  expect_bad_usage({"--checkpoint", "state", "--resume", "--seed", "3"},
                   {"state: ", "other settings: it was written with seed 0,"});
  Bytes cut = read_file(folder_.file("state"));
  cut.resize(cut.size() / 2);
  folder_.write("state", cut);
  expect_bad_usage({"--checkpoint", "state", "--resume"}, {"state: ", "damaged"});
}

}  // namespace

}  // namespace alhazen::impl::test
