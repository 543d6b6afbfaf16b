// Behaviour during a render: progress, interruption, limits, checkpoints.

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

using Running = Command;

/// More samples than any machine takes before the test interferes.
const std::string endless = "10000000";

bool is_same(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels && a.planes == b.planes;
}

int interrupt_at_progress(const std::string& err) {
  return err.find("\"samples_done\"") != std::string::npos ? SIGINT : 0;
}

TEST_F(Running, ProgressIsLinesOfJsonOnStderr) {
  const CommandResult result = render({"-o", "a.exr", "--spp", endless, "--time-limit", "2.5", "--progress", "json"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.out, "");
  int parsed = 0;
  double last = -1;
  for (const std::string& line : lines_of(result.err)) {
    if (line.empty() || line[0] != '{') continue;
    const nlohmann::json j = nlohmann::json::parse(line, nullptr, false);
    ASSERT_FALSE(j.is_discarded()) << line;
    if (j.contains("activity")) continue;
    for (const char* key :
         {"fraction", "seconds", "seconds_left", "samples_done", "samples_total", "samples_per_second", "noise"})
      EXPECT_TRUE(j[key].is_number()) << key;
    EXPECT_GE(j["fraction"], last);
    EXPECT_LE(j["fraction"], 1.0);
    last = j["fraction"];
    ++parsed;
  }
  EXPECT_GE(parsed, 2);
}

TEST_F(Running, ProgressEndsAtOne) {
  const CommandResult result = render({"-o", "a.exr", "--spp", "8", "--progress", "json"});
  std::string last;
  for (const std::string& line : lines_of(result.err))
    if (line.starts_with("{")) last = line;
  const nlohmann::json j = nlohmann::json::parse(last, nullptr, false);
  ASSERT_FALSE(j.is_discarded()) << result.err;
  EXPECT_EQ(j["fraction"], 1.0);
  EXPECT_EQ(j["samples_done"], j["samples_total"]);
}

TEST_F(Running, PlainProgressHasNoControlCharacters) {
  for (const char* style : {"plain", "auto"}) {
    const CommandResult result = render({"-o", "a.exr", "--spp", endless, "--time-limit", "2.5", "--progress", style});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find("Msamples/s"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find_first_of("\r\x1b"), std::string::npos) << result.err;
  }
}

TEST_F(Running, InterruptWritesTheImageSoFar) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    CommandOptions options;
    options.signal_when = [&](const std::string& err) { return interrupt_at_progress(err) ? signal_number : 0; };
    const CommandResult result = render(
        {"-o", "a.exr", "-o", "a.png", "--spp", endless, "--progress", "json", "--stats=json", "--aov", "samples"},
        options);
    EXPECT_EQ(result.exit_code, 130) << result.everything();
    EXPECT_LT(result.seconds, 60);
    EXPECT_NE(result.err.find("interrupted"), std::string::npos);
    const nlohmann::json j = only_json(result.out);
    EXPECT_FALSE(j["complete"]);
    EXPECT_GT(j["camera_samples"], 0);
    const Image rendered = image("a.exr");
    float brightest = 0;
    for (const float value : rendered.planes.at(static_cast<size_t>(rendered.channel("R"))))
      brightest = std::max(brightest, value);
    EXPECT_GT(brightest, 0.1f);
    EXPECT_EQ(image("a.png").width, 24);
    std::filesystem::remove(folder_.file("a.exr"));
    std::filesystem::remove(folder_.file("a.png"));
  }
}

TEST_F(Running, TimeLimitStopsAndIsNoFailure) {
  const CommandResult result =
      render({"-o", "a.exr", "--spp", endless, "--time-limit", "1", "--progress", "none", "--stats=json"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_LT(result.seconds, 30);
  const nlohmann::json j = only_json(result.out);
  EXPECT_FALSE(j["complete"]);
  EXPECT_GE(j["spp"], 4);
  EXPECT_GE(j["mean_spp"], j["spp"]);
  EXPECT_EQ(j["camera_samples"].get<int64_t>(), std::lround(j["mean_spp"].get<double>() * 24 * 24));
  EXPECT_LT(j["render_seconds"], 2.0);
  EXPECT_TRUE(exists("a.exr"));
}

/// In the first pass, which would take seconds: pixels that were reached are right, the others black, and it says so.
TEST_F(Running, TimeLimitStopsInTheMiddleOfAPass) {
  const std::vector<std::string> common{"--size", "1000x1000", "--backend", "serial", "--exr-type", "float"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), common.begin(), common.end());
    return render(more);
  };
  const CommandResult result = with({"-o", "a.exr", "--spp", endless, "--time-limit", "0.2", "--stats=json"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("the time limit passed before every pixel had a sample"), std::string::npos) << result.err;
  const nlohmann::json j = only_json(result.out);
  EXPECT_LT(j["render_seconds"], 1.5);
  EXPECT_GT(j["mean_spp"], 0);
  EXPECT_LT(j["mean_spp"], 4);
  ASSERT_EQ(with({"-o", "b.exr", "--spp", "4"}).exit_code, 0);
  const Image part = image("a.exr"), whole = image("b.exr");
  const std::vector<float>&a = part.planes.at(static_cast<size_t>(part.channel("R"))),
        &b = whole.planes.at(static_cast<size_t>(whole.channel("R")));
  size_t same = 0, black = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    same += a[i] == b[i] && b[i] > 0;
    black += a[i] == 0 && b[i] > 0;
  }
  EXPECT_GT(same, 0u);
  EXPECT_GT(black, 0u);
  const auto lit = static_cast<size_t>(std::count_if(b.begin(), b.end(), [](float value) { return value > 0; }));
  EXPECT_GE(same + black + 1, lit);  // the last pixel may be in between
}

TEST_F(Running, TimeLimitBeforeTheFirstSampleWritesNothing) {
  const CommandResult result = render({"-o", "a.exr", "--spp", endless, "--time-limit", "1e-9"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("before the first sample"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("a.exr"));
}

TEST_F(Running, TimeLimitThatIsLongEnoughChangesNothing) {
  ASSERT_EQ(render({"-o", "a.exr", "--spp", "10"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "b.exr", "--spp", "10", "--time-limit", "1000"}).exit_code, 0);
  EXPECT_TRUE(is_same(image("a.exr"), image("b.exr")));
}

TEST_F(Running, ResumeEndsInTheSameBits) {
  const std::vector<std::string> layers{"--aov", "albedo,normal,depth,bounces,samples,variance", "--exr-type", "float"};
  const auto with_layers = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), layers.begin(), layers.end());
    return render(arguments);
  };
  ASSERT_EQ(with_layers({"-o", "once.exr", "--spp", "41"}).exit_code, 0);
  ASSERT_EQ(with_layers({"-o", "part.exr", "--spp", "18", "--checkpoint", "state,0"}).exit_code, 0);
  ASSERT_TRUE(exists("state"));
  ASSERT_EQ(with_layers({"-o", "whole.exr", "--spp", "41", "--checkpoint", "state", "--resume"}).exit_code, 0);
  EXPECT_TRUE(is_same(image("once.exr"), image("whole.exr")));
  EXPECT_FALSE(is_same(image("once.exr"), image("part.exr")));
  const CommandResult compared = run({"compare", "once.exr", "whole.exr", "--json"});
  EXPECT_EQ(only_json(compared.out)["mse"], 0.0);
}

TEST_F(Running, ResumeAfterAnInterruptGoesOnFromThere) {
  const std::string samples = "10000";
  CommandOptions options;
  options.signal_when = interrupt_at_progress;
  const CommandResult stopped = render({"-o", "a.exr", "--spp", samples, "--checkpoint", "state", "--progress", "json",
                                        "--stats=json", "--size", "8x8", "-t", "1"},
                                       options);
  ASSERT_EQ(stopped.exit_code, 130) << stopped.everything();
  ASSERT_TRUE(exists("state"));
  const int64_t before = only_json(stopped.out)["camera_samples"];
  const CommandResult resumed = render({"-o", "a.exr", "--spp", samples, "--checkpoint", "state", "--resume", "-q",
                                        "--stats=json", "--size", "8x8", "--exr-type", "float"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.everything();
  EXPECT_EQ(only_json(resumed.out)["camera_samples"].get<int64_t>(), 64 * std::stoll(samples) - before)
      << "what was taken before must not be taken again";
  ASSERT_EQ(render({"-o", "b.exr", "--spp", samples, "-q", "--size", "8x8", "--exr-type", "float"}).exit_code, 0);
  EXPECT_TRUE(is_same(image("a.exr"), image("b.exr")));
}

TEST_F(Running, ResumeWithFewerSamplesThanThereAreIsRefused) {
  ASSERT_EQ(render({"-o", "a.exr", "--spp", "16", "--checkpoint", "state"}).exit_code, 0);
  const CommandResult result = render({"-o", "a.exr", "--spp", "8", "--checkpoint", "state", "--resume"});
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_NE(result.err.find("16 samples"), std::string::npos) << result.err;
}

}  // namespace

}  // namespace alhazen::impl::test
