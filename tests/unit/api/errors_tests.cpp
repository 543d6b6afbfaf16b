// Every kind of error reaches the caller of the public interface as its class.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "alhazen/rays.h"
#include "alhazen/renderer.h"
#include "alhazen/save.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

/// Which class of errors `work` throws.
std::string kind_of_error(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError&) {
    return "input";
  } catch (const UnsupportedError&) {
    return "unsupported";
  } catch (const OutOfMemoryError&) {
    return "out of memory";
  } catch (const DeviceError&) {
    return "device";
  } catch (const Cancelled&) {
    return "cancelled";
  } catch (const Error&) {
    return "other";
  } catch (const std::bad_alloc&) {
    return "std::bad_alloc";
  }
  return "none";
}

alhazen::Scene lit_floor() {
  alhazen::Scene scene;
  add_floor(scene);
  add_lights(scene);
  return scene;
}

/// The size of the address space of this process, in bytes.
size_t address_space() {
  std::ifstream file("/proc/self/statm");
  size_t pages = 0;
  file >> pages;
  return pages * 4096;
}

/// Prints the kind of error of `work` with `more` bytes at most, and ends the process.
[[noreturn]] void end_with_little_memory(size_t more, const std::function<void()>& work) {
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = address_space() + more;
  ::setrlimit(RLIMIT_AS, &limit);
  std::fprintf(stderr, "kind: %s.", kind_of_error(work).c_str());
  std::_Exit(0);
}

/// Expects an OutOfMemoryError of `work` in a process of its own that gets `more` bytes at most.
void expect_out_of_memory(size_t more, const std::function<void()>& work) {
  EXPECT_EXIT(end_with_little_memory(more, work), testing::ExitedWithCode(0), "kind: out of memory\\.");
}

bool always(const Progress&) { return true; }
bool never(const Progress&) { return false; }

}  // namespace

TEST_F(SceneTest, ErrorsOfInputKnowTheirPlace) {
  const std::string file = folder_.write_text("bad.pbrt", "WorldBegin\n  Shape \"spear\"\n");
  try {
    alhazen::Scene::load(file);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), file);
    EXPECT_EQ(error.line(), 2);
    EXPECT_EQ(error.column(), 3);
    EXPECT_EQ(std::string(error.what()).find(file + ":2:3: " + error.message()), 0u) << error.what();
  }
  EXPECT_EQ(kind_of_error([&] { RayQueries::from_file(file); }), "input");
  EXPECT_EQ(kind_of_error([&] { render(file); }), "input");
  Settings settings;
  settings.backend = "abacus";
  EXPECT_EQ(kind_of_error([&] { render(lit_floor(), settings); }), "input");
}

TEST(Errors, WhatIsNotHereIsUnsupported) {
  size_t refused = 0;
  const auto expect_unsupported = [&](const Settings& settings, const std::string& name) {
    const std::string kind = kind_of_error([&] { render(lit_floor(), settings); });
    EXPECT_TRUE(kind == "unsupported" || kind == "none") << name << ": " << kind;
    if (kind == "unsupported") ++refused;
  };
  for (const char* const backend : {"embree", "cuda", "optix"}) {
    Settings settings = quick_settings();
    settings.backend = backend;
    expect_unsupported(settings, backend);
  }
  for (const char* const denoiser : {"optix", "oidn"}) {
    Settings settings = quick_settings();
    settings.denoiser = denoiser;
    expect_unsupported(settings, denoiser);
  }
  if (refused == 0) GTEST_SKIP() << "all backends and denoisers are here";
}

TEST(Errors, ImagesBeyondTheMemoryAreOutOfMemory) {
  Settings settings = quick_settings();
  settings.width = settings.height = 31'000;
  settings.precision = "double";
  settings.aovs = {"albedo", "normal", "position", "uv", "motion", "cryptomatte", "components", "variance", "bounces"};
  EXPECT_EQ(kind_of_error([&] { render(lit_floor(), settings); }), "out of memory");
  Renderer renderer(settings);
  EXPECT_EQ(kind_of_error([&] { renderer.start(lit_floor()); }), "out of memory");
}

TEST(ErrorsDeathTest, FailedAllocationsAreOutOfMemory) {
  constexpr int width = 2048, height = 3072;
  constexpr size_t few = size_t{8} << 20;  // bytes, fewer than the arrays have
  const std::vector<float> floats(size_t{width} * height, 0.5f);
  const std::vector<uint32_t> indices{0, 1, 2};
  const Pixels pixels{.width = width, .height = height, .channels = 1, .floats = floats};
  expect_out_of_memory(few, [&] {
    alhazen::Scene scene;
    scene.add(MeshArrays{.positions = floats, .indices = indices});
  });
  expect_out_of_memory(few, [&] {
    alhazen::Scene scene;
    scene.add(pixels);
  });
  alhazen::Scene large;
  large.add(pixels);
  expect_out_of_memory(few, [&] { const alhazen::Scene copy = large; });
}

TEST(Errors, OtherFailuresAreErrors) {
  RenderedImage image;
  image.width = image.height = 1;
  image.channels = {"R", "G", "B"};
  image.planes = {{0}, {0}, {0}};
  EXPECT_EQ(kind_of_error([&] { save(image, "/no such folder/image.png"); }), "other");
}

TEST_F(SceneTest, ProgressCancelsWhatHasNoImage) {
  const std::string file = folder_.write_text("floor.pbrt", std::string("WorldBegin\n") + pbrt_floor);
  EXPECT_EQ(kind_of_error([&] { alhazen::Scene::load(file, {}, never); }), "cancelled");
  EXPECT_EQ(kind_of_error([&] { RayQueries::from_file(file, {}, never); }), "cancelled");
  EXPECT_EQ(kind_of_error([&] { RayQueries(lit_floor(), {}, never); }), "cancelled");
  Renderer renderer(quick_settings());
  EXPECT_EQ(kind_of_error([&] { renderer.start(lit_floor(), never); }), "cancelled");
  EXPECT_EQ(kind_of_error([&] { renderer.render_pass(); }), "input") << "no image is under way";
  EXPECT_EQ(kind_of_error([&] {
              alhazen::Scene::load(file, {}, always);
              RayQueries::from_file(file, {}, always);
            }),
            "none");
  const alhazen::Scene scene = lit_floor();
  EXPECT_EQ(renderer.render(scene).planes, render(scene, quick_settings()).planes) << "the next is as any";
}

TEST_F(SceneTest, RendersThatAreCancelledEarlyAreEmpty) {
  const std::string file = folder_.write_text("floor.pbrt", std::string("WorldBegin\n") + pbrt_floor);
  std::vector<std::string> activities;
  const auto stop = [&](const Progress& progress) {
    activities.push_back(progress.activity);
    return false;
  };
  Renderer renderer(quick_settings());
  for (const RenderedImage& image : {render(file, quick_settings(), stop), render(lit_floor(), quick_settings(), stop),
                                     renderer.render(lit_floor(), stop)}) {
    EXPECT_FALSE(image.complete);
    EXPECT_TRUE(image.planes.empty());
    EXPECT_EQ(image.width, 0);
  }
  ASSERT_EQ(activities.size(), 3u) << "it is called once";
  EXPECT_EQ(activities[0], "reading the scene");
  for (const std::string& activity : activities) EXPECT_NE(activity, "rendering");
}

TEST(Errors, WhatProgressThrowsWhileBuildingReachesTheCaller) {
  struct Own {};
  const auto fail = [](const Progress&) -> bool { throw Own{}; };
  EXPECT_THROW(render(lit_floor(), quick_settings(), fail), Own);
  EXPECT_THROW(RayQueries(lit_floor(), {}, fail), Own);
  Renderer renderer(quick_settings());
  EXPECT_THROW(renderer.start(lit_floor(), fail), Own);
  const auto lack = [](const Progress&) -> bool { throw std::bad_alloc(); };
  EXPECT_THROW(render(lit_floor(), quick_settings(), lack), std::bad_alloc);
  const auto cancel = [](const Progress&) -> bool { throw Cancelled("by itself"); };
  EXPECT_THROW(render(lit_floor(), quick_settings(), cancel), Cancelled);
  EXPECT_THROW(renderer.render(lit_floor(), cancel), Cancelled);
}

TEST(Errors, StopEndsABuild) {
  Renderer renderer(quick_settings());
  EXPECT_EQ(kind_of_error([&] {
              renderer.start(lit_floor(), [&](const Progress&) {
                renderer.stop();
                return true;
              });
            }),
            "cancelled");
}

}  // namespace alhazen::test
