// The subcommands compare, devices and info, and the help of the program.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Subcommands : public Command {
 protected:
  void write_image(const std::string& name, int width, int height, float value, float first = -1) const {
    const size_t pixels = static_cast<size_t>(width * height);
    Image image{width, height, {"R", "G", "B"}, std::vector(3, std::vector<float>(pixels, value))};
    if (first >= 0) image.planes[1][0] = first;
    WriteOptions options;
    options.pixel_type = ExrPixelType::single;
    write_exr(folder_.file(name), source_of(image), options);
  }
};

TEST_F(Subcommands, CompareOfEqualImagesIsZero) {
  write_image("a.exr", 20, 14, 0.5f);
  const CommandResult result = run({"compare", "a.exr", "a.exr", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err, "");
  const nlohmann::json j = only_json(result.out);
  for (const char* key : {"mse", "rmse", "relmse", "relmse_trimmed", "flip", "max_abs", "nonfinite_a", "nonfinite_b"})
    EXPECT_EQ(j[key], 0) << key;
  EXPECT_NEAR(j["ssim"].get<double>(), 1, 1e-12);
  EXPECT_TRUE(j["psnr"].is_null());
  EXPECT_NEAR(j["mean_a"].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(j["mean_b"].get<double>(), 0.5, 1e-6);
  EXPECT_EQ(j["nonfinite_in_one"], 0);
  EXPECT_GT(j["compared"], 0);
  EXPECT_EQ(j.size(), 14u);
}

TEST_F(Subcommands, CompareMeasures) {
  write_image("a.exr", 20, 14, 0.5f);
  write_image("b.exr", 20, 14, 0.25f);
  const nlohmann::json j = only_json(run({"compare", "a.exr", "b.exr", "--json"}).out);
  EXPECT_DOUBLE_EQ(j["mse"], 0.0625);
  EXPECT_DOUBLE_EQ(j["rmse"], 0.25);
  EXPECT_NEAR(j["relmse"].get<double>(), 0.0625 / (0.0625 + 0.01), 1e-9);
  EXPECT_DOUBLE_EQ(j["max_abs"], 0.25);
  const CommandResult table = run({"compare", "a.exr", "b.exr"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.out.find("0.0625"), std::string::npos) << table.out;
}

TEST_F(Subcommands, CompareCountsWhatIsNotFinite) {
  write_image("a.exr", 20, 14, 0.5f, std::numeric_limits<float>::infinity());
  write_image("b.exr", 20, 14, 0.5f);
  const nlohmann::json j = only_json(run({"compare", "a.exr", "b.exr", "--json"}).out);
  EXPECT_EQ(j["nonfinite_a"], 1);
  EXPECT_EQ(j["nonfinite_b"], 0);
  EXPECT_EQ(j["mse"], 0.0);
}

TEST_F(Subcommands, CompareShowsWhere) {
  write_image("a.exr", 20, 14, 0.5f);
  write_image("b.exr", 20, 14, 0.5f, 1.0f);
  for (const char* name : {"diff.png", "diff.exr"}) {
    EXPECT_EQ(run({"compare", "a.exr", "b.exr", "--diff", name}).exit_code, 0);
    const Image difference = image(name);
    EXPECT_EQ(difference.width, 20);
    EXPECT_EQ(difference.height, 14);
    EXPECT_NE(difference.planes[0].front() + difference.planes[1].front() + difference.planes[2].front(),
              difference.planes[0].back() + difference.planes[1].back() + difference.planes[2].back());
  }
}

TEST_F(Subcommands, CompareRefusesWhatCannotBeCompared) {
  write_image("a.exr", 20, 14, 0.5f);
  write_image("b.exr", 14, 20, 0.5f);
  folder_.write_text("text.png", "no bytes");
  const Bytes before =
      folder_.write_text("diff.png", "as it was") == "" ? Bytes() : read_file(folder_.file("diff.png"));
  const std::vector<std::vector<std::string>> cases{{"compare", "a.exr", "b.exr", "--diff", "diff.png"},
                                                    {"compare", "a.exr", "missing.exr", "--diff", "diff.png"},
                                                    {"compare", "text.png", "a.exr", "--diff", "diff.png"},
                                                    {"compare", "a.exr", "a.exr", "--diff", "diff.tiff"},
                                                    {"compare", "a.exr", ".", "--diff", "diff.png"},
                                                    {"compare", "a.exr"},
                                                    {"compare", "a.exr", "a.exr", "a.exr"}};
  for (const auto& arguments : cases) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(result.err.empty());
    EXPECT_EQ(read_file(folder_.file("diff.png")), before);
  }
  const CommandResult sizes = run({"compare", "a.exr", "b.exr"});
  EXPECT_NE(sizes.err.find("20 x 14"), std::string::npos) << sizes.err;
  EXPECT_EQ(run({"compare", "a.exr", "a.exr", "--diff", "no/such/folder/diff.png"}).exit_code, 2);
  const Bytes bytes = read_file(folder_.file("a.exr"));
  std::filesystem::create_symlink("a.exr", folder_.file("link.exr"));
  for (const char* name : {"a.exr", "./a.exr", "link.exr"}) {
    const CommandResult over_it = run({"compare", "a.exr", "a.exr", "--diff", name});
    EXPECT_EQ(over_it.exit_code, 2) << over_it.everything();
    EXPECT_NE(over_it.err.find("same file"), std::string::npos) << over_it.err;
  }
  EXPECT_EQ(read_file(folder_.file("a.exr")), bytes);
}

TEST_F(Subcommands, DevicesListsTheBackends) {
  const CommandResult table = run({"devices"});
  EXPECT_EQ(table.exit_code, 0);
  for (const char* word : {"serial", "openmp", "rows+reduction"})
    EXPECT_NE(table.out.find(word), std::string::npos) << word;
  const nlohmann::json listing = only_json(run({"devices", "--json"}).out);
  ASSERT_GE(listing["backends"].size(), 2u);
  for (const auto& device : listing["backends"]) {
    EXPECT_TRUE(device["name"].is_string());
    EXPECT_TRUE(device["available"].is_boolean());
    EXPECT_FALSE(device["details"].get<std::string>().empty());
    EXPECT_TRUE(device["strategies"].is_array());
  }
  ASSERT_EQ(listing["denoisers"].size(), 3u);
  for (const auto& denoiser : listing["denoisers"]) EXPECT_FALSE(denoiser["details"].get<std::string>().empty());
  EXPECT_EQ(listing["denoisers"][2]["name"], "builtin");
  EXPECT_EQ(listing["denoisers"][2]["available"], true);
}

TEST_F(Subcommands, InfoSaysWhatASceneHolds) {
  const CommandResult table = run({"info", "scene.pbrt"});
  EXPECT_EQ(table.exit_code, 0) << table.everything();
  EXPECT_NE(table.out.find("36 triangles"), std::string::npos) << table.out;
  const nlohmann::json j = only_json(run({"info", "scene.pbrt", "--json"}).out);
  EXPECT_EQ(j["triangles"], 36);
  EXPECT_EQ(j["lights"].size(), 1u) << "of two triangles";
  EXPECT_EQ(j["width"], 24);
  EXPECT_EQ(j["filter"], "box");
  EXPECT_EQ(j["spp"], 8);
  EXPECT_EQ(run({"info", "missing.pbrt"}).exit_code, 2);
  EXPECT_EQ(folder_.count(), 1u) << "info writes nothing";
}

TEST_F(Subcommands, HelpAndVersion) {
  const CommandResult top = run({"--help"});
  EXPECT_EQ(top.exit_code, 0);
  for (const char* name : {"render", "view", "compare", "devices", "info"}) {
    EXPECT_NE(top.out.find(name), std::string::npos) << name;
    const CommandResult help = run({name, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Usage: alhazen " + std::string(name)), std::string::npos) << help.out;
    EXPECT_EQ(help.err, "");
  }
  EXPECT_NE(top.out.find("Exit codes"), std::string::npos);
  EXPECT_EQ(run({"--version"}).out.rfind("alhazen ", 0), 0u);
}

/// The result is printed even if the image cannot be written.
TEST_F(Subcommands, ComparePrintsItsResultWithoutTheImage) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  write_image("a.exr", 20, 14, 0.5f);
  std::filesystem::create_symlink("/dev/full", folder_.file("full.png"));
  const CommandResult result = run({"compare", "a.exr", "a.exr", "--json", "--diff", "full.png"});
  EXPECT_EQ(result.exit_code, 1) << result.everything();
  EXPECT_EQ(only_json(result.out)["mse"], 0);
}

}  // namespace

}  // namespace alhazen::impl::test
