// `alhazen render --denoise`: how denoisers are chosen, what is written, and what goes wrong.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "alhazen/alhazen.h"
#include "cli/fixture.h"
#include "support/environment_variable.h"

namespace alhazen::impl::test {

namespace {

class Denoise : public Command {
 protected:
  std::vector<float> plane(const std::string& file, const std::string& channel) const {
    const Image whole = image(file);
    const int index = whole.channel(channel);
    return index < 0 ? std::vector<float>() : whole.planes[static_cast<size_t>(index)];
  }
};

TEST_F(Denoise, WithoutANameTheBestIsTaken) {
  // The word that follows is the scene, not a name.
  const CommandResult result = run({"render", "--denoise", "scene.pbrt", "--spp", "8", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("; denoised with "), std::string::npos) << result.err;
  EXPECT_EQ(render({"--spp", "8", "-o", "b.exr", "--denoise"}).exit_code, 0);
  EXPECT_EQ(plane("a.exr", "R"), plane("b.exr", "R"));
}

TEST_F(Denoise, BuiltinChangesColoursAlone) {
  ASSERT_EQ(render({"-q", "--spp", "8", "-o", "noisy.exr", "--exr-type", "float"}).exit_code, 0);
  ASSERT_EQ(render({"-q", "--spp", "8", "-o", "clean.exr", "--exr-type", "float", "--denoise", "builtin", "--aov",
                    "noisy,depth"})
                .exit_code,
            0);
  EXPECT_EQ(image("clean.exr").channels.size(), 7u) << "R, G, B, depth and the noisy image";
  EXPECT_NE(plane("clean.exr", "R"), plane("noisy.exr", "R"));
  for (const std::string channel : {"R", "G", "B"})
    EXPECT_EQ(plane("clean.exr", "noisy." + channel), plane("noisy.exr", channel));
}

TEST_F(Denoise, SameBitsForAnyThreads) {
  ASSERT_EQ(render({"-q", "--spp", "8", "--denoise", "builtin", "--threads", "1", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(render({"-q", "--spp", "8", "--denoise", "builtin", "--threads", "3", "-o", "b.exr"}).exit_code, 0);
  EXPECT_EQ(plane("a.exr", "G"), plane("b.exr", "G"));
}

TEST_F(Denoise, NoneAndTheLayerOfTheNoisyImage) {
  ASSERT_EQ(render({"-q", "--spp", "4", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(render({"-q", "--spp", "4", "--denoise", "none", "-o", "b.exr"}).exit_code, 0);
  EXPECT_EQ(plane("a.exr", "B"), plane("b.exr", "B"));
  const CommandResult result = render({"--spp", "4", "--aov", "noisy", "-o", "never.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("give --denoise"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("never.exr"));
}

TEST_F(Denoise, CropsPixelsAndFewSamples) {
  for (const std::vector<std::string>& part :
       {std::vector<std::string>{"--pixelbounds", "3,4,5,6"}, {"--crop", "0,0.5,0.25,1"}, {"--size", "1x40"}})
    for (const char* samples : {"1", "3", "4", "6"}) {
      std::vector<std::string> arguments{"-q", "--spp", samples, "--denoise", "builtin", "-o", "part.exr"};
      arguments.insert(arguments.end(), part.begin(), part.end());
      const CommandResult result = render(arguments);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      for (const float value : plane("part.exr", "R")) ASSERT_TRUE(std::isfinite(value));
    }
}

TEST_F(Denoise, ACheckpointRemembersHalves) {
  ASSERT_EQ(render({"-q", "--spp", "16", "--denoise", "builtin", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(render({"-q", "--spp", "8", "--denoise", "builtin", "--checkpoint", "c", "-o", "half.exr"}).exit_code, 0);
  ASSERT_EQ(
      render({"-q", "--spp", "16", "--denoise", "builtin", "--checkpoint", "c", "--resume", "-o", "b.exr"}).exit_code,
      0);
  EXPECT_EQ(plane("a.exr", "R"), plane("b.exr", "R"));
  const CommandResult without = render({"-q", "--spp", "16", "--checkpoint", "c", "--resume", "-o", "never.exr"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("it was written with denoising on, aov-surface diffuse, and this render has none of that"),
            std::string::npos)
      << without.err;
}

TEST_F(Denoise, NeedsMemoryBesideTheFilm) {
  // The film takes 96 bytes a pixel, and denoising 140. The machine has 160.
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double side = std::sqrt(memory / 160);
  if (side > 31000) GTEST_SKIP() << "images of this size are refused anyway";
  const std::string size = std::to_string(static_cast<int>(side)) + "x" + std::to_string(static_cast<int>(side));
  const CommandResult result = render({"--spp", "8", "--denoise", "builtin", "--size", size, "-o", "never.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("with denoising, takes "), std::string::npos) << result.err;
  EXPECT_FALSE(exists("never.exr"));
}

TEST_F(Denoise, OidnIsTheMock) {
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", ALHAZEN_MOCK_OIDN_2);
  const CommandResult result = render({"--spp", "8", "--denoise", "oidn", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("; denoised with oidn in "), std::string::npos) << result.err;
}

TEST_F(Denoise, AFailureKeepsTheNoisyImage) {
  ASSERT_EQ(render({"-q", "--spp", "8", "-o", "noisy.exr"}).exit_code, 0);
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", ALHAZEN_MOCK_OIDN_2), fails("MOCK_OIDN_FAILS", "1");
  const CommandResult result = render({"-q", "--spp", "8", "--denoise", "oidn", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(
      result.err.find("the image was not denoised: Open Image Denoise failed while filtering the albedo: the mock"),
      std::string::npos)
      << result.err;
  EXPECT_EQ(plane("a.exr", "R"), plane("noisy.exr", "R"));
}

TEST_F(Denoise, AutoGoesOnToTheNext) {
  ASSERT_EQ(render({"-q", "--spp", "8", "--denoise", "builtin", "-o", "builtin.exr"}).exit_code, 0);
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", ALHAZEN_MOCK_OIDN_2), fails("MOCK_OIDN_FAILS", "1");
  const CommandResult result = render({"--spp", "8", "-o", "a.exr", "--denoise"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  if (result.err.find("denoised with optix") != std::string::npos) return;
  EXPECT_NE(result.err.find("the denoiser 'oidn' failed, so 'builtin' is tried: Open Image Denoise failed while "),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("; denoised with builtin in "), std::string::npos) << result.err;
  EXPECT_EQ(plane("a.exr", "R"), plane("builtin.exr", "R"));
}

TEST_F(Denoise, AMissingDependencyIsNamed) {
  const EnvironmentVariable path("LD_LIBRARY_PATH", ALHAZEN_LACKING_OIDN);
  const CommandResult result = render({"-q", "--denoise", "oidn", "-o", "never.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("libOpenImageDenoise.so.2 cannot be loaded: libalhazen_absent.so"), std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("not on this machine"), std::string::npos) << result.err;
}

TEST_F(Denoise, AWrongLibraryIsNamed) {
  folder_.write_text("libOpenImageDenoise.so.2", "no library");
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", folder_.path());
  const CommandResult named = render({"-q", "--denoise", "oidn", "-o", "never.exr"});
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_NE(named.err.find("libOpenImageDenoise.so.2 cannot be loaded: "), std::string::npos) << named.err;
  EXPECT_FALSE(exists("never.exr"));
  const CommandResult best = render({"--spp", "8", "-o", "a.exr", "--denoise"});
  EXPECT_EQ(best.exit_code, 0);
  if (best.err.find("denoised with optix") != std::string::npos) return;
  EXPECT_NE(best.err.find("the denoiser 'oidn' is not used: "), std::string::npos) << best.err;
  EXPECT_NE(best.err.find("; denoised with builtin in "), std::string::npos) << best.err;
}

TEST_F(Denoise, DevicesListsThem) {
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", "/nowhere");
  const std::string table = run({"devices"}).out;
  for (const char* line :
       {"denoiser optix ", "denoiser oidn           not available: /nowhere, which ALHAZEN_OIDN_PATH",
        "denoiser builtin "})
    EXPECT_NE(table.find(line), std::string::npos) << table;
}

TEST_F(Denoise, TheLibraryHasItToo) {
  Settings settings;
  settings.samples_per_pixel = 8;
  settings.denoiser = "builtin";
  settings.aovs = {"noisy"};
  const RenderedImage result = alhazen::render(folder_.file("scene.pbrt"), settings);
  ASSERT_NE(result.plane("noisy.R"), nullptr);
  EXPECT_NE(*result.plane("noisy.R"), *result.plane("R"));
}

}  // namespace

}  // namespace alhazen::impl::test
