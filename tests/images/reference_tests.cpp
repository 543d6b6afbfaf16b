// Images that other renderers made of the same scenes (../shared beside the source folder; see the MANIFEST.md there).

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "images/metrics/compare.h"
#include "io/read_scene.h"
#include "render/renderer.h"
#include "support/effort.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

const std::string shared = ALHAZEN_SOURCE_DIR "/../shared";

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "the reference is not here: " << (path)

/// Renders a file after applying `change` to its description.
template <class Change>
Image render_image(const std::string& path, const Settings& settings, const Change& change) {
  Diagnostics diagnostics;
  Scene scene = read_scene(path, diagnostics);
  change(scene);
  const RenderSettings resolved = resolve_settings(settings, scene);
  const Rendering rendering = render_scene(std::move(scene), resolved, 0, {}, diagnostics);
  const ImageSource source = rendering.source();
  const size_t width = static_cast<size_t>(source.width), height = static_cast<size_t>(source.height);
  Image image{source.width, source.height, source.channels,
              std::vector(source.channels.size(), std::vector<float>(width * height))};
  std::vector<float> row(source.channels.size() * width);
  for (size_t y = 0; y < height; ++y) {
    source.fill_row(static_cast<int>(y), row);
    for (size_t c = 0; c < image.planes.size(); ++c)
      std::copy_n(row.data() + c * width, width, image.planes[c].data() + y * width);
  }
  return image;
}

Image render_image(const std::string& path, const Settings& settings) {
  return render_image(path, settings, [](Scene&) {});
}

/// R, G, B of another image, downsampled by `factor`.
Image box_downsampled(const Image& image, int factor) {
  Image small{image.width / factor, image.height / factor, {"R", "G", "B"}, {}};
  for (const std::string& channel : small.channels) {
    const std::vector<float>& plane = image.planes.at(static_cast<size_t>(image.channel(channel)));
    std::vector<float> sums(static_cast<size_t>(small.width * small.height));
    for (int y = 0; y < small.height * factor; ++y)
      for (int x = 0; x < small.width * factor; ++x)
        sums[static_cast<size_t>(y / factor * small.width + x / factor)] +=
            plane[static_cast<size_t>(y * image.width + x)] / static_cast<float>(factor * factor);
    small.planes.push_back(std::move(sums));
  }
  return small;
}

double value_of(const Image& image, size_t channel, size_t pixel) {
  return static_cast<double>(image.planes[channel][pixel]);
}

/// Mean luminance (Rec. 709).
double mean_luminance(const Image& image) {
  const size_t pixels = image.planes[0].size();
  double sum = 0;
  for (size_t i = 0; i < pixels; ++i)
    sum += 0.2126 * value_of(image, 0, i) + 0.7152 * value_of(image, 1, i) + 0.0722 * value_of(image, 2, i);
  return sum / static_cast<double>(pixels);
}

/// A reference and the variance of each of its pixels, estimated from two independent halves.
struct Reference {
  Image mean, variance;

  Reference(const Image& a, const Image& b) : mean(a), variance(a) {
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = 0; i < a.planes[c].size(); ++i) {
        const float difference = a.planes[c][i] - b.planes[c][i];
        mean.planes[c][i] = (a.planes[c][i] + b.planes[c][i]) / 2;
        variance.planes[c][i] = difference * difference / 4;
      }
  }

  /// Relative squared error of `image`, minus the contribution of the reference's noise.
  double relmse(const Image& image) const {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = 0; i < mean.planes[c].size(); ++i) {
        const double expected = value_of(mean, c, i), error = value_of(image, c, i) - expected;
        sum += (error * error - value_of(variance, c, i)) / (expected * expected + 0.01);
      }
    return sum / static_cast<double>(3 * mean.planes[0].size());
  }
};

TEST(References, WeekendByPbrt) {
  const std::string folder = shared + "/references/weekend";
  SKIP_WITHOUT(folder + "/half1.exr");
  const Reference reference(read_image(folder + "/half1.exr"), read_image(folder + "/half2.exr"));
  const double mean = mean_luminance(reference.mean);
  std::vector<double> errors;
  const int first = test::is_sanitized ? 1 : 4;
  for (const int samples : {first, 4 * first, 16 * first}) {
    Settings settings;
    settings.samples_per_pixel = samples;
    const Image image = render_image(folder + "/weekend.pbrt", settings);
    ASSERT_EQ(image.width, reference.mean.width);
    ASSERT_EQ(image.height, reference.mean.height);
    errors.push_back(reference.relmse(image));
    EXPECT_NEAR(mean_luminance(image) / mean, 1, 0.01) << samples << " samples";
    RecordProperty("relmse_" + std::to_string(samples), std::to_string(errors.back()));
  }
  // The scene's sampler is `independent`: four times the samples, a quarter of the error. Other differences (the
  // reference is spectral) must be well below the noise with most samples.
  EXPECT_NEAR(errors[0] / errors[1], 4, 1);
  EXPECT_NEAR(errors[1] / errors[2], 4, 1);
}

TEST(References, CornellBoxByTungsten) {
  const std::string folder = shared + "/scenes/pbrt/cornell-box";
  SKIP_WITHOUT(folder + "/TungstenRender.exr");
  constexpr int size = 256, regions = 8, region = size / regions;
  const Image reference = box_downsampled(read_image(folder + "/TungstenRender.exr"), 4);
  Settings settings;
  settings.width = settings.height = size;
  settings.samples_per_pixel = test::is_sanitized ? 16 : 64;
  const double noise = test::is_sanitized ? 2 : 1;
  const Image image = render_image(folder + "/scene-v4.pbrt", settings, [](Scene& scene) {
    // As the reference was averaged: over the area of the pixel.
    scene.filter = {};
    scene.filter.type = FilterType::box;
    scene.filter.x_radius = scene.filter.y_radius = 0.5;
  });
  EXPECT_NEAR(mean_luminance(image) / mean_luminance(reference), 1, 0.005);
  double squares = 0;
  for (int row = 0; row < regions; ++row)
    for (int column = 0; column < regions; ++column)
      for (size_t c = 0; c < 3; ++c) {
        double ours = 0, theirs = 0;
        for (int y = row * region; y < (row + 1) * region; ++y)
          for (int x = column * region; x < (column + 1) * region; ++x) {
            ours += value_of(image, c, static_cast<size_t>(y * size + x));
            theirs += value_of(reference, c, static_cast<size_t>(y * size + x));
          }
        EXPECT_NEAR(ours / theirs, 1, 0.04 * noise) << "region " << column << ", " << row << " channel " << c;
        squares += (ours / theirs - 1) * (ours / theirs - 1);
      }
  // For all regions together; the noise of one is below a hundredth.
  EXPECT_LT(std::sqrt(squares / (3 * regions * regions)), 0.01 * noise);
}

/// Under an octahedral map. The ball's coat is missing, but the light on the floor shows the map's orientation: if it
/// were mirrored or rotated by 90 degrees, regions would differ by 0.045.
TEST(References, MaterialTestballByTungsten) {
  const std::string folder = shared + "/scenes/pbrt/material-testball";
  SKIP_WITHOUT(folder + "/TungstenRender.exr");
  constexpr int width = 320, height = 180, columns = 8, rows = 6;
  const Image reference = box_downsampled(read_image(folder + "/TungstenRender.exr"), 4);
  Settings settings;
  settings.width = width;
  settings.height = height;
  settings.samples_per_pixel = test::is_sanitized ? 8 : 32;
  settings.max_depth = 6;
  const Image image = render_image(folder + "/material-testball.pbrt", settings);
  double sum = 0, squares = 0, regions = 0;
  for (int row = 0; row < rows; ++row)
    for (const int column : {0, 1, columns - 2, columns - 1}) {
      double ours = 0, theirs = 0;
      for (int y = row * height / rows; y < (row + 1) * height / rows; ++y)
        for (int x = column * width / columns; x < (column + 1) * width / columns; ++x) {
          ours += value_of(image, 1, static_cast<size_t>(y * width + x));
          theirs += value_of(reference, 1, static_cast<size_t>(y * width + x));
        }
      const double difference = std::log(ours / theirs);
      sum += difference;
      squares += difference * difference;
      ++regions;
    }
  EXPECT_NEAR(sum / regions, 0, 0.01);
  EXPECT_LT(std::sqrt(squares / regions), 0.015);
}

TEST(References, EveryPbrtSceneHasAnImage) {
  const std::string folder = shared + "/scenes/pbrt";
  SKIP_WITHOUT(folder);
  Settings settings;
  settings.width = 40;
  settings.height = 24;
  settings.samples_per_pixel = 4;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().string();
    // Files in folders named geometry are parts of scenes.
    if (entry.path().extension() != ".pbrt" || path.find("/geometry/") != std::string::npos) continue;
    SCOPED_TRACE(path);
    try {
      const Image image = render_image(path, settings);
      EXPECT_GT(mean_luminance(image), 0.001);
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace

}  // namespace alhazen::impl::test
