// The camera and the brightness of lights from the command line.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "alhazen/alhazen.h"
#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

/// Three balls of different colours and sizes over a ground that is far larger, with z or y upwards.
std::string three_balls(const std::string& camera) {
  return camera + R"(
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]
AttributeBegin Translate -1.5 0.2 0.1 Shape "sphere" "float radius" 0.6 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.1 0.8 0.1 ]
AttributeBegin Translate 0.2 -0.3 -0.2 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.1 0.1 0.8 ]
AttributeBegin Translate 1.4 0.1 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
)";
}

class View : public Command {
 protected:
  Image rendered(const std::string& camera, const std::vector<std::string>& arguments = {},
                 const std::string& more = "") {
    folder_.write_text("balls.pbrt", three_balls(camera) + more);
    std::vector<std::string> all{"render", "balls.pbrt", "-q", "--spp", "16", "-o", "a.exr", "--aov", "depth"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return image("a.exr");
  }

  static const std::vector<float>& plane(const Image& image, const char* channel) {
    return image.planes.at(static_cast<size_t>(image.channel(channel)));
  }

  static void expect_alike(const Image& a, const Image& b) {
    double sum = 0;
    for (const char* channel : {"R", "G", "B"})
      for (size_t i = 0; i < plane(a, channel).size(); ++i)
        sum += std::abs(static_cast<double>(plane(a, channel)[i] - plane(b, channel)[i]));
    EXPECT_LT(sum / static_cast<double>(3 * plane(a, "R").size()), 1e-3);
  }
};

const std::string perspective = " Camera \"perspective\" \"float fov\" 40";

TEST_F(View, LookAtDoesWhatTheSceneWouldSay) {
  for (const std::string mirror : {"", "Scale -1 1 1 "}) {
    SCOPED_TRACE(mirror);
    const Image wanted = rendered(mirror + "LookAt 1 -5 2  0.1 0 0.2  0 0 1" + perspective);
    const std::string other = mirror + "LookAt -3 -2 0.5  0 0 0  0 0 1" + perspective;
    expect_alike(rendered(other, {"--look-at", "1,-5,2,0.1,0,0.2"}), wanted);
    expect_alike(rendered(other, {"--look-at", "1,-5,2,0.1,0,0.2,0,0,2"}), wanted);
    const Image rolled = rendered(mirror + "LookAt 1 -5 2  0.1 0 0.2  1 0 1" + perspective);
    expect_alike(rendered(other, {"--look-at", "1,-5,2,0.1,0,0.2,1,0,1"}), rolled);
  }
}

TEST_F(View, FieldOfViewAndLens) {
  const std::string at = "LookAt 1 -5 2  0 0 0  0 0 1 Camera \"perspective\" ";
  expect_alike(rendered(at + "\"float fov\" 70", {"--fov", "30"}), rendered(at + "\"float fov\" 30"));
  expect_alike(rendered(at + "\"float fov\" 30", {"--aperture", "0.3", "--focus", "4"}),
               rendered(at + "\"float fov\" 30 \"float lensradius\" 0.3 \"float focaldistance\" 4"));
  // Without --focus, what the camera was placed for is sharp.
  expect_alike(rendered(at + "\"float fov\" 30", {"--aperture", "0.3", "--look-at", "0,-4,0,0,0,0"}),
               rendered(at + "\"float fov\" 30", {"--aperture", "0.3", "--look-at", "0,-4,0,0,0,0", "--focus", "4"}));
}

/// All that is seen is inside, and reaches close to two opposite edges.
TEST_F(View, OrbitAndFitSeeEverything) {
  for (const std::string ground : {"", "Shape \"sphere\" \"float radius\" 1000 \"float alpha\" 0"}) {
    for (const std::vector<std::string>& view : {std::vector<std::string>{"--fit"},
                                                 {"--orbit", "0,0"},
                                                 {"--orbit", "130,40"},
                                                 {"--orbit", "20,-90"},
                                                 {"--orbit", "0,90"},
                                                 {"--fit", "--fov", "80"}}) {
      SCOPED_TRACE(view[0] + (view.size() > 1 ? " " + view[1] : ""));
      const Image seen = rendered("LookAt 1 -5 2  0.1 0 0.2  0 0 1" + perspective, view, ground);
      const std::vector<float>& depth = plane(seen, "depth.Z");
      const size_t width = static_cast<size_t>(seen.width), height = static_cast<size_t>(seen.height);
      size_t hits = 0, left = width, right = 0, top = height, bottom = 0;
      for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x) {
          if (!(depth[y * width + x] > 0)) continue;
          ++hits;
          left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
        }
      EXPECT_GT(hits, 20u);
      EXPECT_GE(left, 1u);
      EXPECT_LT(right, width - 1);
      EXPECT_GE(top, 1u);
      EXPECT_LT(bottom, height - 1);
    }
  }
}

/// Where the centre of what is of this colour is, in pixels to the right of the middle.
double side_of(const std::vector<float>& strong, const std::vector<float>& weak, const std::vector<float>& depth,
               size_t width) {
  double sum = 0, weight = 0;
  for (size_t i = 0; i < strong.size(); ++i) {
    if (!(depth[i] > 0)) continue;
    const double excess = std::max(0.0, static_cast<double>(strong[i] - 2 * weak[i]));
    sum += excess * (static_cast<double>(i % width) + 0.5 - static_cast<double>(width) / 2);
    weight += excess;
  }
  return sum / weight;
}

/// In front x is to the right, so the red ball is on the left; behind it is on the right; at 90 degrees the blue one,
/// which is where x points, is nearest. So in left-handed and right-handed scenes, whatever is up and wherever their
/// cameras look, even straight down.
TEST_F(View, OrbitTurnsAboutTheMiddle) {
  for (const std::string mirror : {"", "Scale -1 1 1 "})
    for (const std::string camera : {"LookAt 1 -5 2  0 0 0  0 0 1", "LookAt 0 -2 8  0 0 0  0 0 1",
                                     "LookAt 1 2 -5  0 0 0  0 1 0", "LookAt 0 8 3  0 0 0  0 1 0"}) {
      SCOPED_TRACE(mirror + camera);
      const auto from = [&](const std::string& orbit) {
        return rendered(mirror + camera + perspective, {"--orbit", orbit});
      };
      const auto side = [&](const Image& image, const char* strong, const char* weak) {
        return side_of(plane(image, strong), plane(image, weak), plane(image, "depth.Z"),
                       static_cast<size_t>(image.width));
      };
      const Image front = from("0,10,9"), back = from("180,10,9");
      EXPECT_LT(side(front, "R", "B"), -2);
      EXPECT_GT(side(front, "B", "R"), 2);
      EXPECT_GT(side(back, "R", "B"), 2);
      EXPECT_LT(side(back, "B", "R"), -2);
      const auto nearest = [&](const Image& image, const char* strong, const char* weak) {
        float least = 1e9f;
        for (size_t i = 0; i < plane(image, strong).size(); ++i)
          if (plane(image, "depth.Z")[i] > 0 && plane(image, strong)[i] > 2 * plane(image, weak)[i])
            least = std::min(least, plane(image, "depth.Z")[i]);
        return least;
      };
      const Image right = from("90,30,9");
      EXPECT_LT(nearest(right, "B", "R"), nearest(right, "R", "B") - 1);
    }
}

/// A map that is bright in one direction, seen by a camera that looks along the horizon, at which it is turned:
/// counter- clockwise from above, what was in the middle goes to the left.
TEST_F(View, EnvironmentsAreTurned) {
  Image map{64, 32, {"R", "G", "B"}, {}};
  map.planes.assign(3, std::vector<float>(64 * 32, 0.01f));
  for (auto& values : map.planes)
    for (size_t y = 13; y < 19; ++y)
      for (size_t x = 30; x < 34; ++x) values[y * 64 + x] = 1;
  write_exr(folder_.file("map.exr"), source_of(map), {});
  for (const std::string mirror : {"", "Scale -1 1 1 "}) {
    SCOPED_TRACE(mirror);
    const auto seen = [&](const std::string& degrees) {
      folder_.write_text("empty.pbrt",
                         mirror +
                             "LookAt 0 0 0  0 0 -1  0 1 0 Camera \"perspective\" \"float fov\" 90\n"
                             "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\n");
      const CommandResult result = run({"render", "empty.pbrt", "-q", "--spp", "4", "--environment", "map.exr",
                                        "--environment-rotate", degrees, "-o", "a.exr"});
      EXPECT_EQ(result.exit_code, 0) << result.everything();
      const Image image = this->image("a.exr");
      double sum = 0, weight = 0;
      for (size_t i = 0; i < plane(image, "R").size(); ++i) {
        const double value = std::max(0.0, static_cast<double>(plane(image, "R")[i]) - 0.05);
        sum += value * (static_cast<double>(i % 32) - 15.5);
        weight += value;
      }
      return weight > 0 ? sum / weight : 1e9;
    };
    const double before = seen("0");
    EXPECT_NEAR(before, 0, 1.5);
    EXPECT_LT(seen("20"), -3);
    EXPECT_GT(seen("-20"), 3);
  }
}

TEST_F(View, LightsAreScaled) {
  const std::string at = "LookAt 1 -5 2  0 0 0  0 0 1" + perspective;
  const Image plain = rendered(at), strong = rendered(at, {"--environment-strength", "2"}),
              same = rendered(at, {"--light-scale", "5"});
  for (size_t i = 0; i < plane(plain, "R").size(); ++i) {
    EXPECT_NEAR(plane(strong, "R")[i], 2 * plane(plain, "R")[i], 1e-3f * plane(plain, "R")[i] + 1e-6f);
    EXPECT_EQ(plane(same, "R")[i], plane(plain, "R")[i]);
  }
  ASSERT_EQ(render({"-q", "--spp", "4", "-o", "one.exr"}).exit_code, 0);
  ASSERT_EQ(render({"-q", "--spp", "4", "-o", "three.exr", "--light-scale", "3"}).exit_code, 0);
  const Image one = image("one.exr"), three = image("three.exr");
  for (size_t i = 0; i < plane(one, "G").size(); ++i)
    EXPECT_NEAR(plane(three, "G")[i], 3 * plane(one, "G")[i], 2e-3f * plane(three, "G")[i] + 1e-6f);
}

TEST_F(View, SaysWhatHasNoEffect) {
  const CommandResult result =
      render({"-q", "--spp", "1", "-o", "a.exr", "--environment-rotate", "9", "--environment-strength", "2"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("--environment-rotate has no effect"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--environment-strength has no effect"), std::string::npos) << result.err;
}

/// Settings of programs are checked as well.
TEST_F(View, RefusesBadSettings) {
  const auto refuses = [&](const std::function<void(Settings&)>& set) {
    Settings settings;
    settings.samples_per_pixel = 1;
    set(settings);
    EXPECT_THROW(alhazen::render(folder_.file("scene.pbrt"), settings), std::exception);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuses([](Settings& s) { s.look_at = {1, 2, 3}; });
  refuses([](Settings& s) { s.orbit = {30}; });
  refuses([](Settings& s) { s.orbit = {30, 20, -1}; });
  refuses([&](Settings& s) { s.orbit = {nan, 20}; });
  refuses([](Settings& s) { s.fov = 200, s.fit = true; });
  refuses([](Settings& s) { s.aperture = -1; });
  refuses([&](Settings& s) { s.focus = nan; });
  refuses([&](Settings& s) { s.light_scale = nan; });
  refuses([](Settings& s) { s.environment_strength = -1; });
}

TEST_F(View, RefusesWhatMakesNoSense) {
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const std::string& word) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"-o", "none.exr"});
    const CommandResult result = render(all);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_FALSE(exists("none.exr"));
  };
  for (const char* text : {"1,2,3", "1,2,3,4,5,6,7", "a,b,c,d,e,f", "1,2,3,4,5,nan", "", "1,2,3,4,5,"})
    expect_refused({"--look-at", text}, "--look-at");
  expect_refused({"--look-at", "1,2,3,1,2,3"}, "two different points");
  expect_refused({"--look-at", "0,0,0,0,0,5,0,0,1"}, "upwards");
  for (const char* text : {"1", "0,91", "0,0,0", "0,0,-1", "x,0"}) expect_refused({"--orbit", text}, "--orbit");
  expect_refused({"--orbit", "0,0", "--look-at", "0,0,1,0,0,0"}, "not both");
  expect_refused({"--orbit", "0,0,4", "--fit"}, "--fit");
  for (const char* text : {"0", "180", "nan"}) expect_refused({"--fov", text}, "--fov");
  expect_refused({"--aperture", "-1"}, "--aperture");
  expect_refused({"--focus", "0"}, "--focus");
  for (const char* option : {"--environment-strength", "--light-scale"}) expect_refused({option, "-1"}, option);
  folder_.write_text("flat.pbrt", three_balls("Camera \"orthographic\""));
  for (const std::vector<std::string>& view :
       {std::vector<std::string>{"--fit"}, {"--fov", "30"}, {"--orbit", "0,0"}, {"--aperture", "1"}}) {
    std::vector<std::string> all{"render", "flat.pbrt", "-o", "none.exr"};
    all.insert(all.end(), view.begin(), view.end());
    EXPECT_EQ(run(all).exit_code, 2);
  }
  EXPECT_EQ(run({"render", "flat.pbrt", "-q", "--spp", "1", "-o", "flat.exr", "--orbit", "0,0,5"}).exit_code, 0);
  folder_.write_text("window.pbrt", three_balls("Camera \"perspective\" \"float screenwindow\" [ -1 1 -1 1 ]"));
  EXPECT_EQ(run({"render", "window.pbrt", "-o", "none.exr", "--fit"}).exit_code, 2);
}

/// As a model: lit from several sides, with shades of grey on it, and against a background.
TEST_F(View, AMeshAloneIsShownAsAModel) {
  folder_.write_text("tetrahedron.ply", R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
)");
  ASSERT_EQ(
      run({"render", "tetrahedron.ply", "-q", "--spp", "16", "--size", "32x32", "--aov", "depth,normal", "-o", "t.exr"})
          .exit_code,
      0);
  const Image seen = image("t.exr");
  std::set<int> shades;
  size_t hits = 0;
  for (size_t i = 0; i < plane(seen, "R").size(); ++i)
    if (plane(seen, "depth.Z")[i] > 0) {
      ++hits;
      shades.insert(static_cast<int>(plane(seen, "R")[i] * 10));
    }
  EXPECT_GT(hits, 100u);
  EXPECT_GT(shades.size(), 1u);
}

}  // namespace

}  // namespace alhazen::impl::test
