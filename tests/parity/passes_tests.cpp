// The image depends neither on how its samples are divided into passes nor on which part of it is rendered.

#include "compile/compile_scene.h"
#include "parity/scenes.h"
#include "render/backend.h"

namespace alhazen::impl::test {

namespace {

Settings settings_of(const std::string& precision, int64_t samples) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = samples;
  settings.aovs = all_aovs;
  return settings;
}

class Passes : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Scene& scene() const { return parity_scene(std::get<0>(GetParam())); }
  const std::string& precision() const { return std::get<1>(GetParam()); }
};

TEST_P(Passes, AnyNumberOfSamplesIsTheSameByAllStrategies) {
  for (const int64_t samples : {1, 3, 4, 17, 64, 100}) {
    SCOPED_TRACE(samples);
    Settings settings = settings_of(precision(), samples);
    settings.width = 7;
    settings.height = 5;
    const Outcome serial = render_bits(scene(), settings);
    EXPECT_EQ(serial.statistics.samples_per_pixel, samples);
    EXPECT_EQ(serial.statistics.camera_samples, static_cast<uint64_t>(35 * samples));
    settings.backend = "openmp";
    settings.threads = 2;
    for (const char* strategy : {"tiles", "rows", "collapse", "rows+reduction", "reduction"}) {
      settings.strategy = strategy;
      EXPECT_TRUE(same_bits(serial, render_bits(scene(), settings))) << strategy;
    }
  }
}

/// Renders with passes of the given sizes.
template <class Real>
Outcome render_in_passes(Scene scene, const Settings& asked, const std::vector<uint32_t>& sizes) {
  Diagnostics diagnostics;
  const RenderSettings settings = resolve_settings(asked, scene);
  const CompiledScene<Real> flat = compile_scene<Real>(
      std::move(scene), naming({settings.width, settings.height, 1, {BvhLayout::bvh8}}), diagnostics);
  Rendering rendering;
  auto film =
      std::make_unique<Film<Real>>(settings.window, settings.aovs, FilmExtras{flat.view.filter.has_negative != 0});
  film->set_scene(LayerScene(flat));
  RenderControl control(settings.threads);
  const std::unique_ptr<Backend> backend = make_backend(settings.backend);
  backend->start(settings);
  uint32_t first = 0;
  for (const uint32_t size : sizes) {
    backend->render_pass(RenderPass<Real>{flat, select_sample_kernel<Real>(settings.integrator, settings.sampler),
                                          settings, *film, control, first, size, settings.integrator});
    first += size;
  }
  rendering.film = std::move(film);
  return outcome_of(rendering);
}

TEST_P(Passes, OfAnySizesAddUpToTheSameBits) {
  const Settings settings = settings_of(precision(), 102);
  const Outcome expected = render_bits(scene(), settings);
  for (const std::vector<uint32_t>& sizes :
       {std::vector<uint32_t>{64, 38}, std::vector<uint32_t>{4, 4, 8, 16, 32, 36, 2},
        std::vector<uint32_t>{12, 60, 28, 2}}) {
    const Outcome outcome = precision() == "float" ? render_in_passes<float>(scene(), settings, sizes)
                                                   : render_in_passes<double>(scene(), settings, sizes);
    EXPECT_TRUE(same_bits(expected, outcome)) << sizes.size() << " passes";
  }
}

TEST_P(Passes, ATimeLimitThatIsNotReachedChangesNothing) {
  Settings settings = settings_of(precision(), 50);
  const Outcome expected = render_bits(scene(), settings);
  settings.time_limit = 1e6;
  const Outcome limited = render_bits(scene(), settings);
  EXPECT_TRUE(limited.statistics.complete);
  EXPECT_TRUE(same_bits(expected, limited));
}

/// Returns the part x0 <= x < x1, y0 <= y < y1 of the rows.
std::vector<float> part_of(const Outcome& whole, int x0, int x1, int y0, int y1) {
  std::vector<float> part;
  const size_t channels = whole.channels.size(), width = static_cast<size_t>(whole.width);
  for (int y = y0; y < y1; ++y)
    for (size_t c = 0; c < channels; ++c) {
      const auto row = whole.rows.begin() + static_cast<ptrdiff_t>((static_cast<size_t>(y) * channels + c) * width);
      part.insert(part.end(), row + x0, row + x1);
    }
  return part;
}

::testing::AssertionResult same_floats(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << a.size() << " values and " << b.size();
  if (std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "values differ";
}

TEST_P(Passes, APartIsTheSamePartOfTheWhole) {
  Settings settings = settings_of(precision(), 6);
  settings.width = 20;
  settings.height = 17;
  const Outcome whole = render_bits(scene(), settings);
  for (const char* strategy : {"tiles", "rows", "collapse", "rows+reduction", "reduction"}) {
    SCOPED_TRACE(strategy);
    settings.backend = "openmp";
    settings.strategy = strategy;
    settings.threads = 2;
    settings.pixel_bounds = {{3, 19, 2, 9}};
    Outcome part = render_bits(scene(), settings);
    EXPECT_EQ(part.width, 16);
    EXPECT_EQ(part.height, 7);
    EXPECT_TRUE(same_floats(part.rows, part_of(whole, 3, 19, 2, 9)));
    settings.pixel_bounds.reset();
    settings.crop_window = {{0.25, 0.5, 0.5, 1}};
    part = render_bits(scene(), settings);
    EXPECT_TRUE(same_floats(part.rows, part_of(whole, 5, 10, 9, 17)));
    settings.crop_window.reset();
  }
}

TEST_P(Passes, LayersDoNotChangeTheImage) {
  Settings settings = settings_of(precision(), 6);
  const Outcome with = render_bits(scene(), settings);
  settings.aovs.clear();
  const Outcome without = render_bits(scene(), settings);
  const size_t width = static_cast<size_t>(with.width);
  for (size_t y = 0; y < static_cast<size_t>(with.height); ++y)
    EXPECT_EQ(0, std::memcmp(&with.rows[y * width * with.channels.size()], &without.rows[y * width * 3],
                             3 * width * sizeof(float)));
}

INSTANTIATE_TEST_SUITE_P(Parity, Passes,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double")));

}  // namespace

}  // namespace alhazen::impl::test
