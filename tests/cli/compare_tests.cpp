// Options of `alhazen compare`: limits, layers, regions, heat maps, pages.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Compare : public Command {
 protected:
  /// Two images that differ by 0.25 in the left half of the colours, and by 1 everywhere in depth.
  Compare() {
    write("a.exr", 0.5f, 2);
    write("b.exr", 0.25f, 1);
  }

  void write(const std::string& name, float left, float depth) const {
    constexpr size_t pixels = 40 * 20;
    Image image{40, 20, {"R", "G", "B", "depth.Z"}, std::vector(4, std::vector<float>(pixels, 0.5f))};
    for (size_t i = 0; i < pixels; ++i)
      for (size_t c = 0; c < 3; ++c)
        if (i % 40 < 20) image.planes[c][i] = left;
    image.planes[3].assign(pixels, depth);
    WriteOptions options;
    options.pixel_type = ExrPixelType::single;
    write_exr(folder_.file(name), source_of(image), options);
  }

  CommandResult compare(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"compare", "a.exr", "b.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  nlohmann::json json(std::vector<std::string> more) const {
    more.emplace_back("--json");
    const CommandResult result = compare(more);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out);
  }
};

TEST_F(Compare, FailsAboveALimitAndSaysWhich) {
  EXPECT_EQ(compare({"--fail-above", "mse=0.04", "--fail-above", "flip=1", "--fail-below", "psnr=5"}).exit_code, 0);
  const CommandResult result =
      compare({"--fail-above", "mse=0.03", "--fail-above", "rmse=1", "--fail-below", "psnr=90", "--json"});
  EXPECT_EQ(result.exit_code, 1);
  const std::vector<std::string> lines = lines_of(result.err);
  ASSERT_EQ(lines.size(), 2u) << result.err;
  EXPECT_EQ(lines[0], "alhazen: mse is 0.03125, above 0.03");
  EXPECT_NE(lines[1].find("psnr is "), std::string::npos);
  EXPECT_EQ(only_json(result.out)["mse"], 0.03125) << "the report is printed all the same";
  for (const char* measure : {"mse", "rmse", "relmse", "relmse_trimmed", "flip", "max_abs", "mean_a", "mean_b"})
    EXPECT_EQ(compare({"--fail-above", std::string(measure) + "=0"}).exit_code, 1) << measure;
  EXPECT_EQ(run({"compare", "a.exr", "a.exr", "--fail-below", "psnr=1000", "--fail-above", "flip=0"}).exit_code, 0);
  for (const char* wrong : {"mse", "mse=", "mse=x", "mse=nan", "error=1", "=1"})
    EXPECT_EQ(compare({"--fail-above", wrong}).exit_code, 2) << wrong;
}

/// Colours that are NaN in some pixels.
TEST_F(Compare, PixelsThatAreNotFinitePassNoLimit) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto write_pfm_of = [&](const std::string& name, size_t first_nan, size_t end_nan) {
    Image image{8, 8, {"R", "G", "B"}, std::vector(3, std::vector<float>(64, 0.5f))};
    for (size_t i = first_nan; i < end_nan; ++i) image.planes[i % 3][i] = nan;
    write_image(folder_.file(name), source_of(image), {});
  };
  write_pfm_of("good.pfm", 0, 0);
  write_pfm_of("one.pfm", 3, 4);
  write_pfm_of("none.pfm", 0, 64);
  const std::vector<std::vector<std::string>> limits{{"--fail-above", "mse=1"},          {"--fail-above", "flip=1"},
                                                     {"--fail-below", "psnr=0"},         {"--fail-below", "ssim=-1"},
                                                     {"--fail-above", "mean_a=9"},       {"--fail-above", "max_abs=9"},
                                                     {"--fail-above", "nonfinite_a=1e9"}};
  const auto compared = [&](const std::string& a, const std::string& b, std::vector<std::string> more) {
    more.insert(more.begin(), {"compare", a, b});
    return run(more);
  };
  for (const std::vector<std::string>& limit : limits) {
    for (const auto& [a, b] : {std::pair{"none.pfm", "none.pfm"}, {"none.pfm", "good.pfm"}, {"good.pfm", "none.pfm"}}) {
      const CommandResult result = compared(a, b, limit);
      EXPECT_EQ(result.exit_code, 1) << a << b << limit[1] << result.everything();
      EXPECT_EQ(result.err, "alhazen: no pixel is finite in both images: nothing is compared, and every limit fails\n");
    }
    EXPECT_EQ(compared("one.pfm", "one.pfm", limit).exit_code, 0) << limit[1] << ": at the same place";
    const CommandResult alone = compared("one.pfm", "good.pfm", limit);
    const bool is_decided = limit[1].starts_with("nonfinite");
    EXPECT_EQ(alone.exit_code, is_decided ? 0 : 1) << limit[1] << alone.everything();
    if (!is_decided) {
      EXPECT_EQ(alone.err.find("alhazen: 1 pixel has NaN or infinity in one of the images alone"), 0u) << alone.err;
    }
  }
  EXPECT_EQ(compared("one.pfm", "good.pfm", {"--fail-above", "nonfinite_in_one=0"}).exit_code, 1);
  EXPECT_EQ(compared("one.pfm", "good.pfm", {"--fail-above", "nonfinite_in_one=1", "--fail-above", "mse=0"}).exit_code,
            0);
  const nlohmann::json of_none = only_json(compared("none.pfm", "good.pfm", {"--json"}).out);
  EXPECT_NEAR(of_none["mean_b"].get<double>(), 0.5, 1e-9);
  EXPECT_TRUE(of_none["mean_a"].is_null() && of_none["psnr"].is_null() && of_none["max_abs"].is_null());
  EXPECT_EQ(of_none["compared"], 0);
  const std::string table = compared("one.pfm", "good.pfm", {}).out;
  EXPECT_NE(table.find("1 in A and 0 in B, 1 of them in one alone"), std::string::npos) << table;
}

TEST_F(Compare, Layers) {
  const nlohmann::json all = json({"--layer", "all"})["layers"];
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all["colours"]["mse"], 0.03125);
  EXPECT_EQ(all["depth"]["mse"], 1);
  EXPECT_EQ(json({"--layer", "depth"})["layers"]["depth"]["mse"], 1);
  const CommandResult none = compare({"--layer", "normal"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("its layers are the colours, 'depth'"), std::string::npos) << none.err;
  const CommandResult limit = compare({"--layer", "all", "--fail-above", "mse=0.5"});
  EXPECT_EQ(limit.exit_code, 1);
  EXPECT_EQ(limit.err, "alhazen: depth: mse is 1, above 0.5\n");
}

TEST_F(Compare, Regions) {
  EXPECT_EQ(json({"--region", "0,0,20,20"})["mse"], 0.0625);
  EXPECT_EQ(json({"--region", "20,0,40,20"})["mse"], 0);
  EXPECT_EQ(json({"--region", "10,3,30,19"})["mse"], 0.03125);
  for (const char* wrong : {"0,0,41,20", "-1,0,4,4", "5,5,5,9", "0,0,4", "0,0,4,x"})
    EXPECT_EQ(compare({"--region", wrong}).exit_code, 2) << wrong;
}

TEST_F(Compare, HeatMap) {
  EXPECT_EQ(compare({"--heat-map", "map.png", "--region", "10,0,40,20"}).exit_code, 0);
  const Image map = image("map.png");
  EXPECT_EQ(map.width, 30);
  EXPECT_GT(map.planes[0].front(), map.planes[0].back()) << "the left differs";
  EXPECT_EQ(compare({"--heat-map", "two.png", "--layer", "all"}).exit_code, 2);
  EXPECT_FALSE(exists("two.png"));
}

TEST_F(Compare, PageHasEverythingInIt) {
  EXPECT_EQ(compare({"--html", "page.html", "--layer", "all"}).exit_code, 0);
  const Bytes bytes = read_file(folder_.file("page.html"));
  const std::string page(bytes.begin(), bytes.end());
  size_t images = 0;
  for (size_t at = page.find("src=\""); at != std::string::npos; at = page.find("src=\"", at + 1)) {
    EXPECT_EQ(page.compare(at, 27, "src=\"data:image/png;base64,"), 0);
    ++images;
  }
  EXPECT_EQ(images, 6u) << "A, B and the error of two layers";
  EXPECT_NE(page.find("width=device-width"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "nothing is fetched";
  EXPECT_EQ(compare({"--html", "page.txt"}).exit_code, 2);
  const CommandResult over = run({"compare", "a.exr", "page.html", "--html", "page.html"});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_EQ(read_file(folder_.file("page.html")), bytes);
}

}  // namespace

}  // namespace alhazen::impl::test
