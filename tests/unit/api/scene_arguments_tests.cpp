// What a scene says to arguments that it cannot use, and that none of them ends the process.

#include <cmath>
#include <limits>

#include "api/scene_state.h"
#include "scene_support.h"
#include "support/random.h"

namespace alhazen::test {

namespace {

using SceneArguments = SceneTest;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

TEST_F(SceneArguments, WrongArgumentsAreNamed) {
  Sample s;
  const impl::SceneRevisions before = s.scene.state().revisions;
  const auto check = [](const auto& work, const char* argument) {
    const std::string message = error_of(work);
    EXPECT_EQ(message.find("'" + std::string(argument) + "'"), 0u) << argument << ": " << message;
  };
  const std::vector<float> three{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<uint32_t> one{0, 1, 2};
  Scene& scene = s.scene;
  check([&] { scene.add(MeshArrays{}); }, "positions");
  check([&] { scene.add(MeshArrays{.positions = three}); }, "indices");
  check([&] { scene.add(MeshArrays{.positions = std::vector<float>{1, 2}, .indices = one}); }, "positions");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = std::vector<uint32_t>{0, 1}}); }, "indices");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = std::vector<uint32_t>{0, 1, 3}}); }, "indices");
  check(
      [&] {
        scene.add(MeshArrays{.positions = std::vector<double>{0, 0, 0, 1, nan, 0, 0, 1, 0}, .indices = one});
      },
      "positions");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = one, .normals = std::vector<float>{1}}); },
        "normals");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = one, .uvs = three}); }, "uvs");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = one, .second_uvs = three}); }, "second_uvs");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = one, .colours = std::vector<float>{1}}); },
        "colours");
  check([&] { scene.add(MeshArrays{.positions = three, .indices = one, .tangents = std::vector<float>(12)}); },
        "tangents");
  check([&] { scene.set_positions(s.mesh, three); }, "positions");
  check([&] { scene.add(Pixels{}); }, "width");
  check([&] { scene.add(Pixels{.width = 1, .height = -1}); }, "height");
  check([&] { scene.add(Pixels{.width = 1, .height = 1, .channels = 2}); }, "channels");
  check([&] { scene.add(Pixels{.width = 1, .height = 1}); }, "bytes");
  check([&] { scene.add(Pixels{.width = 1, .height = 1, .floats = std::vector<float>{1}}); }, "floats");
  check([&] { scene.add(Pixels{.width = 1, .height = 1, .channels = 1, .floats = std::vector<float>{NAN}}); },
        "floats");
  check([&] { scene.add(Pixels{.width = 1 << 20, .height = 1 << 20}); }, "width");
  check([&] { scene.add(Diffuse{.reflectance = 1.5}); }, "reflectance");
  check([&] { scene.add(Diffuse{.reflectance = {0, nan, 0}}); }, "reflectance");
  check([&] { scene.add(Diffuse{.roughness = -1}); }, "roughness");
  check([&] { scene.add(Dielectric{.ior = 0}); }, "ior");
  check([&] { scene.add(Dielectric{.roughness = -1}); }, "roughness");
  check([&] { scene.add(Dielectric{.roughness = {0.1, nan}}); }, "roughness");
  check([&] { scene.add(Conductor{.reflectance = ColourInput(0.5), .eta = ColourInput(0.5)}); }, "reflectance");
  check([&] { scene.add(Conductor{.eta = ColourInput(0.5)}); }, "k");
  check([&] { scene.add(CoatedDiffuse{.thickness = -1}); }, "thickness");
  check([&] { scene.add(CoatedDiffuse{.bounces = -1}); }, "bounces");
  check([&] { scene.add(Principled{.attenuation_distance = 0}); }, "attenuation_distance");
  check([&] { scene.add(FbmTexture{.octaves = 0}); }, "octaves");
  check([&] { scene.add(CellularTexture{.jitter = 2}); }, "jitter");
  check([&] { scene.add(ChannelTexture{.channel = 3}); }, "channel");
  check([&] { scene.add(DirectionMixTexture{.direction = {}}); }, "direction");
  check([&] { scene.add(CoordinatesTexture{.mapping = {.uv_set = 2}}); }, "uv_set");
  check([&] { scene.add(CoordinatesTexture{.mapping = {.scale = {nan, 1}}}); }, "scale");
  check([&] { scene.add(CoordinatesTexture{.mapping = {.kind = static_cast<MappingKind>(9)}}); }, "mapping");
  check([&] { scene.add(Shape{Sphere{-1}}); }, "radius");
  check([&] { scene.add(Shape{Cylinder{.z_min = 1}}); }, "z_min");
  check([&] { scene.add(Shape{Disk{.inner_radius = 1}}); }, "inner_radius");
  check([&] { scene.add(Shape{Disk{.phi_max = 0}}); }, "phi_max");
  check([&] { scene.add(PointLight{.intensity = -1}); }, "intensity");
  check([&] { scene.add(PointLight{.position = {inf, 0, 0}}); }, "position");
  check([&] { scene.add(SpotLight{.cone_angle = 0}); }, "cone_angle");
  check([&] { scene.add(SpotLight{.falloff_start = 40}); }, "falloff_start");
  check([&] { scene.add(DistantLight{.direction = {}}); }, "direction");
  check([&] { scene.add(DistantLight{.angle = 200}); }, "angle");
  check([&] { scene.add(EnvironmentLight{}); }, "width");
  check([&] { scene.add(PointLight{}, scene.image(s.image)); }, "image");
  check([&] { scene.add(GoniometricLight{}, scene.image(s.image)); }, "image");
  check([&] { scene.add(ProjectionLight{.axes = {.x = {2, 0, 0}}}, scene.image(s.image)); }, "axes");
  check([&] { scene.set(s.lamp, EnvironmentLight{}); }, "width");
  check([&] { scene.set_camera({.fov = 180}); }, "fov");
  check([&] { scene.set_camera({.lens_radius = -1}); }, "lens_radius");
  check([&] { scene.set_camera({.shutter_close = 0}); }, "shutter_close");
  check([&] { scene.look_at({0, 0, 1}, {0, 0, 1}); }, "target");
  check([&] { scene.look_at({0, 0, 1}, {0, 0, 0}, Vec3{0, 0, 2}); }, "up");
  check([&] { scene.look_at({0, 1, 0}, {0, 0, 0}); }, "up");
  check([&] { scene.look_at({nan, 1, 0}, {0, 0, 0}); }, "eye");
  check([&] { scene.orbit(nan, 0); }, "azimuth");
  check([&] { scene.orbit(0, 0, 0); }, "distance");
  check([&] { scene.set_film({.width = 0}); }, "width");
  check([&] { scene.set_film({.height = -5}); }, "height");
  check([&] { scene.set_film({.width = 100'000, .height = 100'000}); }, "width");
  check([&] { scene.set_film({.pixel_bounds = {{5, 5, 0, 1}}}); }, "pixel_bounds");
  check([&] { scene.set_pixel_filter({.x_radius = 0}); }, "x_radius");
  check([&] { scene.set_render_defaults({.samples_per_pixel = 0}); }, "samples_per_pixel");
  check([&] { scene.set_render_defaults({.quality = "superb"}); }, "quality");
  check([&] { Transform::scale({1, 0, 1}); }, "factors");
  check([&] { Transform::rotate(1, {}); }, "axis");
  check([&] { Transform::translate({nan, 0, 0}); }, "offset");
  check([&] { Transform::from_matrix(std::vector<double>(5)); }, "matrix");
  check([&] { Transform::from_matrix(std::vector<double>(12)); }, "matrix");
  check([&] { Transform::look_at({}, {}); }, "target");
  EXPECT_EQ(scene.state().revisions, before);
}

TEST_F(SceneArguments, NothingContainsItself) {
  Scene scene;
  const TextureId a = scene.add(ScaleTexture{}), b = scene.add(ScaleTexture{.value = a});
  EXPECT_NE(error_of([&] { scene.set(a, ScaleTexture{.value = b}); }).find("itself"), std::string::npos);
  EXPECT_NE(error_of([&] { scene.set(a, MixTexture{.amount = a}); }).find("itself"), std::string::npos);
  const MaterialId x = scene.add(Diffuse{}), mix = scene.add(Mix{.materials = {x, x}});
  const MaterialId outer = scene.add(Mix{.materials = {x, mix}});
  EXPECT_NE(error_of([&] { scene.set(mix, Mix{.materials = {outer, x}}); }).find("itself"), std::string::npos);
  EXPECT_NE(error_of([&] { scene.set(x, Mix{.materials = {outer, mix}}); }).find("itself"), std::string::npos);
  TextureId deep = a;
  EXPECT_NE(error_of([&] {
              for (int i = 0; i < 200; ++i) deep = scene.add(MixTexture{.amount = deep});
            }).find("nested"),
            std::string::npos);
}

/// Whatever the arguments are, a call either succeeds, and the scene can be rendered or says what is wrong with it, or
/// throws an InputError that begins with the name of an argument.
TEST_F(SceneArguments, RandomArgumentsNeverCrash) {
  impl::test::Random random(7);
  const auto number = [&]() -> double {
    const double odd[] = {0, -0.0, 1, -1, nan, inf, -inf, 1e300, -1e300, 1e-300, 5e-324, 0.5, 2, 90, 1e20};
    return random.below(3) == 0 ? random.between(-2, 2) : odd[random.below(std::size(odd))];
  };
  const auto vec = [&] { return Vec3{number(), number(), number()}; };
  const auto colour = [&] { return Colour(number(), number(), number()); };
  const auto reals = [&](size_t count) {
    std::vector<double> values(random.below(8) == 0 ? random.below(20) : count);
    for (double& value : values) value = random.below(20) == 0 ? number() : random.between(-1, 1);
    return values;
  };
  Scene scene;
  scene.set_camera(view_of_pbrt());
  const auto transform = [&]() -> Transform {
    if (random.below(2)) return Transform::translate({random.between(-1, 1), 0, 0});
    return random.below(2) ? Transform::scale(vec()) : Transform::rotate(number(), vec());
  };
  int refused = 0, added = 0;
  for (int i = 0; i < 1000; ++i) {
    try {
      switch (random.below(9)) {
        case 0: {
          std::vector<uint32_t> indices{0, 1, 2};
          if (random.below(5) == 0) indices.resize(random.below(5), random.below(9));
          const std::vector<double> positions = reals(9), normals = reals(random.below(2) ? 9 : 0),
                                    uvs = reals(random.below(2) ? 6 : 0), tangents = reals(random.below(3) ? 0 : 12);
          scene.add(Shape{scene.add(MeshArrays{
              .positions = positions, .indices = indices, .normals = normals, .uvs = uvs, .tangents = tangents})});
          break;
        }
        case 1: {
          const std::vector<float> floats(random.below(40), static_cast<float>(number()));
          scene.add(Pixels{.width = static_cast<int>(random.below(5)) - 1,
                           .height = static_cast<int>(random.below(4)),
                           .channels = static_cast<int>(random.below(6)),
                           .floats = floats});
          break;
        }
        case 2:
          scene.add(Shape{
              Sphere{number()}, {}, transform(), random.below(3) ? std::nullopt : std::optional(Emission{colour()})});
          break;
        case 3:
          scene.add(Shape{Cylinder{number(), number(), number(), number()}, {}, transform()});
          break;
        case 4:
          scene.add(Principled{.base_colour = colour(),
                               .metallic = number(),
                               .ior = number(),
                               .attenuation_distance = number(),
                               .dispersion = number()});
          break;
        case 5:
          scene.add(MarbleTexture{.octaves = static_cast<int>(random.below(100)) - 10,
                                  .roughness = number(),
                                  .scale = number(),
                                  .texture_from_world = transform()});
          break;
        case 6:
          scene.add(SpotLight{colour(), vec(), vec(), number(), number()});
          break;
        case 7: {
          Camera camera;
          camera.transform = Transform::look_at(vec(), vec(), vec());
          camera.fov = number();
          camera.focal_distance = number();
          Scene other = scene;
          other.set_camera(camera);
          break;
        }
        default:
          scene.set_film({.width = static_cast<int64_t>(random.below(30)) - 5, .height = 10, .exposure = number()});
      }
      ++added;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\''), 0u) << error.what();
      ++refused;
    }
    if (i % 50 == 0) try {
        rendered(scene);
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()), "");
      }
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(added, 100);
}

}  // namespace

}  // namespace alhazen::test
