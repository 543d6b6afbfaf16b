// Messages go to the function that the program sets, and nowhere else; warnings are values.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "alhazen/log.h"
#include "alhazen/rays.h"
#include "alhazen/renderer.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

struct Line {
  LogLevel level;
  std::string text;
};

/// Records the log for as long as it exists.
class RecordedLog {
 public:
  RecordedLog() {
    set_log([this](LogLevel level, const std::string& text) { lines.push_back({level, text}); });
  }
  ~RecordedLog() { set_log({}); }
  RecordedLog(const RecordedLog&) = delete;
  RecordedLog& operator=(const RecordedLog&) = delete;

  std::vector<std::string> of(LogLevel level) const {
    std::vector<std::string> texts;
    for (const Line& line : lines)
      if (line.level == level) texts.push_back(line.text);
    return texts;
  }

  std::vector<Line> lines;
};

constexpr const char* scene_without_area =
    "WorldBegin LightSource \"infinite\"\nShape \"sphere\"\n  Shape \"trianglemesh\" \"point3 P\" [0 0 0  0 0 0  0 0 "
    "0]\n";

}  // namespace

TEST_F(SceneTest, LogsHaveStepsAndWarnings) {
  const std::string file = folder_.write_text("warned.pbrt", scene_without_area);
  RecordedLog log;
  const RenderedImage image = render(file, quick_settings());
  const std::vector<std::string> steps = log.of(LogLevel::info);
  for (const char* const step : {"reading the scene", "building the BVH", "rendering"})
    EXPECT_EQ(std::count(steps.begin(), steps.end(), step), 1) << step;
  std::vector<std::string> warned;
  for (const Warning& warning : image.warnings) warned.push_back(warning.text());
  EXPECT_FALSE(warned.empty());
  EXPECT_EQ(log.of(LogLevel::warning), warned);
}

TEST_F(SceneTest, WarningsHaveTheirPlace) {
  const std::string file = folder_.write_text("warned.pbrt", scene_without_area);
  const auto expect_place = [&](const std::vector<Warning>& warnings) {
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].file, file);
    EXPECT_EQ(warnings[0].line, 3);
    EXPECT_EQ(warnings[0].column, 3);
    EXPECT_EQ(warnings[0].text(), file + ":3:3: " + warnings[0].message);
  };
  const alhazen::Scene scene = alhazen::Scene::load(file);
  expect_place(render(file, quick_settings()).warnings);
  expect_place(RayQueries::from_file(file).warnings());
  Renderer renderer(quick_settings());
  renderer.render(scene);
  expect_place(renderer.warnings());
  EXPECT_EQ((Warning{.message = "one"}).text(), "one");
  EXPECT_EQ((Warning{.message = "two\n\x1b[2J", .file = "a b"}).text().find('\x1b'), std::string::npos);
}

TEST_F(SceneTest, LogsThatThrowEndNothing) {
  const std::string file = folder_.write_text("warned.pbrt", scene_without_area);
  set_log([](LogLevel, const std::string&) { throw std::runtime_error("the log is full"); });
  EXPECT_NO_THROW(render(file, quick_settings()));
  set_log({});
}

TEST_F(SceneTest, NothingIsPrinted) {
  const std::string file = folder_.write_text("warned.pbrt", scene_without_area);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  render(file, quick_settings());
  EXPECT_THROW(render(folder_.file("none.pbrt")), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace alhazen::test
