// One-sided surfaces, as in glTF: the camera sees through their backs, and light enters a room through backs that the
// camera sees through. All other surfaces block light from both sides, so that rooms are dark inside and cards cast
// shadows.

#include <gtest/gtest.h>

#include "support/compiled_scenes.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t side = 16;

std::string view(const std::string& eye, const std::string& target, const std::string& camera) {
  return film_of(side, side) + "LookAt " + eye + " " + target + " 0 1 0 Camera " + camera + " WorldBegin ";
}
const std::string narrow = "\"perspective\" \"float fov\" 2";

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1] ";
const std::string sun = "LightSource \"distant\" \"point3 from\" [0.2 1 0.3] \"point3 to\" [0 0 0] \"rgb L\" [3 3 3] ";

/// The walls of a cube of half side 1, each of two triangles: left, right, floor, ceiling, back (z = -1) and front.
/// Their fronts face inwards.
std::string walls(const std::string& which) {
  const std::pair<char, std::string> all[] = {
      {'l', "-1 -1 -1  -1 1 -1  -1 1 1  -1 -1 1"}, {'r', "1 -1 -1  1 -1 1  1 1 1  1 1 -1"},
      {'f', "-1 -1 -1  -1 -1 1  1 -1 1  1 -1 -1"}, {'c', "-1 1 -1  1 1 -1  1 1 1  -1 1 1"},
      {'b', "-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1"}, {'n', "-1 -1 1  -1 1 1  1 1 1  1 -1 1"}};
  std::string text;
  for (const auto& [name, points] : all)
    if (which.find(name) != std::string::npos)
      text += "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [0 1 2 0 2 3]\n";
  return text;
}

Scene one_sided(const std::string& text) {
  Scene scene = described_scene(text);
  for (Material& material : scene.materials) material.double_sided = false;
  return scene;
}

template <class Real>
double mean_of(Scene scene, IntegratorKind integrator = IntegratorKind::path, uint32_t segments = 8,
               uint32_t samples = 64) {
  const CompiledScene<Real> flat = compiled_scene<Real>(std::move(scene));
  return render_pixels(flat.view, Take{integrator, SamplerType::sobol, segments, samples, 3}, side, side).mean();
}

template <class Real>
class OneSided : public ::testing::Test {};
TYPED_TEST_SUITE(OneSided, Reals);

/// Fronts face inwards: the two triangles of each wall have that winding.
TYPED_TEST(OneSided, WallsLookInwards) {
  const CompiledScene<TypeParam> scene =
      compiled_scene_of<TypeParam>(view("0 0 9", "0 0 0", narrow) + sky + walls("lrfcbn"));
  ASSERT_EQ(scene.view.triangles_count, 12u);
  for (uint32_t i = 0; i < 12; ++i) {
    const TriangleRecord& t = scene.view.triangles[i];
    EXPECT_LT(dot(triangle_front_normal(scene.view, t), scene.view.positions[t.vertex[0]]), TypeParam(0));
  }
}

/// A room seen from outside equals the room without the walls that the camera looks through, with every integrator and
/// camera.
TYPED_TEST(OneSided, RoomSeenFromOutsideIsOpenToTheSky) {
  using Real = TypeParam;
  struct View {
    std::string text, open;  ///< `open`: only the walls that the camera does not look through
  };
  const View views[] = {
      {view("0 0 5", "0 -0.4 -1", "\"perspective\" \"float fov\" 12"), "lrfcb"},
      {view("0 4 5", "0 -1 0", "\"perspective\" \"float fov\" 8"), "lrfb"},
      {view("4 4 5", "0 -1 0", "\"perspective\" \"float fov\" 8"), "lfb"},
      {view("0 0 5", "0 0 -1", "\"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 0.5]"), "lrfcb"},
      {view("0 0 5", "0 -0.4 -1", "\"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 0.5]"), "lrfb"},
      {view("4 4 5", "0 -0.6 0", "\"orthographic\" \"float screenwindow\" [-0.3 0.3 -0.3 0.3]"), "lfb"}};
  const std::string clay = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] ";
  for (const View& v : views)
    for (const IntegratorKind integrator :
         {IntegratorKind::path, IntegratorKind::iterative, IntegratorKind::recursive, IntegratorKind::branching}) {
      SCOPED_TRACE(v.text + to_string(integrator));
      const double room = mean_of<Real>(one_sided(v.text + sky + clay + walls("lrfcbn")), integrator, 4);
      const double open = mean_of<Real>(described_scene(v.text + sky + clay + walls(v.open)), integrator, 4);
      // The random numbers are the same, but rays that pass through a wall are restarted behind it.
      EXPECT_NEAR(room, open, 0.02 * open);
      EXPECT_GT(room, 0.15);
    }
}

/// This also holds if only a part of the wall is visible through a hole in a board in front of it.
TYPED_TEST(OneSided, RoomSeenThroughAHoleIsOpen) {
  using Real = TypeParam;
  const std::string clay = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] ";
  const std::string board =
      "Shape \"trianglemesh\" \"point3 P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2  0.26 0.21 2  0.34 0.21 2  0.34 0.29 2  "
      "0.26 0.29 2] "
      "\"integer indices\" [0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7] ";
  const std::string hole = view("0 0 5", "0.3 0.25 2", "\"perspective\" \"float fov\" 0.5");
  const double room = mean_of<Real>(one_sided(hole + sky + clay + board + walls("lrfcbn")));
  const double open = mean_of<Real>(described_scene(hole + sky + clay + board + walls("lrfcb")));
  EXPECT_GT(open, 0.05);
  EXPECT_NEAR(room, open, 0.02 * open);  // the whole wall is absent
}

/// If all lights are delta lights, they enter through every back; solid objects stop them all the same.
TYPED_TEST(OneSided, RoomSeenFromOutsideIsOpenToTheSun) {
  using Real = TypeParam;
  const std::string outside = view("0 0 5", "0 -1 0", "\"perspective\" \"float fov\" 2");
  const std::string clay = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] ";
  const double lit = 0.7 / pi<double> * 3 / std::sqrt(1.13);
  for (const std::string& light :
       {sun, std::string("LightSource \"point\" \"point3 from\" [0.8 3 1.2] \"rgb I\" [50 50 50] ")}) {
    const double room = mean_of<Real>(one_sided(outside + light + clay + walls("lrfcbn")), IntegratorKind::path, 2);
    const double bare = mean_of<Real>(described_scene(outside + light + clay + walls("f")), IntegratorKind::path, 2);
    EXPECT_NEAR(room, bare, 1e-3 * bare);
    EXPECT_GT(room, 0.5 * lit);
    const std::string body = "AttributeBegin Translate 0.1 -0.5 0.15 Scale 0.3 0.1 0.6 ReverseOrientation " +
                             walls("lrfcbn") + "AttributeEnd ";
    EXPECT_LT(mean_of<Real>(one_sided(outside + light + clay + walls("lrfcbn") + body), IntegratorKind::path, 2),
              0.05 * bare);
  }
}

/// From inside one-sided walls are walls: no light of sky or sun enters, and that of a lamp stays.
TYPED_TEST(OneSided, RoomSeenFromWithinIsClosed) {
  using Real = TypeParam;
  const std::string inside = view("0 0 0.9", "0 -0.2 -1", "\"perspective\" \"float fov\" 60");
  const std::string clay = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] ";
  EXPECT_LT(mean_of<Real>(one_sided(inside + sky + sun + clay + walls("lrfcbn"))), 5e-3);
  // Nor if the room contains something whose back is visible, such as an open box.
  const std::string open_box =
      "AttributeBegin Translate 0 -0.6 -0.4 Scale 0.3 0.3 0.3 ReverseOrientation " + walls("lrfbn") + "AttributeEnd ";
  EXPECT_LT(mean_of<Real>(one_sided(inside + sun + clay + walls("lrfcbn") + open_box)), 5e-3);
  const std::string lamp = "LightSource \"point\" \"point3 from\" [0 0.5 0] ";
  const double one = mean_of<Real>(one_sided(inside + lamp + clay + walls("lrfcbn")));
  const double two = mean_of<Real>(described_scene(inside + lamp + clay + walls("lrfcbn")));
  EXPECT_GT(two, 0.1);
  EXPECT_NEAR(one, two, 1e-3 * two);
}

/// A card above a floor, of which the camera sees a spot below the card: it casts a shadow whichever way its front
/// faces, as long as the camera sees the front; if the camera sees its back, the card is absent.
TYPED_TEST(OneSided, CardsThrowShadows) {
  using Real = TypeParam;
  const std::string floor =
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"trianglemesh\" \"point3 P\" [-9 0 -9  -9 0 9  9 "
      "0 9  "
      "9 0 -9] \"integer indices\" [0 1 2 0 2 3] ";
  const std::string up =
      "Shape \"trianglemesh\" \"point3 P\" [-1 1 -1  -1 1 1  1 1 1  1 1 -1] \"integer indices\" [0 1 2 0 2 3] ";
  const std::string above = view("0 2.5 6", "0 0 0", narrow),
                    below = view("0 0.5 6", "0 0 0", "\"perspective\" \"float fov\" 1");
  const std::string light = "LightSource \"point\" \"point3 from\" [0 3 0] \"rgb I\" [50 50 50] ";
  const double lit = mean_of<Real>(described_scene(above + light + floor));
  EXPECT_GT(lit, 0.5);
  const auto with_card = [&](const std::string& eye, bool faces_up) {
    return mean_of<Real>(one_sided(eye + light + floor + (faces_up ? "" : "ReverseOrientation ") + up),
                         IntegratorKind::path, 2);
  };
  EXPECT_EQ(with_card(above, true), 0);   // its back faces the floor, and stops the light
  EXPECT_EQ(with_card(below, false), 0);  // so does its front
  // Whatever other backs the camera sees.
  const std::string elsewhere =
      "AttributeBegin Translate 30 2 -9 Rotate 180 0 1 0 Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  "
      "-1 1 0] "
      "\"integer indices\" [0 1 2 0 2 3] AttributeEnd ";
  for (const std::string& eye : {above, below})
    EXPECT_EQ(
        mean_of<Real>(one_sided(eye + light + floor + elsewhere + (eye == above ? "" : "ReverseOrientation ") + up),
                      IntegratorKind::path, 2),
        0);
  EXPECT_NEAR(with_card(above, false), lit, 0.01 * lit);
  EXPECT_NEAR(with_card(below, true), mean_of<Real>(described_scene(below + light + floor)), 0.01 * lit);
}

/// Two coincident cards, back to back, in any order: from each side, and in a mirror, the one facing the viewer is
/// visible; both cast shadows.
TYPED_TEST(OneSided, CardsBackToBack) {
  using Real = TypeParam;
  const auto card = [](const std::string& reflectance, const std::string& orientation) {
    return "AttributeBegin " + orientation + " Material \"diffuse\" \"rgb reflectance\" [" + reflectance +
           "] Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"integer indices\" [0 1 2 0 2 3] "
           "AttributeEnd ";
  };
  const std::string bright = "0.8 0.8 0.8", dark = "0.2 0.2 0.2", turned = "ReverseOrientation";
  const std::string pairs[] = {card(bright, "") + card(dark, turned), card(dark, turned) + card(bright, "")};
  const std::string mirror =
      "Material \"conductor\" \"rgb reflectance\" [1 1 1] \"float roughness\" 0 Shape \"trianglemesh\" \"point3 P\" "
      "[-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1] \"integer indices\" [0 1 2 0 2 3] ";
  const std::string front = view("0.2 0.1 5", "0 0 0", narrow), back = view("0.2 0.1 -5", "0 0 0", narrow),
                    by_mirror = view("4 0 3", "0.8 0 -1", narrow);
  for (const std::string& pair : pairs)
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::iterative}) {
      SCOPED_TRACE(pair + to_string(integrator));
      EXPECT_NEAR(mean_of<Real>(one_sided(front + sky + pair), integrator), 0.8, 0.01);
      EXPECT_NEAR(mean_of<Real>(one_sided(back + sky + pair), integrator), 0.2, 0.01);
      const double mirrored = mean_of<Real>(described_scene(by_mirror + sky + card(dark, "") + mirror), integrator);
      EXPECT_LT(mirrored, 0.2);
      EXPECT_NEAR(mean_of<Real>(one_sided(by_mirror + sky + pair + mirror), integrator), mirrored, 0.005);
    }
  const std::string wall =
      "Material \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [-9 -9 -0.5  9 -9 -0.5  9 9 -0.5  "
      "-9 9 -0.5] \"integer indices\" [0 1 2 0 2 3] ";
  const std::string lamp = "LightSource \"point\" \"point3 from\" [0.4 0 2] \"rgb I\" [9 9 9] ";
  const std::string beside = view("9 0 -0.3", "0.25 0 -0.5", "\"perspective\" \"float fov\" 0.1");
  EXPECT_GT(mean_of<Real>(one_sided(beside + lamp + wall), IntegratorKind::path, 2), 0.1);
  for (const std::string& pair : pairs)
    EXPECT_EQ(mean_of<Real>(one_sided(beside + lamp + wall + pair), IntegratorKind::path, 2), 0);
}

/// A card is lit on its front, by light from that side.
TYPED_TEST(OneSided, CardsAreLit) {
  using Real = TypeParam;
  const std::string card =
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 "
      "1 0  "
      "-1 1 0] \"integer indices\" [0 1 2 0 2 3] ";
  const std::string front = view("0 0 5", "0 0 0", narrow), back = view("0 0 -5", "0 0 0", narrow);
  const auto lamp = [](const std::string& at) { return "LightSource \"point\" \"point3 from\" [" + at + "] "; };
  const double lit = 0.5 / pi<double> / 4;
  EXPECT_NEAR(mean_of<Real>(one_sided(front + lamp("0 0 2") + card)), lit, 0.01 * lit);
  EXPECT_EQ(mean_of<Real>(one_sided(front + lamp("0 0 -2") + card)), 0);
  EXPECT_EQ(mean_of<Real>(one_sided(back + lamp("0 0 2") + card)), 0);
  EXPECT_NEAR(mean_of<Real>(one_sided(front + sky + card)), 0.5, 0.01);
  EXPECT_NEAR(mean_of<Real>(one_sided(back + sky + card)), 1, 1e-6);
}

/// Solid bodies are the same as two-sided ones, to the last bit: nobody sees their backs.
TYPED_TEST(OneSided, BodiesAreTheSameWithOneSideAndTwo) {
  using Real = TypeParam;
  const std::string text = view("2 3 6", "0 0.5 0", "\"perspective\" \"float fov\" 40") + sky + sun +
                           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"trianglemesh\" \"point3 P\" "
                           "[-9 -1.1 -9  -9 -1.1 9  9 -1.1 9  9 -1.1 -9] \"integer indices\" [0 1 2 0 2 3] "
                           "ReverseOrientation " +
                           walls("lrfcbn");
  EXPECT_EQ(mean_of<Real>(one_sided(text)), mean_of<Real>(described_scene(text)));
}

/// A wall that emits on its front illuminates its room, although the camera looks through its back.
TYPED_TEST(OneSided, LampsInTheWallThatIsLookedThrough) {
  using Real = TypeParam;
  const std::string outside = view("0 4 5", "0 -1 0", "\"perspective\" \"float fov\" 8");
  const std::string clay = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] ";
  const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] ";
  const auto room = [&](IntegratorKind integrator) {
    return mean_of<Real>(one_sided(outside + clay + walls("lrfb") + lamp + walls("c")), integrator, 3, 256);
  };
  // The ceiling seen from the centre of the floor has a form factor of 0.239, and the walls add to it.
  EXPECT_GT(room(IntegratorKind::path), 0.7 * 0.23);
  EXPECT_NEAR(room(IntegratorKind::path), room(IntegratorKind::iterative), 0.01);
}

}  // namespace
}  // namespace alhazen::impl::test
