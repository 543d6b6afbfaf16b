// Somebody who looks at an image while it is rendered does not change it, whatever engine takes the samples and however
// passes end.

#include <cmath>

#include "parity/engines.h"
#include "parity/scenes.h"
#include "render/pass_loop.h"

namespace alhazen::impl::test {

namespace {

/// Looks between all passes, which then have as few samples as they can, and reads the whole image.
class EagerWatcher : public RenderWatcher {
 public:
  double seconds_to_look() override { return 0; }
  void look(const Rendering& so_far) override {
    const Outcome outcome = outcome_of(so_far);
    samples.push_back(outcome.statistics.samples_per_pixel);
    means.push_back(outcome.statistics.mean_samples);
    EXPECT_FALSE(outcome.statistics.complete);
    EXPECT_TRUE(so_far.has_samples());
    EXPECT_TRUE(so_far.denoised.empty());
    last = outcome;
  }
  void has_looked(double seconds) override {
    EXPECT_GT(seconds, 0);
    ++looked;
  }

  std::vector<uint32_t> samples;
  std::vector<double> means;
  size_t looked = 0;
  Outcome last;
};

Outcome render_watched(Scene scene, const Settings& settings, RenderWatcher& watcher) {
  Diagnostics diagnostics;
  const RenderSettings resolved = resolve_settings(settings, scene);
  RenderEvents events;
  events.watcher = &watcher;
  return outcome_of(render_scene(std::move(scene), resolved, 0, events, diagnostics));
}

Settings settings_of(const std::string& precision, int64_t samples) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = samples;
  settings.width = 9;
  settings.height = 7;
  return settings;
}

class Watcher : public ::testing::TestWithParam<std::string> {};

TEST_P(Watcher, ChangesNoBits) {
  Settings settings = settings_of(GetParam(), 42);
  settings.aovs = all_aovs;
  const Outcome expected = render_bits(parity_scene("spheres"), settings);
  const auto check = [&](const Settings& other) {
    SCOPED_TRACE(other.backend + " " + other.strategy);
    EagerWatcher watcher;
    const Outcome watched = render_watched(parity_scene("spheres"), other, watcher);
    EXPECT_TRUE(same_bits(expected, watched));
    EXPECT_TRUE(watched.statistics.complete);
    EXPECT_EQ(watched.statistics.samples_per_pixel, 42u);
    EXPECT_EQ(watcher.looked, watcher.samples.size());
    ASSERT_EQ(watcher.samples.size(), 10u) << "after each block but the last, which has two samples";
    for (size_t i = 0; i < watcher.samples.size(); ++i) {
      EXPECT_EQ(watcher.samples[i], 4 * (i + 1));
      EXPECT_EQ(watcher.means[i], 4 * (static_cast<double>(i) + 1));
    }
  };
  check(settings);
  visit_engines(settings, check);
}

/// What is seen is the image of so many samples.
TEST_P(Watcher, SeesTheImageOfFewerSamples) {
  EagerWatcher watcher;
  render_watched(parity_scene("cornell"), settings_of(GetParam(), 25), watcher);
  ASSERT_EQ(watcher.samples.back(), 24u);
  EXPECT_TRUE(same_bits(watcher.last, render_bits(parity_scene("cornell"), settings_of(GetParam(), 24))));
}

TEST_P(Watcher, ChangesNoDecisionsOfANoiseTarget) {
  Settings settings = settings_of(GetParam(), 200);
  settings.noise = 0.08;
  settings.aovs = {"samples"};
  const Outcome expected = render_bits(parity_scene("spheres"), settings);
  ASSERT_LT(expected.statistics.mean_samples, 200);
  const auto check = [&](const Settings& other) {
    EagerWatcher watcher;
    EXPECT_TRUE(same_bits(expected, render_watched(parity_scene("spheres"), other, watcher))) << other.backend;
    EXPECT_GT(watcher.samples.size(), 4u);
  };
  check(settings);
  visit_engines(settings, check);
}

TEST_P(Watcher, ChangesNothingThatGuidingLearns) {
  Settings settings = settings_of(GetParam(), 1101);
  settings.guiding = "on";
  settings.noise = 0.001;
  settings.width = 5;
  settings.height = 5;
  const Outcome expected = render_bits(parity_scene("cornell"), settings);
  ASSERT_GE(expected.statistics.guiding.iterations, 2u);
  EagerWatcher watcher;
  EXPECT_TRUE(same_bits(expected, render_watched(parity_scene("cornell"), settings, watcher)));
  settings.noise = 0;
  EXPECT_TRUE(same_bits(render_bits(parity_scene("cornell"), settings),
                        render_watched(parity_scene("cornell"), settings, watcher)));
}

TEST_P(Watcher, ChangesNoCheckpoint) {
  const TemporaryFolder folder;
  Settings settings = settings_of(GetParam(), 20);
  settings.checkpoint = folder.file("state");
  settings.checkpoint_seconds = 0;
  EagerWatcher watcher;
  render_watched(parity_scene("cornell"), settings, watcher);
  settings.samples_per_pixel = 50;
  settings.resume = true;
  const Outcome resumed = render_watched(parity_scene("cornell"), settings, watcher);
  EXPECT_EQ(watcher.samples.at(4), 24u);
  EXPECT_TRUE(same_bits(resumed, render_bits(parity_scene("cornell"), settings_of(GetParam(), 50))));
}

INSTANTIATE_TEST_SUITE_P(Parity, Watcher, ::testing::Values("float", "double"));

/// Stops the render by its time limit, which looks count towards.
TEST(Watchers, LooksCountTowardsTheTimeLimit) {
  class Slow : public EagerWatcher {
   public:
    void look(const Rendering& so_far) override {
      EagerWatcher::look(so_far);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  };
  Settings settings = settings_of("float", 16'000'000);
  settings.time_limit = 0.5;
  Slow watcher;
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = render_watched(parity_scene("cornell"), settings, watcher);
  EXPECT_LT(seconds_since(start), 3);
  EXPECT_FALSE(outcome.statistics.complete);
  EXPECT_LE(watcher.looked, 5u);
}

TEST(Watchers, WhatALookThrowsEndsTheRender) {
  class Failing : public EagerWatcher {
   public:
    void look(const Rendering&) override { throw std::runtime_error("seen enough"); }
  };
  Failing watcher;
  EXPECT_THROW(render_watched(parity_scene("cornell"), settings_of("float", 64), watcher), std::runtime_error);
}

/// Nobody who waits: the passes are as without.
TEST(Watchers, ShortenPassesOnlyAsTheyNeed) {
  RenderSettings settings;
  settings.samples_per_pixel = 1024;
  const auto size = [&](double per_sample, double longest) {
    return pass_size(settings, 64, 0, 128, 1, per_sample, longest);
  };
  const double never = std::numeric_limits<double>::infinity();
  EXPECT_EQ(size(0.1, never), pass_size(settings, 64, 0, 128, 1, 0.1));
  EXPECT_EQ(size(0.1, never), 64u);
  EXPECT_EQ(size(0.1, 100), 64u) << "longer than any pass";
  EXPECT_EQ(size(0.1, 2), 20u);
  EXPECT_EQ(size(0.1, 2.05), 20u) << "whole blocks";
  EXPECT_EQ(size(0.1, 2.15), 24u);
  EXPECT_EQ(size(0.1, 0), 4u);
  EXPECT_EQ(size(0.1, -1), 4u);
  EXPECT_EQ(size(0, 5), 4u) << "of the first pass nothing is known";
  EXPECT_EQ(pass_size(settings, 64, 32, 128, 1, 0.1, 0), 32u) << "as many as a caller wants";
  settings.asked.time_limit = 100;
  EXPECT_EQ(size(0.1, 2), 20u);
  EXPECT_EQ(size(0.1, never), 64u);
}

}  // namespace

}  // namespace alhazen::impl::test
