// A render that is stopped and resumed has the bits of one that was never stopped.

#include <algorithm>

#include "parity/scenes.h"

namespace alhazen::impl::test {

namespace {

class Resume : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Scene& scene() const { return parity_scene(std::get<0>(GetParam())); }

  Settings settings(int64_t samples, bool resume) const {
    Settings s;
    s.backend = "openmp";
    s.threads = 2;
    s.precision = std::get<1>(GetParam());
    s.samples_per_pixel = samples;
    s.aovs = all_aovs;
    s.checkpoint = folder_.file("state");
    s.resume = resume;
    s.overwrite = !resume;
    return s;
  }

  /// Without a checkpoint.
  Outcome uninterrupted(int64_t samples) const {
    Settings s = settings(samples, false);
    s.checkpoint.clear();
    s.overwrite = false;
    return render_bits(scene(), s);
  }

  TemporaryFolder folder_;
};

TEST_P(Resume, WithMoreSamplesGivesTheBitsOfOneRender) {
  for (const auto& [before, after] : {std::pair{16, 64}, {4, 5}, {17, 64}, {3, 17}, {1, 100}, {30, 31}}) {
    SCOPED_TRACE(std::to_string(before) + " samples, then " + std::to_string(after));
    const Outcome part = render_bits(scene(), settings(before, false));
    EXPECT_TRUE(part.statistics.complete);
    EXPECT_TRUE(same_bits(part, uninterrupted(before)));
    const Outcome whole = render_bits(scene(), settings(after, true));
    EXPECT_TRUE(whole.statistics.complete);
    EXPECT_EQ(whole.statistics.samples_per_pixel, static_cast<uint32_t>(after));
    EXPECT_TRUE(same_bits(whole, uninterrupted(after)));
  }
}

TEST_P(Resume, OfACompleteRenderGivesItAgain) {
  for (const int samples : {16, 18}) {
    const Outcome first = render_bits(scene(), settings(samples, false));
    const Outcome again = render_bits(scene(), settings(samples, true));
    EXPECT_TRUE(again.statistics.complete);
    EXPECT_EQ(again.statistics.samples_per_pixel, static_cast<uint32_t>(samples));
    EXPECT_TRUE(same_bits(first, again));
  }
}

TEST_P(Resume, GoesOnByAnotherStrategyAndThreadCount) {
  render_bits(scene(), settings(20, false));
  Settings other = settings(40, true);
  other.strategy = "reduction";
  other.threads = 3;
  EXPECT_TRUE(same_bits(render_bits(scene(), other), uninterrupted(40)));
}

TEST_P(Resume, AfterBeingStoppedGivesTheBitsOfOneRender) {
  constexpr int64_t samples = 2000;
  Settings stopped = settings(samples, false);
  stopped.checkpoint_seconds = 0;
  const auto stop_when_begun = [](const Progress& progress) { return progress.samples_done == 0; };
  Outcome outcome = render_bits(scene(), stopped, stop_when_begun);
  ASSERT_FALSE(outcome.statistics.complete) << "the machine is too fast for this test: give it more samples";
  // Resumed once more, from the same checkpoint.
  stopped.resume = true;
  stopped.overwrite = false;
  int calls = 0;
  outcome = render_bits(scene(), stopped, [&](const Progress&) { return ++calls < 2; });
  const Outcome whole = render_bits(scene(), settings(samples, true));
  EXPECT_TRUE(whole.statistics.complete);
  EXPECT_LT(whole.statistics.camera_samples, static_cast<uint64_t>(samples * parity_width * parity_height));
  EXPECT_TRUE(same_bits(whole, uninterrupted(samples)));
}

TEST_P(Resume, RefusesAnotherRender) {
  render_bits(scene(), settings(8, false));
  const auto refused = [&](const Settings& s, Scene scene, const char* words) {
    try {
      render_bits(std::move(scene), s);
      return false;
    } catch (const InputError& error) {
      return std::string(error.what()).find(words) != std::string::npos;
    }
  };
  const auto refused_settings = [&](const auto& change) {
    Settings s = settings(16, true);
    change(s);
    return refused(s, scene(), "of other settings: it was written with ");
  };
  EXPECT_TRUE(refused_settings([](Settings& s) { s.seed = 7; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.max_depth = 2; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.sampler = "independent"; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.sampler = "zsobol"; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.integrator = "iterative"; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.precision = s.precision == "float" ? "double" : "float"; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.width = 21; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.pixel_bounds = {{0, 4, 0, 4}}; }));
  EXPECT_TRUE(refused_settings([](Settings& s) { s.aovs = {"albedo"}; }));
}

TEST_P(Resume, RefusesAnotherScene) {
  render_bits(scene(), settings(8, false));
  const auto refused = [&](const auto& change) {
    Scene other = scene();
    change(other);
    try {
      render_bits(std::move(other), settings(16, true));
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  EXPECT_FALSE(refused([](Scene&) {}));
  EXPECT_TRUE(refused([](Scene& s) { s.camera.fov += 1; }));
  EXPECT_TRUE(refused([](Scene& s) { s.filter.type = FilterType::gaussian; }));
  EXPECT_TRUE(refused([](Scene& s) { s.film.exposure = 2; }));
  EXPECT_TRUE(refused([](Scene& s) { s.textures[s.materials[0].reflectance].value.x += 0.125; }) ||
              refused([](Scene& s) { s.textures[0].value.x += 0.125; }));
  const std::vector<Material>& materials = scene().materials;
  const bool has_glass = std::any_of(materials.begin(), materials.end(),
                                     [](const Material& m) { return m.kind == MaterialKind::dielectric; });
  EXPECT_EQ(refused([](Scene& s) {
              for (Material& material : s.materials) material.ior += 0.125;
            }),
            has_glass);
  EXPECT_TRUE(refused([](Scene& s) {
    for (Material& material : s.materials) material.kind = MaterialKind::conductor;
  }));
  EXPECT_TRUE(refused([](Scene& s) {
    for (Shape& shape : s.groups[0].shapes) shape.world_from_object.end = Transform::translate({0, 1, 0});
    for (Mesh& mesh : s.meshes) mesh.positions[0].x += 1;
  }));
  EXPECT_TRUE(refused([](Scene& s) {
    Light light;
    light.kind = LightKind::point;
    light.radiance = {1, 1, 1};
    light.position = {0, 1, 0};
    s.lights.push_back(light);
  }));
}

TEST_P(Resume, KnowsLightsByTheirPlaces) {
  Scene lit = scene();
  Light light;
  light.kind = LightKind::point;
  light.radiance = {1, 1, 1};
  light.position = {0, 1, 0};
  lit.lights.push_back(light);
  render_bits(lit, settings(8, false));
  lit.lights.back().position.y = 0.5;
  EXPECT_THROW(render_bits(lit, settings(16, true)), InputError);
}

TEST_P(Resume, RefusesADamagedFile) {
  render_bits(scene(), settings(8, false));
  const Bytes whole = read_file(folder_.file("state"));
  const auto refused = [&](const Bytes& bytes) {
    folder_.write("state", bytes);
    try {
      render_bits(scene(), settings(16, true));
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({whole.begin(), whole.begin() + 10}));
  EXPECT_TRUE(refused({whole.begin(), whole.begin() + 40}));
  EXPECT_TRUE(refused({whole.begin(), whole.end() - 1}));
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_TRUE(refused(longer));
  Bytes other_magic = whole;
  other_magic[0] ^= 1;
  EXPECT_TRUE(refused(other_magic));
  std::filesystem::remove(folder_.file("state"));
  EXPECT_THROW(render_bits(scene(), settings(16, true)), InputError);
}

INSTANTIATE_TEST_SUITE_P(Parity, Resume,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double")));

}  // namespace

}  // namespace alhazen::impl::test
