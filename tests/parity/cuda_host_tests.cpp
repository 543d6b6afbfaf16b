// The CPU-emulated CUDA kernels: all strategies give the bits of the serial backend, for any size of image and block,
// any number of chunks and any depth.

#include "backends/cuda/device_render.h"
#include "backends/cuda/host_executor.h"
#include "compile/compile_scene.h"
#include "parity/scenes.h"

namespace alhazen::impl::test {
namespace {

const std::vector<std::string> strategies{"pixel", "chunk", "persistent", "wavefront"};

Settings host_settings(const Settings& serial, const std::string& strategy) {
  Settings settings = serial;
  settings.backend = "cuda";
  settings.device = "host";
  settings.strategy = strategy;
  return settings;
}

Settings serial_settings(const std::string& precision) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = 18;  // ends within a block
  settings.aovs = all_aovs;
  return settings;
}

void expect_serial_bits(const Scene& scene, const Settings& serial) {
  const Outcome expected = render_bits(scene, serial);
  for (const std::string& strategy : strategies) {
    SCOPED_TRACE(strategy);
    const Outcome outcome = render_bits(scene, host_settings(serial, strategy));
    EXPECT_TRUE(same_bits(expected, outcome));
    EXPECT_EQ(outcome.statistics.camera_samples, expected.statistics.camera_samples);
    EXPECT_EQ(outcome.statistics.rays, expected.statistics.rays);
    EXPECT_EQ(outcome.statistics.shadow_rays, expected.statistics.shadow_rays);
    EXPECT_EQ(outcome.statistics.nonfinite_samples, expected.statistics.nonfinite_samples);
  }
}

/// Scene, precision, integrator, sampler.
using Kernel = std::tuple<std::string, std::string, std::string, std::string>;
class CudaOnHost : public ::testing::TestWithParam<Kernel> {};

TEST_P(CudaOnHost, GivesTheSerialBits) {
  const auto& [name, precision, integrator, sampler] = GetParam();
  Settings serial = serial_settings(precision);
  serial.integrator = integrator;
  serial.sampler = sampler;
  expect_serial_bits(parity_scene(name), serial);
}

INSTANTIATE_TEST_SUITE_P(Parity, CudaOnHost,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double"),
                                            ::testing::Values("path", "iterative"),
                                            ::testing::Values("sobol", "zsobol", "independent")));

class CudaOnHostScene : public ::testing::TestWithParam<std::string> {};

TEST_P(CudaOnHostScene, GivesTheSerialBits) {
  for (const std::string precision : {"float", "double"})
    for (const std::string integrator : {"path", "iterative"}) {
      Settings serial = serial_settings(precision);
      serial.integrator = integrator;
      expect_serial_bits(parity_scene(GetParam()), serial);
    }
}

INSTANTIATE_TEST_SUITE_P(Parity, CudaOnHostScene,
                         ::testing::Values("environments", "lights", "materials", "instances", "meshes", "cylinders",
                                           "disks"));

TEST(CudaOnHostSizes, OnePixel) {
  Settings serial = serial_settings("float");
  serial.width = serial.height = 1;
  for (const int64_t samples : {1, 3, 4, 5, 1500}) {
    serial.samples_per_pixel = samples;
    expect_serial_bits(parity_scene("spheres"), serial);
  }
}

TEST(CudaOnHostSizes, ThatNothingDivides) {
  Settings serial = serial_settings("float");
  serial.samples_per_pixel = 6;
  for (const auto& [width, height] : {std::pair<int64_t, int64_t>{1, 23}, {31, 1}, {33, 9}, {8, 4}, {67, 41}}) {
    serial.width = width;
    serial.height = height;
    expect_serial_bits(parity_scene("cornell"), serial);
  }
}

TEST(CudaOnHostSizes, APartOfTheImage) {
  Settings serial = serial_settings("double");
  serial.pixel_bounds = {{3, 18, 5, 14}};
  expect_serial_bits(parity_scene("spheres"), serial);
}

TEST(CudaOnHostDepths, OneAndFifty) {
  for (const std::string integrator : {"path", "iterative"})
    for (const int64_t depth : {0, 50}) {
      Settings serial = serial_settings("float");
      serial.integrator = integrator;
      serial.max_depth = depth;
      expect_serial_bits(parity_scene("spheres"), serial);
    }
}

TEST(CudaOnHostChunks, OfEverySize) {
  const Settings serial = serial_settings("float");
  const Outcome expected = render_bits(parity_scene("cornell"), serial);
  for (const char* chunk : {"1x1", "2x3", "3x3", "4x4", "5x5", "7x1", "1x6", "20x17", "33x40", "4096x4096"}) {
    Settings settings = host_settings(serial, "chunk");
    settings.chunk = chunk;
    EXPECT_TRUE(same_bits(expected, render_bits(parity_scene("cornell"), settings))) << chunk;
  }
}

/// Without geometry every path ends immediately, and the queues of hits stay empty.
TEST(CudaOnHostQueues, ThatStayEmpty) {
  const Scene empty = scene_of(
      "Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 7\n"
      "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 2 3]\n");
  Settings serial = serial_settings("float");
  expect_serial_bits(empty, serial);
  serial.integrator = "iterative";
  expect_serial_bits(empty, serial);
}

/// The tree that GPUs traverse in float. If two surfaces are hit at the same distance, it may return the other one.
TEST(CudaOnHostWideBvh, GivesAllButTheSameBits) {
  for (const std::string name : {"cornell", "spheres"})
    for (const std::string& strategy : strategies) {
      const Settings serial = serial_settings("float");
      Scene scene = parity_scene(name);
      const RenderSettings settings = resolve_settings(host_settings(serial, strategy), scene);
      Diagnostics diagnostics;
      const CompiledScene<float> flat = compile_scene<float>(
          std::move(scene), naming({settings.width, settings.height, 1, {BvhLayout::bvh2, BvhLayout::cwbvh}}),
          diagnostics);
      ASSERT_GT(flat.view.cwbvh_nodes_count, 0u);
      auto film =
          std::make_unique<Film<float>>(settings.window, settings.aovs, FilmExtras{flat.view.filter.has_negative != 0});
      film->set_scene(LayerScene(flat));
      RenderControl control(1);
      cuda::HostExecutor executor;
      cuda::DeviceRender<cuda::HostExecutor, cuda::CwbvhTracing, float> render(executor, {});
      render.render_pass({flat, SampleKernel<float>(nullptr), settings, *film, control, 0, 18, settings.integrator},
                         control.thread(0));
      Rendering rendering;
      rendering.film = std::move(film);
      const Outcome outcome = outcome_of(rendering), expected = render_bits(parity_scene(name), serial);
      ASSERT_EQ(outcome.rows.size(), expected.rows.size());
      size_t same = 0;
      for (size_t i = 0; i < outcome.rows.size(); ++i) same += outcome.rows[i] == expected.rows[i];
      EXPECT_GE(static_cast<double>(same), 0.998 * static_cast<double>(outcome.rows.size())) << name << " " << strategy;
    }
}

/// Several devices render parts of one image, one after the other.
TEST(CudaOnHostShares, AddUpToTheImage) {
  for (const uint32_t devices : {2u, 3u}) {
    Settings serial = serial_settings("double");
    serial.width = 21;
    serial.height = 43;
    const Outcome expected = render_bits(parity_scene("spheres"), serial);
    Scene scene = parity_scene("spheres");
    const RenderSettings settings = resolve_settings(host_settings(serial, "persistent"), scene);
    Diagnostics diagnostics;
    const CompiledScene<double> flat = compile_scene<double>(
        std::move(scene), naming({settings.width, settings.height, 1, {BvhLayout::bvh2}}), diagnostics);
    auto film =
        std::make_unique<Film<double>>(settings.window, settings.aovs, FilmExtras{flat.view.filter.has_negative != 0});
    film->set_scene(LayerScene(flat));
    RenderControl control(1);
    for (uint32_t device = 0; device < devices; ++device) {
      cuda::HostExecutor executor;
      cuda::DeviceRender<cuda::HostExecutor, cuda::Bvh2Tracing, double> render(executor, {device, devices});
      render.render_pass({flat, SampleKernel<double>(nullptr), settings, *film, control, 0, 16, settings.integrator},
                         control.thread(0));
      render.render_pass({flat, SampleKernel<double>(nullptr), settings, *film, control, 16, 2, settings.integrator},
                         control.thread(0));
    }
    EXPECT_EQ(control.thread(0).samples, expected.statistics.camera_samples);
    Rendering rendering;
    rendering.film = std::move(film);
    EXPECT_TRUE(same_bits(outcome_of(rendering), expected)) << devices;
  }
}

TEST(CudaOnHostLayers, NoneAreAskedFor) {
  Settings serial = serial_settings("float");
  serial.aovs.clear();
  expect_serial_bits(parity_scene("spheres"), serial);
}

}  // namespace
}  // namespace alhazen::impl::test
