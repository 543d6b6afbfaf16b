// Light that no path finds causes one warning on the command line, with both locations.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Caustics : public Command {
 protected:
  Caustics() {
    folder_.write_text("spot.pbrt", R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 3 6  0 0 0  0 1 0
Camera "perspective"
Integrator "sppm"
WorldBegin
LightSource "spot" "point3 from" [0 4 0] "point3 to" [0 0 0]
Material "dielectric"
AttributeBegin
Translate 0 1.5 0
Shape "sphere"
AttributeEnd
Material "diffuse"
Shape "bilinearmesh" "point3 P" [-5 0 -5  5 0 -5  -5 0 5  5 0 5]
)");
  }

  static size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  }
};

TEST_F(Caustics, LightAndGlassAreNamed) {
  const CommandResult result = run({"render", "spot.pbrt", "--spp", "1", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(count(result.err, "spot.pbrt:6:1: "), 1u) << result.err;
  EXPECT_NE(result.err.find("spot light is lost at the glass spot.pbrt:10:1"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\"sppm\" that the file asks for"), std::string::npos) << result.err;
}

/// Light of a sun comes through a window, by rays that hit it; that of a distant light does not.
TEST_F(Caustics, ASunShinesThroughGlass) {
  const auto brightness = [&](const std::string& angle) {
    folder_.write_text("window.pbrt", R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0.9 0  0 0 0  0 0 1 Camera "perspective" "float fov" 40
WorldBegin LightSource "distant" "rgb L" [1 1 1] "point3 from" [0 1 0] "point3 to" [0 0 0] "float angle" )" +
                                          angle + R"(
Material "diffuse" "rgb reflectance" [1 1 1]
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]
Material "thindielectric" "float eta" 1.5
Shape "bilinearmesh" "point3 P" [-9 1 -9  9 1 -9  -9 1 9  9 1 9])");
    const CommandResult result = run({"render", "window.pbrt", "-o", "w.pfm", "--spp", "256", "--max-depth", "2"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    double sum = 0;
    const Image rendered = image("w.pfm");
    for (const float value : rendered.planes[1]) sum += static_cast<double>(value);
    return sum / 64;
  };
  EXPECT_EQ(brightness("0"), 0);
  // Of light along the normal the pane transmits (1 - R) / (1 + R) with R = 0.04; the floor has radiance E / pi.
  EXPECT_NEAR(brightness("40"), 0.96 / 1.04 / 3.14159, 0.03);
}

/// The other integrators do not find such lights at all, and warn of that.
TEST_F(Caustics, OtherIntegratorsSayWhatTheyDo) {
  const CommandResult result = run({"render", "spot.pbrt", "--spp", "1", "-o", "a.exr", "--integrator", "iterative"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err.find("is lost at"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("'iterative' does not show them"), std::string::npos) << result.err;
}

}  // namespace

}  // namespace alhazen::impl::test
