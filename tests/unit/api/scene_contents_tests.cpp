// Shapes, lights, cameras and films made in memory render to the same bits as those of files that say the same.

#include <functional>

#include "images/image.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

struct SceneCase {
  const char* name;
  const char* text;  ///< of pbrt, without a camera if it begins with LookAt
  std::function<void(Scene&)> make;
};

void PrintTo(const SceneCase& scene, std::ostream* out) { *out << scene.name; }

Transform moved(double x, double y, double z) { return Transform::translate({x, y, z}); }

void with_lights(Scene& scene) { add_lights(scene); }

Shape shape_at(const Shape& shape, const MovingTransform& transform) {
  Shape placed = shape;
  placed.transform = transform;
  return placed;
}

Shape emissive(Shape shape, const Emission& emission) {
  shape.emission = emission;
  return shape;
}

const std::vector<SceneCase> shape_cases{
    {"sphere", R"(Translate 0.2 0 0 Shape "sphere" "float radius" 0.8)",
     [](Scene& scene) { scene.add(shape_at({Sphere{0.8}}, moved(0.2, 0, 0))); }},
    {"stretched_sphere", R"(Scale 1 0.5 1 Shape "sphere")",
     [](Scene& scene) {
       scene.add(shape_at({Sphere{}}, Transform::scale({1, 0.5, 1})));
     }},
    {"moving_sphere", R"(ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All Shape "sphere")",
     [](Scene& scene) {
       scene.add(shape_at({Sphere{}}, {Transform(), moved(0.5, 0, 0)}));
     }},
    {"cylinder", R"(Rotate 60 1 0 0 Shape "cylinder" "float radius" 0.5 "float zmin" -0.7 "float phimax" 200)",
     [](Scene& scene) {
       scene.add(shape_at({Cylinder{.radius = 0.5, .z_min = -0.7, .phi_max = 200}}, Transform::rotate(60, {1, 0, 0})));
     }},
    {"moving_cylinder", R"(ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All Shape "cylinder")",
     [](Scene& scene) {
       scene.add(shape_at({Cylinder{}}, {Transform(), moved(0.5, 0, 0)}));
     }},
    {"flat_cylinder", R"(Scale 1 1 0.00001 Shape "cylinder")",
     [](Scene& scene) {
       scene.add(shape_at({Cylinder{}}, Transform::scale({1, 1, 0.00001})));
     }},
    {"disk", R"(Rotate 30 1 1 0 Shape "disk" "float innerradius" 0.4 "float height" 0.1)",
     [](Scene& scene) {
       scene.add(shape_at({Disk{.inner_radius = 0.4, .height = 0.1}}, Transform::rotate(30, {1, 1, 0})));
     }},
    {"emissive_disk", R"(AreaLightSource "diffuse" "rgb L" [3 2 1] "bool twosided" true Shape "disk")",
     [](Scene& scene) {
       scene.add(emissive({Disk{}}, {.radiance = {3, 2, 1}, .two_sided = true}));
     }},
    {"emissive_sphere", R"(AreaLightSource "diffuse" "rgb L" [3 2 1] ReverseOrientation Shape "sphere")",
     [](Scene& scene) {
       Shape shape = emissive({Sphere{}}, {.radiance = {3, 2, 1}});
       shape.reverse_orientation = true;
       scene.add(shape);
     }},
    {"moving_mesh",
     R"(ActiveTransform EndTime Rotate 20 0 1 0 ActiveTransform All
        Shape "trianglemesh" "point3 P" [-1 0 0  1 0 0  0 1 0])",
     [](Scene& scene) {
       const MeshId mesh = scene.add(MeshArrays{.positions = std::vector<double>{-1, 0, 0, 1, 0, 0, 0, 1, 0},
                                                .indices = std::vector<uint32_t>{0, 1, 2}});
       scene.add(shape_at({mesh}, {Transform(), Transform::rotate(20, {0, 1, 0})}));
     }},
    {"normals",
     R"(Shape "trianglemesh" "point3 P" [-1 0 0  1 0 0  0 1 0] "integer indices" [0 2 1] "normal N" [0 0.5 -1  0.5 0 -1  0 0 -1])",
     [](Scene& scene) {
       scene.add({scene.add(MeshArrays{.positions = std::vector<float>{-1, 0, 0, 1, 0, 0, 0, 1, 0},
                                       .indices = std::vector<uint32_t>{0, 2, 1},
                                       .normals = std::vector<float>{0, 0.5f, -1, 0.5f, 0, -1, 0, 0, -1}})});
     }},
    {"instances",
     R"(ObjectBegin "pair" AttributeBegin Translate 0.3 0 0 Shape "sphere" "float radius" 0.3 AttributeEnd
          AttributeBegin Translate -0.3 0 0 Shape "cylinder" "float radius" 0.2 AttributeEnd
          Shape "trianglemesh" "point3 P" [-0.5 0 0  0.5 0 0  0 0.5 0] ObjectEnd
        AttributeBegin Translate 0.5 0 0 ObjectInstance "pair" AttributeEnd
        AttributeBegin Translate -0.5 0.2 0 Scale 1 0.6 1 ObjectInstance "pair" AttributeEnd)",
     [](Scene& scene) {
       const GroupId pair = scene.add_group("pair");
       scene.add(shape_at({Sphere{0.3}}, moved(0.3, 0, 0)), pair);
       scene.add(shape_at({Cylinder{.radius = 0.2}}, moved(-0.3, 0, 0)), pair);
       scene.add({scene.add(MeshArrays{.positions = std::vector<float>{-0.5f, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0},
                                       .indices = std::vector<uint32_t>{0, 1, 2}})},
                 pair);
       scene.add(Instance{.group = pair, .transform = moved(0.5, 0, 0)});
       scene.add(Instance{.group = pair, .transform = moved(-0.5, 0.2, 0) * Transform::scale({1, 0.6, 1})});
     }},
};

class SceneShapes : public SceneTest, public ::testing::WithParamInterface<SceneCase> {};

TEST_P(SceneShapes, HaveTheBitsOfAFile) {
  const std::string text = std::string(pbrt_view) + "WorldBegin\n" + pbrt_lights + pbrt_floor + GetParam().text;
  Scene scene;
  scene.set_camera(view_of_pbrt());
  with_lights(scene);
  add_floor(scene);
  GetParam().make(scene);
  const Planes expected = rendered_text(text);
  EXPECT_EQ(rendered(scene), expected);
  for (Scene again : {scene, Scene::load(folder_.file("scene.pbrt"))}) {
    for (const ShapeId shape : again.shapes()) again.set(shape, again.shape(shape));
    for (const InstanceId instance : again.instances()) again.set(instance, again.instance(instance));
    for (const LightId light : again.lights()) again.set(light, again.light(light));
    EXPECT_EQ(rendered(again), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SceneShapes, ::testing::ValuesIn(shape_cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

const std::vector<float>& test_map() {
  static const std::vector<float> values = [] {
    std::vector<float> map;
    for (int i = 0; i < 4 * 4 * 3; ++i) map.push_back(0.1f * static_cast<float>((7 * i) % 11));
    return map;
  }();
  return values;
}

Pixels map_pixels() { return {.width = 4, .height = 4, .channels = 3, .floats = test_map()}; }

const Axes pbrt_axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

const std::vector<SceneCase> light_cases{
    {"point", R"(LightSource "point" "rgb I" [10 9 8] "point3 from" [1 3 -2])",
     [](Scene& scene) {
       scene.add(PointLight{{10, 9, 8}, {1, 3, -2}});
     }},
    {"spot",
     R"(LightSource "spot" "rgb I" [30 20 10] "point3 from" [1 3 -2] "point3 to" [0.1 0 0.3] "float coneangle" 25
        "float conedeltaangle" 10)",
     [](Scene& scene) {
       scene.add(SpotLight{.intensity = {30, 20, 10},
                           .position = {1, 3, -2},
                           .direction = {0.1 - 1, -3, 0.3 + 2},
                           .cone_angle = 25,
                           .falloff_start = 15});
     }},
    {"distant", R"(LightSource "distant" "rgb L" [3 2 1] "point3 from" [1 3 -2])",
     [](Scene& scene) {
       scene.add(DistantLight{.irradiance = {3, 2, 1}, .direction = {-1, -3, 3}});
     }},
    {"sun", R"(LightSource "distant" "rgb L" [3 2 1] "point3 from" [1 3 -2] "float angle" 3)",
     [](Scene& scene) {
       scene.add(DistantLight{.irradiance = {3, 2, 1}, .direction = {-1, -3, 3}, .angle = 3});
     }},
    {"constant", R"(LightSource "infinite" "rgb L" [0.4 0.5 0.6])",
     [](Scene& scene) {
       scene.add(ConstantInfiniteLight{{0.4, 0.5, 0.6}});
     }},
    {"environment", R"(LightSource "infinite" "string filename" "map.pfm" "float scale" 0.8)",
     [](Scene& scene) { scene.add(EnvironmentLight{.scale = 0.8, .axes = pbrt_axes}, map_pixels()); }},
    {"goniometric", R"(Translate 1 3 -2 LightSource "goniometric" "string filename" "map.pfm" "rgb I" [20 20 10])",
     [](Scene& scene) {
       scene.add(GoniometricLight{{20, 20, 10}, {1, 3, -2}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}}, map_pixels());
     }},
    {"projection", R"(Translate 0 1 -3 LightSource "projection" "string filename" "map.pfm" "float fov" 50
        "float scale" 30)",
     [](Scene& scene) {
       scene.add(ProjectionLight{.intensity = 30, .position = {0, 1, -3}, .fov = 50}, map_pixels());
     }},
};

class SceneLights : public SceneTest, public ::testing::WithParamInterface<SceneCase> {};

TEST_P(SceneLights, HaveTheBitsOfAFile) {
  impl::Image image;
  image.width = image.height = 4;
  image.channels = {"R", "G", "B"};
  image.planes.resize(3);
  for (size_t i = 0; i < test_map().size(); ++i) image.planes[i % 3].push_back(test_map()[i]);
  impl::write_pfm(folder_.file("map.pfm"), impl::source_of(image), {});
  const std::string text = std::string(pbrt_view) + "WorldBegin AttributeBegin\n" + GetParam().text +
                           "\nAttributeEnd\n" + pbrt_floor + "Shape \"sphere\"\n";
  Scene scene;
  scene.set_camera(view_of_pbrt());
  GetParam().make(scene);
  add_floor(scene);
  scene.add(Shape{Sphere{}});
  const Planes expected = rendered_text(text);
  EXPECT_EQ(rendered(scene), expected);
  for (Scene again : {scene, Scene::load(folder_.file("scene.pbrt"))}) {
    const LightId light = again.lights().at(0);
    again.set(light, again.light(light));
    EXPECT_EQ(rendered(again), expected);
    // Another of the same kind and image.
    const LightId other = again.add(again.light(light), again.light_image(light));
    again.remove(light);
    EXPECT_EQ(again.lights(), std::vector<LightId>{other});
    EXPECT_EQ(rendered(again), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SceneLights, ::testing::ValuesIn(light_cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

using SceneContents = SceneTest;

TEST_F(SceneContents, EnvironmentsAreThoseOfTheSetting) {
  const std::string map = folder_.file("map.pfm");
  impl::Image image;
  image.width = image.height = 4;
  image.channels = {"R", "G", "B"};
  image.planes.resize(3);
  for (size_t i = 0; i < test_map().size(); ++i) image.planes[i % 3].push_back(test_map()[i]);
  impl::write_pfm(map, impl::source_of(image), {});
  for (const bool is_left_handed : {false, true}) {
    Scene scene;
    if (is_left_handed) scene.set_camera(view_of_pbrt());
    add_floor(scene);
    add_lights(scene);
    Settings settings = quick_settings();
    settings.environment = map;
    const Planes expected = rendered(scene, settings);
    Scene by_pixels = scene;
    by_pixels.set_environment(map_pixels());
    EXPECT_EQ(by_pixels.lights().size(), 2u) << "the sky is replaced";
    EXPECT_EQ(rendered(by_pixels), expected);
    scene.load_environment(map);
    EXPECT_EQ(rendered(scene), expected);
  }
}

TEST_F(SceneContents, CamerasHaveTheBitsOfAFile) {
  struct CameraCase {
    std::string text;
    std::function<void(Camera&)> change;
  };
  const std::vector<CameraCase> cameras{
      {R"("perspective" "float fov" 50 "float lensradius" 0.2 "float focaldistance" 4)",
       [](Camera& camera) { camera.fov = 50, camera.lens_radius = 0.2, camera.focal_distance = 4; }},
      {R"("perspective" "float fov" 50 "float screenwindow" [-0.5 1 -0.5 0.8] "float frameaspectratio" 1.5)",
       [](Camera& camera) {
         camera.fov = 50;
         camera.screen_window = {{-0.5, 1, -0.5, 0.8}};
         camera.frame_aspect_ratio = 1.5;
       }},
      {R"("orthographic" "float screenwindow" [-2 2 -1.5 1.5])",
       [](Camera& camera) {
         camera.kind = CameraKind::orthographic;
         camera.screen_window = {{-2, 2, -1.5, 1.5}};
       }},
      {R"("spherical" "string mapping" "equirectangular")",
       [](Camera& camera) { camera.kind = CameraKind::equirectangular; }},
      {R"("spherical")", [](Camera& camera) { camera.kind = CameraKind::equal_area; }},
      {R"("perspective" "float fov" 50 "float shutteropen" 0.25 "float shutterclose" 0.5)",
       [](Camera& camera) { camera.fov = 50, camera.shutter_open = 0.25, camera.shutter_close = 0.5; }}};
  for (const CameraCase& each : cameras) {
    const std::string text = "LookAt 0 1 -4  0 0 0  0 1 0 Camera " + each.text + "\nWorldBegin\n" + pbrt_lights +
                             pbrt_floor +
                             "ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All Shape \"sphere\"\n";
    Scene scene;
    Camera camera = view_of_pbrt();
    each.change(camera);
    scene.set_camera(camera);
    add_lights(scene);
    add_floor(scene);
    scene.add(shape_at({Sphere{}}, {Transform(), moved(0.5, 0, 0)}));
    // pbrt's film records for as long as the shutter is open.
    Film film = scene.film();
    film.exposure = camera.shutter_close - camera.shutter_open;
    scene.set_film(film);
    const Planes expected = rendered_text(text);
    EXPECT_EQ(rendered(scene), expected) << each.text;
    Scene read = Scene::load(folder_.file("scene.pbrt"));
    read.set_camera(read.camera());
    EXPECT_EQ(rendered(read), expected) << each.text;
  }
}

TEST_F(SceneContents, FilmFilterAndDefaultsHaveTheBitsOfAFile) {
  const std::string text = std::string(pbrt_view) +
                           R"(Film "rgb" "integer xresolution" 18 "integer yresolution" 12 "float exposuretime" 0.5
                              "integer pixelbounds" [2 15 1 11]
                              PixelFilter "mitchell" "float xradius" 1.8 "float B" 0.4
                              Sampler "independent" "integer pixelsamples" 3 "integer seed" 9
                              Integrator "path" "integer maxdepth" 2
                              WorldBegin )" +
                           pbrt_lights + pbrt_floor + "Shape \"sphere\"\n";
  Scene scene;
  scene.set_camera(view_of_pbrt());
  add_lights(scene);
  add_floor(scene);
  scene.add(Shape{Sphere{}});
  scene.set_film({.width = 18, .height = 12, .pixel_bounds = {{2, 15, 1, 11}}, .exposure = 0.5});
  scene.set_pixel_filter({.kind = FilterKind::mitchell, .x_radius = 1.8, .y_radius = 2, .b = 0.4});
  scene.set_render_defaults(
      {.samples_per_pixel = 3, .seed = 9, .max_depth = 2, .sampler = Sampler::independent, .quality = ""});
  Settings settings;
  settings.backend = "serial";
  const Planes expected = rendered_text(text, settings);
  EXPECT_EQ(expected.at(0).size(), 13u * 10);
  EXPECT_EQ(rendered(scene, settings), expected);
  Scene read = Scene::load(folder_.file("scene.pbrt"));
  read.set_film(read.film());
  read.set_pixel_filter(read.pixel_filter());
  read.set_render_defaults(read.render_defaults());
  EXPECT_EQ(rendered(read, settings), expected);
}

/// Settings that place the camera and change lights act on scenes in memory as on files.
TEST_F(SceneContents, SettingsAreFollowed) {
  const std::string text = std::string(pbrt_view) + "WorldBegin\n" + pbrt_lights + pbrt_floor + "Shape \"sphere\"\n";
  Scene scene;
  scene.set_camera(view_of_pbrt());
  add_lights(scene);
  add_floor(scene);
  scene.add(Shape{Sphere{}});
  scene.set_up({0, 1, 0});
  const auto check = [&](const Settings& settings) {
    EXPECT_EQ(rendered(scene, settings), rendered_text(text, settings));
  };
  Settings settings = quick_settings();
  settings.look_at = {1, 2, -3, 0, 0, 0};
  settings.fov = 55;
  check(settings);
  settings = quick_settings();
  settings.orbit = {30, 20};
  check(settings);
  settings.light_scale = 2;
  settings.environment_strength = 0.5;
  settings.filter = "box";
  check(settings);
  settings = quick_settings();
  settings.precision = "double";
  settings.aovs = {"normal", "object", "material"};
  check(settings);
}

/// A mesh alone is shown as its file is: with the same camera, light and quality.
TEST_F(SceneContents, AMeshAloneIsShownAsItsFile) {
  const std::string ply = folder_.write_text(
      "mesh.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 3\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  Scene scene;
  scene.add(Shape{scene.add(MeshArrays{.positions = std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2},
                                       .indices = std::vector<uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3}})});
  Settings settings = quick_settings();
  settings.max_depth = 5;
  for (const auto& [width, height] : {std::pair(20, 14), std::pair(10, 20)}) {
    settings.width = width;
    settings.height = height;
    EXPECT_EQ(rendered(scene, settings), render(ply, settings).planes);
    EXPECT_EQ(rendered(Scene::load(ply), settings), render(ply, settings).planes);
  }
  settings.samples_per_pixel = 0;
  settings.denoiser = "none";
  EXPECT_EQ(render(scene, settings).quality, render(ply, settings).quality);
  scene.set_environment(Colour(0));
  for (const std::vector<float>& plane : rendered(scene))
    for (const float value : plane) EXPECT_EQ(value, 0);
}

}  // namespace

}  // namespace alhazen::test
