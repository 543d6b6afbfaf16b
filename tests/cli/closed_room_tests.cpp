// A closed room under a bright sky is black inside, at any position, in the world or as an instance, with every engine.

#include <alhazen/alhazen.h>

#include <algorithm>

#include "cli/fixture.h"
#include "core/math/vec.h"

namespace alhazen::impl::test {

namespace {

class ClosedRoom : public Command {
 protected:
  static constexpr const char* cube = R"(Shape "trianglemesh"
  "point3 P" [ -1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1  1 -1 -1  1 -1 1  1 1 -1  1 1 1 ]
  "integer indices" [ 0 1 3 0 3 2  4 6 7 4 7 5  0 4 5 0 5 1  2 3 7 2 7 6  0 2 6 0 6 4  1 5 7 1 7 3 ]
)";

  /// The room about `place`, with a camera at its centre that looks in all directions.
  void write_room(const Vec3d& place, const std::string& turn, bool is_instance) const {
    const auto translate = [](const Vec3d& to) {
      return "Translate " + std::to_string(to.x) + " " + std::to_string(to.y) + " " + std::to_string(to.z) + "\n";
    };
    std::string room = "AttributeBegin\n" + translate(place) + turn +
                       (is_instance ? "ObjectInstance \"room\"\n" : cube) + "AttributeEnd\n";
    // Motion turns this shape into an object, and all others into instances.
    if (is_instance)
      room = std::string("ObjectBegin \"room\"\n") + cube + "ObjectEnd\n" + room +
             "AttributeBegin\nActiveTransform StartTime\nTranslate 0 9000 0\nActiveTransform EndTime\n"
             "Translate 1 9000 0\nActiveTransform All\nObjectInstance \"room\"\nAttributeEnd\n";
    folder_.write_text("room.pbrt", R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
)" + translate(-place) + R"(Camera "spherical" "string mapping" "equirectangular"
WorldBegin
LightSource "infinite" "rgb L" [ 10000 10000 10000 ]
Material "diffuse" "rgb reflectance" [ 0.9 0.9 0.9 ]
)" + room);
  }

  float brightest(const std::vector<std::string>& engine) const {
    std::vector<std::string> arguments = {"render", "room.pbrt",   "-o", "room.exr", "--spp",
                                          "64",     "--max-depth", "8",  "-q"};
    arguments.insert(arguments.end(), engine.begin(), engine.end());
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    float brightest = 0;
    for (const std::vector<float>& plane : image("room.exr").planes)
      for (const float value : plane) brightest = std::max(brightest, value);
    return brightest;
  }
};

/// Close to triangles that are much longer than wide, rounding once gave hits the wrong distance: up to all pixels were
/// lit. Where they are more than a thousand times as long as wide, a few rays in ten million still pass an edge.
TEST_F(ClosedRoom, LongRoomsAreBlackInside) {
  for (const std::string shape : {"Scale 1 1000 1\n", "Rotate 33 1 2 3\nScale 1000 100 1\n", "Scale 1 10000 1\n",
                                  "Rotate 90 0 0 1\nScale 1 10000 1\n"})
    for (const char* integrator : {"path", "iterative"}) {
      SCOPED_TRACE(shape + integrator);
      write_room({}, shape, false);
      const float lightest = brightest({"--integrator", integrator});
      if (shape.find("10000") == std::string::npos) {
        EXPECT_EQ(lightest, 0);
        continue;
      }
      EXPECT_LE(lightest, 10000.0f / 64 * 1.5f);  // one of 64 samples of a pixel, from a sky of 10,000
      const Image room = image("room.exr");
      EXPECT_LE(std::count_if(room.planes[0].begin(), room.planes[0].end(), [](float value) { return value > 0; }), 2);
    }
}

TEST_F(ClosedRoom, IsBlackInside) {
  std::vector<std::vector<std::string>> engines = {{}, {"--integrator", "iterative"}};
#if defined(ALHAZEN_WITH_EMBREE)
  engines.push_back({"--backend", "embree"});
#endif
  for (const Vec3d& place : {Vec3d{}, Vec3d{5, 2, 3}, Vec3d{1000, -500, 2000}, Vec3d{1e5, 2e5, -3e5}})
    for (const char* turn : {"", "Rotate 33 1 2 3\n", "Rotate 33 1 2 3\nScale 1 2 .5\n"})
      for (const bool is_instance : {false, true}) {
        write_room(place, turn, is_instance);
        for (const std::vector<std::string>& engine : engines)
          EXPECT_EQ(brightest(engine), 0) << place.x << " " << turn << (is_instance ? " as an instance" : "");
      }
}

/// Cans of a cylinder and two disks: wide and tall, flat, turned, stretched, skewed and far away.
TEST_F(ClosedRoom, CansAreBlackInside) {
  std::vector<std::vector<std::string>> engines = {{}, {"--backend", "cuda", "--device", "host"}};
#if defined(ALHAZEN_WITH_EMBREE)
  engines.push_back({"--backend", "embree"});
#endif
  for (const std::string precision : {"float", "double"})
    for (const char* place :
         {"", "Rotate 33 1 2 3\n", "Rotate 33 1 2 3\nScale 1 2 .5\n", "Rotate 33 1 2 3\nScale 1 1 100\n",
          "Rotate 33 1 2 3\nScale 100 100 1\n", "ConcatTransform [ 1 .3 .2 0  0 1 -.4 0  .5 0 1 0  .3 .2 .1 1 ]\n",
          "Translate 1000 -500 2000\nRotate 33 1 2 3\n"}) {
      const bool is_far = std::string(place).find("Translate") == 0;
      folder_.write_text("room.pbrt", "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 32\n" +
                                          std::string(is_far ? "Translate -1000 500 -2000\n" : "") +
                                          R"(Camera "spherical" "string mapping" "equirectangular"
WorldBegin
LightSource "infinite" "rgb L" [ 10000 10000 10000 ]
Material "diffuse" "rgb reflectance" [ 0.9 0.9 0.9 ]
)" + place + R"(Shape "cylinder"
Shape "disk" "float height" 1
Shape "disk" "float height" -1
)");
      for (std::vector<std::string> engine : engines) {
        if (precision == "double" && !engine.empty() && engine[1] == "embree") continue;
        engine.insert(engine.end(), {"--precision", precision});
        EXPECT_EQ(brightest(engine), 0) << place << engine[1];
      }
    }
}

}  // namespace
}  // namespace alhazen::impl::test
