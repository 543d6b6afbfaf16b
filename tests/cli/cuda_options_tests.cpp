// The settings of the CUDA backend on the command line, with the CPU-emulated kernels, and one sentence for each
// invalid setting.

#include "cli/fixture.h"

namespace alhazen::impl::test {
namespace {

using CudaOptions = Command;

TEST_F(CudaOptions, TheHostStandsInForAGpu) {
  ASSERT_EQ(render({"-q", "--spp", "5", "--backend", "serial", "-o", "serial.exr"}).exit_code, 0);
  const std::vector<std::vector<std::string>> option_sets{
      {"pixel", "--block", "8x8"}, {"chunk", "--chunk", "3x2", "--block", "16x32"}, {"persistent"}, {"wavefront"}};
  for (const std::vector<std::string>& options : option_sets) {
    std::vector<std::string> arguments{"-q",       "--spp", "5",  "--backend", "cuda",
                                       "--device", "host",  "-o", "host.exr",  "--strategy"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult result = render(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(image("serial.exr").planes, image("host.exr").planes) << options[0];
  }
}

TEST_F(CudaOptions, StatisticsNameTheDevice) {
  const CommandResult result =
      render({"-q", "--spp", "4", "--backend", "cuda", "--device", "host", "--stats=json", "-o", "a.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json statistics = only_json(result.out);
  EXPECT_EQ(statistics["backend"], "cuda");
  EXPECT_EQ(statistics["device"], "host");
  EXPECT_GT(statistics["rays"], 0);
}

TEST_F(CudaOptions, WhatCannotBeIsOneSentence) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--device", "99"}, "there is no device '99'"},
      {{"--device", "one"}, "there is no device 'one'"},
      {{"--device", "host", "--strategy", "tiles"}, "has no strategy 'tiles'"},
      {{"--device", "host", "--strategy", "pixel", "--block", "64x64"}, "4096 threads"},
      {{"--device", "host", "--strategy", "pixel", "--block", "0x8"}, "'0x8'"},
      {{"--device", "host", "--strategy", "pixel", "--block", "16"}, "'16'"},
      {{"--device", "host", "--strategy", "persistent", "--block", "16x16"}, "pixel and chunk"},
      {{"--device", "host", "--strategy", "pixel", "--chunk", "2x2"}, "strategy chunk"},
      {{"--device", "host", "--strategy", "chunk", "--chunk", "2by2"}, "'2by2'"},
      {{"--device", "host", "--integrator", "recursive"}, "no integrator 'recursive'"}};
  for (const auto& [arguments, message] : cases) {
    std::vector<std::string> all{"--backend", "cuda", "-o", "never.png"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = render(all);
    EXPECT_EQ(result.exit_code, 2) << message;
    // Device numbers are only checked if there is a GPU.
    const bool no_gpu = result.err.find("is not available") != std::string::npos && arguments[1] != "host";
    EXPECT_TRUE(no_gpu || result.err.find(message) != std::string::npos) << message << "\n" << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    EXPECT_FALSE(exists("never.png"));
  }
}

TEST_F(CudaOptions, DenoisersAreRefusedBeforeTheRender) {
  const CommandResult unknown = render({"--denoise", "blur", "-o", "never.png"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("unknown denoiser 'blur': it may be none, auto, optix, oidn, builtin"), std::string::npos)
      << unknown.err;
  EXPECT_FALSE(exists("never.png"));
  const CommandResult optix = render({"-q", "--spp", "1", "--denoise", "optix", "-o", "denoised.exr"});
  if (optix.exit_code == 0) {
    EXPECT_EQ(image("denoised.exr").channels.size(), 3u) << "what it needs is not written";
    return;
  }
  EXPECT_EQ(optix.exit_code, 2);
  EXPECT_NE(optix.err.find("the denoiser 'optix' is not available: "), std::string::npos) << optix.err;
  EXPECT_EQ(lines_of(optix.err).size(), 1u) << optix.err;
  EXPECT_FALSE(exists("denoised.exr"));
}

TEST_F(CudaOptions, OptixHasNoHost) {
  const CommandResult result = render({"--backend", "optix", "--device", "host", "-o", "never.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  EXPECT_FALSE(exists("never.png"));
}

TEST_F(CudaOptions, OtherBackendsHaveNoDevices) {
  const CommandResult result = render({"--backend", "serial", "--device", "0", "-o", "never.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("no devices"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("never.png"));
}

TEST_F(CudaOptions, WithoutAGpuItSaysWhy) {
  const nlohmann::json list = only_json(run({"devices", "--json"}).out)["backends"];
  for (const nlohmann::json& backend : list) {
    if (backend["name"] != "cuda") continue;
    if (backend["available"]) GTEST_SKIP() << "there is a GPU here";
    const CommandResult result = render({"--backend", "cuda", "-o", "never.png"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(backend["details"].get<std::string>()), std::string::npos) << result.err;
    EXPECT_FALSE(exists("never.png"));
    return;
  }
  FAIL() << "the backend cuda is not listed";
}

}  // namespace
}  // namespace alhazen::impl::test
