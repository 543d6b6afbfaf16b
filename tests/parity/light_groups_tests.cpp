// Layers of what groups of lights give.

#include <cmath>

#include "parity/layer_scenes.h"

namespace alhazen::impl::test {

namespace {

/// A grey floor under a sky, with lights of several kinds; those of `which` shine.
Scene lit(const std::string& which) {
  const auto light = [&](char name, const std::string& text) {
    return which.find(name) != std::string::npos ? text : std::string();
  };
  return scene_of(R"(LookAt 0 -4 3  0 0 0  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
Integrator "path" "integer maxdepth" 4
WorldBegin
)" + light('s', "LightSource \"infinite\" \"rgb L\" [ 0.1 0.2 0.4 ]\n") +
                  light('d', "LightSource \"distant\" \"rgb L\" [ 1 0.8 0.5 ] \"point3 from\" [ 1 -1 2 ]\n") +
                  light('p', "LightSource \"point\" \"rgb I\" [ 0 2 0 ] \"point3 from\" [ -1 0 1 ]\n") +
                  "AttributeBegin\n" + light('a', "AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]\n") +
                  R"(Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Translate 0.5 0.3 1
Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "trianglemesh" "point3 P" [ -3 -3 0  3 -3 0  3 3 0  -3 3 0 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "conductor"
Translate -0.6 -0.5 0.5
Shape "sphere" "float radius" 0.5
)");
}

constexpr const char* colours[] = {".R", ".G", ".B"};

void expect_sum(const Outcome& outcome, const std::vector<std::string>& groups) {
  for (const char* colour : colours) {
    const std::vector<double> all = plane(outcome, colour + 1);
    std::vector<double> sum(all.size());
    for (const std::string& group : groups) {
      const std::vector<double> part = plane(outcome, "light_" + group + colour);
      ASSERT_EQ(part.size(), all.size()) << group;
      for (size_t i = 0; i < all.size(); ++i) sum[i] += part[i];
    }
    for (size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(sum[i], all[i], 2e-5 * (1 + std::abs(all[i]))) << i;
  }
}

TEST(LightGroups, AreOfEachNameAndSumToTheImage) {
  for (const char* guiding : {"off", "on"})
    for (const char* precision : {"float", "double"}) {
      SCOPED_TRACE(std::string(guiding) + " " + precision);
      Settings settings = serial({"light_groups"});
      settings.guiding = guiding;
      settings.precision = precision;
      settings.filter = "mitchell";
      settings.samples_per_pixel = 40;
      expect_sum(render_bits(lit("sdpa"), settings), {"environment", "distant_1", "point_1", "sphere_1"});
    }
}

TEST(LightGroups, HoldWhatTheirLightsAloneGive) {
  Settings settings = serial();
  settings.samples_per_pixel = 1024;
  const Settings plain = settings;
  settings.light_groups = {"sun=distant.1", "lamps=point*,sphere.?"};
  const Outcome outcome = render_bits(lit("sdpa"), settings);
  const std::pair<const char*, const char*> groups[] = {{"s", "rest"}, {"d", "sun"}, {"pa", "lamps"}};
  for (const auto& [lights, group] : groups) {
    const Outcome alone = render_bits(lit(lights), plain);
    for (const char* colour : colours) {
      const double expected = mean(plane(alone, colour + 1));
      EXPECT_NEAR(mean(plane(outcome, "light_" + std::string(group) + colour)), expected, 0.01 * expected) << group;
    }
  }
}

TEST(LightGroups, AreThoseOfTheLightsThatPathsMeet) {
  const std::string world = R"(Material "diffuse" "rgb reflectance" [ 0 0 0 ]
AreaLightSource "diffuse" "rgb L" [ 2 2 2 ] "bool twosided" true
)" + rectangle(-1, 0, -1, 1);
  const Outcome outcome = render_bits(seen(world), serial({"light_groups"}));
  EXPECT_NEAR(mean(plane(outcome, "light_environment.R")), 0.5, 1e-3);
  EXPECT_NEAR(mean(plane(outcome, "light_mesh_1.R")), 1, 1e-3);
}

TEST(LightGroups, HaveTheSameBitsOnEveryEngine) {
  Settings settings = serial({"light_groups"});
  settings.light_groups = {"a=environment,point.1", "b=sphere*"};
  settings.samples_per_pixel = 9;
  for (const char* guiding : {"off", "on"}) {
    settings.guiding = guiding;
    const Outcome expected = render_bits(lit("sdpa"), settings);
    visit_engines(settings, [&](const Settings& other) {
      SCOPED_TRACE(other.backend + " " + other.strategy + " guiding " + guiding);
      EXPECT_TRUE(same_bits(render_bits(lit("sdpa"), other), expected));
    });
  }
}

TEST(LightGroups, OfConstantLightsAreOne) {
  const auto skies = [](const std::string& second) {
    return seen("LightSource \"infinite\" \"rgb L\" [ " + second + " ]\n" + rectangle(-1, 0, -1, 1));
  };
  EXPECT_NEAR(mean(plane(render_bits(skies("0 0 0"), serial({"light_groups"})), "light_environment.R")), 0.75, 1e-3);
  Scene two = skies("1 1 1");
  two.lights[0].name = "sky";
  two.lights[1].name = "fog";
  Settings settings = serial();
  settings.light_groups = {"a=sky,fog"};
  EXPECT_NEAR(mean(plane(render_bits(two, settings), "light_a.R")), 1.5, 1e-3);
  settings.light_groups = {"a=sky", "b=fog"};
  EXPECT_THROW(render_bits(two, settings), InputError);
}

TEST(LightGroups, DoNotChangeTheImage) {
  Settings settings = serial();
  const Outcome plain = render_bits(lit("sdpa"), settings);
  settings.light_groups = {"a=point.1"};
  const Outcome grouped = render_bits(lit("sdpa"), settings);
  for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(plane(plain, channel), plane(grouped, channel));
}

TEST(LightGroups, NeedTheIntegratorPath) {
  Settings settings = serial({"light_groups"});
  settings.integrator = "iterative";
  EXPECT_THROW(resolve_settings(settings, lit("s")), InputError);
}

TEST(LightGroups, OfNoLightAreRefused) {
  Settings settings = serial();
  settings.light_groups = {"key=pont.1"};
  try {
    render_bits(lit("p"), settings);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no light is called 'pont.1'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("did you mean \"point.1\"?"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace alhazen::impl::test
