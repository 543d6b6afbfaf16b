// GPUs give the images of the CPU with all four schedules: in double to 1e-9, in float up to noise. The same
// comparisons run for the CPU-emulated kernels, which shows that they can pass; without a GPU only those run.

#include "backends/cuda/device.h"
#include "parity/scenes.h"
#include "render/backend.h"
#include "support/statistics.h"

namespace alhazen::impl::test {
namespace {

using test::Moments;

const std::vector<std::string> schedules{"pixel", "chunk", "persistent", "wavefront"};
constexpr int64_t width = 96, height = 80;

Settings settings_of(const std::string& backend, const std::string& precision, const std::string& integrator) {
  Settings settings;
  settings.backend = backend;
  settings.precision = precision;
  settings.integrator = integrator;
  settings.samples_per_pixel = 64;
  settings.width = width;
  settings.height = height;
  return settings;
}

template <class Real>
using FilmPointer = std::unique_ptr<Film<Real>>;

template <class Real>
FilmPointer<Real> film_of(const std::string& scene_name, const Settings& settings) {
  Scene scene = parity_scene(scene_name);
  const RenderSettings resolved = resolve_settings(settings, scene);
  Diagnostics diagnostics;
  Rendering rendering = render_scene(std::move(scene), resolved, 0, {}, diagnostics);
  EXPECT_EQ(rendering.statistics.nonfinite_samples, 0u);
  EXPECT_EQ(rendering.statistics.camera_samples, static_cast<uint64_t>(width * height * settings.samples_per_pixel));
  return std::move(std::get<FilmPointer<Real>>(rendering.film));
}

/// Returns the fraction of the pixels whose radiance is within `tolerance`, relative to the largest channel.
template <class Real>
double part_alike(const Film<Real>& a, const Film<Real>& b, double tolerance) {
  size_t alike = 0;
  const size_t pixels = static_cast<size_t>(a.window().pixels());
  for (size_t i = 0; i < pixels; ++i) {
    const Vec3d x = convert<double>(a.view().radiance[i]), y = convert<double>(b.view().radiance[i]);
    const double distance = std::max({std::abs(x.x - y.x), std::abs(x.y - y.y), std::abs(x.z - y.z)});
    alike +=
        distance <= tolerance * std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});  // filters may be negative
  }
  return static_cast<double>(alike) / static_cast<double>(pixels);
}

/// Returns whether an image is black. Black images would be equal too.
template <class Real>
bool is_black(const Film<Real>& film) {
  const Vec3<Real>* radiance = film.view().radiance;
  return std::all_of(radiance, radiance + film.window().pixels(),
                     [](const Vec3<Real>& v) { return v.x == 0 && v.y == 0 && v.z == 0; });
}

/// Returns the moments of the pixel luminance in each of 4x4 parts of the image, by rows.
template <class Real>
std::vector<Moments> moments_of(const Film<Real>& film) {
  constexpr size_t parts = 4;
  std::vector<Moments> moments(parts * parts);
  const size_t columns = static_cast<size_t>(film.window().width()), rows = static_cast<size_t>(film.window().height());
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x) {
      const size_t i = y * columns + x;
      moments[y * parts / rows * parts + x * parts / columns].add(luminance(convert<double>(film.view().radiance[i])) /
                                                                  film.view().samples[i]);
    }
  return moments;
}

/// Device, scene, integrator.
using Case = std::tuple<std::string, std::string, std::string>;
class CudaOnDevice : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    std::tie(device_, scene_, integrator_) = GetParam();
    if (device_ != "host" && cuda::list_devices().devices.empty()) GTEST_SKIP() << cuda::list_devices().problem;
  }
  Settings device_settings(const std::string& precision, const std::string& strategy) const {
    Settings settings = settings_of("cuda", precision, integrator_);
    settings.device = device_;
    settings.strategy = strategy;
    return settings;
  }

  /// Compares the image of every schedule with the serial one: at least this fraction of the pixels is within
  /// `tolerance`.
  template <class Real>
  void expect_alike(const std::string& precision, double tolerance, double part) const {
    const auto serial = film_of<Real>(scene_, settings_of("serial", precision, integrator_));
    ASSERT_FALSE(is_black(*serial));
    for (const std::string& strategy : schedules) {
      const auto film = film_of<Real>(scene_, device_settings(precision, strategy));
      EXPECT_GE(part_alike(*serial, *film, tolerance), part) << strategy;
    }
  }

  std::string device_, scene_, integrator_;
};

TEST_P(CudaOnDevice, InDoubleGivesTheSerialImage) { expect_alike<double>("double", 1e-9, 0.999); }

/// Fused operations and the other tree move a ray by an ulp; few paths then diverge, which affects 1 of the 64 samples
/// of a pixel.
TEST_P(CudaOnDevice, InFloatGivesTheSameImageByEverySchedule) { expect_alike<float>("float", 1e-3, 0.9); }

/// Renders in double, with a different seed.
std::vector<Moments> reference_of(const std::string& scene, const std::string& integrator) {
  Settings settings = settings_of("serial", "double", integrator);
  settings.sampler = "independent";
  settings.samples_per_pixel = 256;
  settings.seed = 7;
  return moments_of(*film_of<double>(scene, settings));
}

/// Compares an image in float with the reference by a Z-test of each part. All such tests of this file together have
/// the level 0.01.
void expect_unbiased(const std::vector<Moments>& reference, const std::string& scene, Settings settings) {
  constexpr size_t images = 2 * 2 * (2 * 4 + 1);  // scenes, integrators; devices and schedules, OptiX
  settings.sampler = "independent";
  const std::vector<Moments> moments = moments_of(*film_of<float>(scene, settings));
  for (size_t part = 0; part < moments.size(); ++part)
    EXPECT_GT(test::welch_p_value(moments[part], reference[part], 1e-6), test::sidak(0.01, images * moments.size()))
        << "part " << part << ": " << moments[part].mean() << " and " << reference[part].mean();
}

TEST_P(CudaOnDevice, InFloatIsUnbiased) {
  const std::vector<Moments> reference = reference_of(scene_, integrator_);
  for (const std::string& strategy : schedules) {
    SCOPED_TRACE(strategy);
    expect_unbiased(reference, scene_, device_settings("float", strategy));
  }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  const auto& [device, scene, integrator] = info.param;
  return (device == "host" ? device : "GPU") + "_" + scene + "_" + integrator;
}

INSTANTIATE_TEST_SUITE_P(Parity, CudaOnDevice,
                         ::testing::Combine(::testing::Values("host", "0"), ::testing::Values("cornell", "spheres"),
                                            ::testing::Values("path", "iterative")),
                         name_of);

/// Scene, integrator.
class OptixOnDevice : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(OptixOnDevice, IsUnbiasedAndCloseToTheSerialImage) {
  const auto& [scene, integrator] = GetParam();
  const BackendStatus backend = make_backend("optix")->status();
  if (!backend.available) GTEST_SKIP() << backend.details;
  const Settings settings = settings_of("optix", "float", integrator);
  expect_unbiased(reference_of(scene, integrator), scene, settings);
  const auto serial = film_of<float>(scene, settings_of("serial", "float", integrator));
  EXPECT_GE(part_alike(*serial, *film_of<float>(scene, settings), 1e-2), 0.8);
}

INSTANTIATE_TEST_SUITE_P(Parity, OptixOnDevice,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("path", "iterative")));

}  // namespace
}  // namespace alhazen::impl::test
