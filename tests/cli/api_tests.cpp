// The public header: renders a scene file into memory, with progress, cancellation, layers and warnings.

#include <alhazen/alhazen.h>

#include <cmath>

#include "images/image.h"
#include "support/scene_files.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {

namespace {

class Api : public ::testing::Test {
 protected:
  Api() : scene_(folder_.write_text("scene.pbrt", cornell_box(12))) {}

  static Settings quick() {
    Settings settings;
    settings.samples_per_pixel = 4;
    return settings;
  }

  std::string error_of(const Settings& settings) const {
    try {
      render(scene_, settings);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }

  TemporaryFolder folder_;
  std::string scene_;
};

TEST_F(Api, RendersIntoMemory) {
  const RenderedImage image = render(scene_, quick());
  EXPECT_EQ(image.width, 12);
  EXPECT_EQ(image.height, 12);
  EXPECT_TRUE(image.complete);
  EXPECT_TRUE(image.warnings.empty());
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  ASSERT_EQ(image.planes.size(), 3u);
  double sum = 0;
  for (size_t i = 0; i < 144; ++i) {
    EXPECT_TRUE(std::isfinite(image.plane("R")[i]));
    sum += static_cast<double>(image.plane("R")[i]);
  }
  EXPECT_GT(sum / 144, 0.05);
  EXPECT_EQ(image.plane("depth.Z"), nullptr);
  EXPECT_EQ(std::filesystem::exists("cornell.exr"), false) << "nothing is written";
}

TEST_F(Api, ConfinedItReadsNothingOutsideTheFolder) {
  std::filesystem::create_directory(folder_.file("in"));
  folder_.write_text("part.pbrt", "Shape \"sphere\"");
  const std::string scene = folder_.write_text("in/scene.pbrt", "WorldBegin Include \"../part.pbrt\"");
  Settings settings = quick();
  settings.width = settings.height = 4;
  EXPECT_NO_THROW(render(scene, settings));
  settings.confine = true;
  try {
    render(scene, settings);
    FAIL() << "a file outside the folder was read";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("outside the scene's folder"), std::string::npos) << error.what();
  }
}

TEST_F(Api, SettingsAreFollowed) {
  Settings settings = quick();
  settings.width = 10;
  settings.height = 8;
  settings.aovs = {"albedo", "normal", "depth", "bounces", "samples", "variance"};
  settings.pixel_bounds = {{2, 9, 1, 7}};
  settings.precision = "double";
  settings.backend = "openmp";
  settings.strategy = "rows+reduction";
  settings.threads = 2;
  const RenderedImage image = render(scene_, settings);
  EXPECT_EQ(image.width, 7);
  EXPECT_EQ(image.height, 6);
  for (const char* channel : {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z",
                              "depth.Z", "bounces.Y", "samples.Y", "variance.Y"})
    EXPECT_NE(image.plane(channel), nullptr) << channel;
  for (size_t i = 0; i < 42; ++i) EXPECT_EQ(image.plane("samples.Y")[i], 4.0f);
  settings.precision = "float";
  settings.backend = "serial";
  settings.strategy = "auto";
  const RenderedImage serial = render(scene_, settings);
  settings.backend = "openmp";
  settings.threads = 3;
  EXPECT_EQ(serial.planes, render(scene_, settings).planes);
}

TEST_F(Api, RowsRunFromTheTopDown) {
  Settings settings = quick();
  settings.samples_per_pixel = 16;
  const RenderedImage image = render(scene_, settings);
  // The light is in the ceiling.
  const float* green = image.plane("G");
  const auto brightest = std::max_element(green, green + 144) - green;
  EXPECT_LT(brightest / 12, 4);
}

TEST_F(Api, ProgressIsTold) {
  uint64_t calls = 0;
  Progress last;
  const RenderedImage image = render(scene_, quick(), [&](const Progress& progress) {
    EXPECT_GE(progress.fraction, last.fraction);
    EXPECT_LE(progress.samples_done, progress.samples_total);
    last = progress;
    ++calls;
    return true;
  });
  EXPECT_TRUE(image.complete);
  EXPECT_GE(calls, 1u);
  EXPECT_EQ(last.fraction, 1.0);
  EXPECT_EQ(last.samples_done, 12u * 12 * 4);
  EXPECT_EQ(last.samples_total, 12u * 12 * 4);
}

TEST_F(Api, ProgressCanCancel) {
  Settings settings;
  settings.samples_per_pixel = 1 << 24;
  settings.aovs = {"samples"};
  for (const char* backend : {"serial", "openmp"}) {
    settings.backend = backend;
    const RenderedImage image =
        render(scene_, settings, [](const Progress& progress) { return progress.samples_done == 0; });
    EXPECT_FALSE(image.complete);
    EXPECT_EQ(image.width, 12);
    EXPECT_GT(*std::max_element(image.plane("samples.Y"), image.plane("samples.Y") + 144), 0.0f);
  }
}

/// A limit of no time ends some renders before their first sample: a black image would look like one.
TEST_F(Api, WithoutSamplesThereIsNoImage) {
  Settings settings;
  settings.aovs = {"samples"};
  settings.time_limit = 1e-9;
  for (int i = 0; i < 5; ++i) {
    const RenderedImage image = render(scene_, settings);
    EXPECT_FALSE(image.complete);
    EXPECT_EQ(image.planes.size(), image.channels.size());
    EXPECT_EQ(image.planes.empty(), image.width == 0);
    if (const float* samples = image.plane("samples.Y")) {
      EXPECT_GT(*std::max_element(samples, samples + 144), 0.0f);
    }
  }
}

/// An exception that left the progress thread would end the process.
TEST_F(Api, ExceptionsOfTheProgressReachTheCaller) {
  struct NoException {};
  Settings settings;
  settings.samples_per_pixel = 1 << 24;
  for (const char* backend : {"serial", "openmp"}) {
    settings.backend = backend;
    int calls = 0;
    const auto fail_with = [&](const auto& problem) {
      calls = 0;
      return [&calls, problem](const Progress&) -> bool {
        ++calls;
        throw problem;
      };
    };
    try {
      render(scene_, settings, fail_with(std::out_of_range("the listener's own")));
      ADD_FAILURE() << "it was not thrown";
    } catch (const std::out_of_range& error) {
      EXPECT_STREQ(error.what(), "the listener's own");
    }
    EXPECT_EQ(calls, 1) << "it is not called again";
    EXPECT_THROW(render(scene_, settings, fail_with(NoException{})), NoException);
    EXPECT_THROW(render(scene_, settings, fail_with(7)), int);
    EXPECT_THROW(render(scene_, quick(), fail_with(std::bad_alloc())), std::bad_alloc) << "in the last call";
  }
  EXPECT_TRUE(render(scene_, quick()).complete) << "the next render is as any";
}

TEST_F(Api, WhatWasRenderedBeforeAnExceptionIsInTheCheckpoint) {
  Settings settings = quick();
  settings.samples_per_pixel = 1 << 20;
  settings.checkpoint = folder_.file("state");
  const auto fail = [](const Progress& progress) -> bool {
    if (progress.samples_done > 100 * 144) throw std::runtime_error("enough");
    return true;
  };
  EXPECT_THROW(render(scene_, settings, fail), std::runtime_error);
  settings.resume = true;
  uint64_t first = 0;
  render(scene_, settings, [&](const Progress& progress) {
    first = progress.samples_done;
    return progress.activity != std::string("rendering");
  });
  EXPECT_GE(first, 4u * 144);
}

TEST_F(Api, CheckpointsReplaceNothingUnasked) {
  Settings settings = quick();
  settings.checkpoint = scene_;
  EXPECT_NE(error_of(settings).find("same file"), std::string::npos);
  settings.overwrite = true;
  EXPECT_NE(error_of(settings).find("same file"), std::string::npos);
  settings.checkpoint = folder_.write_text("notes", "a text of the user");
  EXPECT_EQ(error_of(settings), "");
  settings.overwrite = false;
  EXPECT_NE(error_of(settings).find("4 samples"), std::string::npos);
}

TEST_F(Api, TimeLimitEndsEarly) {
  Settings settings;
  settings.samples_per_pixel = 1 << 24;
  settings.time_limit = 0.3;
  EXPECT_FALSE(render(scene_, settings).complete);
}

TEST_F(Api, WarningsComeWithTheImage) {
  const std::string scene = folder_.write_text(
      "warned.pbrt", cornell_box(8) + "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  0 0 0  0 0 0 ]\n");
  const RenderedImage image = render(scene, quick());
  ASSERT_EQ(image.warnings.size(), 1u);
  const Warning& warning = image.warnings[0];
  EXPECT_EQ(warning.file, scene);
  EXPECT_GT(warning.line, 1);
  EXPECT_GE(warning.column, 1);
  EXPECT_NE(warning.message.find("no area"), std::string::npos);
  EXPECT_EQ(warning.text(),
            scene + ":" + std::to_string(warning.line) + ":" + std::to_string(warning.column) + ": " + warning.message);
}

TEST_F(Api, ErrorsAreOneMessage) {
  Settings settings = quick();
  settings.backend = "abacus";
  EXPECT_NE(error_of(settings).find("abacus"), std::string::npos);
  settings = quick();
  settings.width = -5;
  EXPECT_NE(error_of(settings).find("width"), std::string::npos);
  settings = quick();
  settings.time_limit = -1;
  EXPECT_NE(error_of(settings).find("time"), std::string::npos);
  settings = quick();
  settings.aovs = {"colour"};
  EXPECT_NE(error_of(settings).find("colour"), std::string::npos);
  settings = quick();
  settings.samples_per_pixel = -1;
  EXPECT_NE(error_of(settings).find("samples"), std::string::npos);
  settings = quick();
  settings.checkpoint = folder_.file("no-such-folder/state");
  EXPECT_NE(error_of(settings).find("no-such-folder"), std::string::npos);
  EXPECT_THROW(render(folder_.file("missing.pbrt")), std::runtime_error);
}

TEST_F(Api, RendersSideBySide) {
  // Two concurrent renders in one process, as in programs that embed the library.
  const RenderedImage expected = render(scene_, quick());
  RenderedImage inside;
  Settings settings = quick();
  settings.backend = "openmp";
  settings.threads = 2;
  bool rendered = false;
  const RenderedImage outside = render(scene_, settings, [&](const Progress&) {
    if (!rendered) inside = render(scene_, settings);
    rendered = true;
    return true;
  });
  EXPECT_EQ(expected.planes, outside.planes);
  EXPECT_EQ(expected.planes, inside.planes);
}

TEST_F(Api, KnowsItsVersion) { EXPECT_STRNE(version(), ""); }

}  // namespace

}  // namespace alhazen::impl::test
