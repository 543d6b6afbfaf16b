// What is known of a scene and how it changes: handles, names, copies, removal, revisions, and errors.

#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

#include "api/scene_state.h"
#include "images/image.h"
#include "scene_support.h"
#include "support/random.h"

namespace alhazen::test {

namespace {

using SceneChanges = SceneTest;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

/// A scene with one or more parts of each kind.
struct Sample {
  Scene scene;
  MeshId mesh;
  ImageId image;
  TextureId texture;
  MaterialId clay, glass;
  ShapeId floor, ball, part;
  GroupId group;
  InstanceId instance;
  LightId lamp, sky;

  Sample() {
    scene.set_camera(view_of_pbrt());
    clay = scene.add(Material(Diffuse{.reflectance = {0.8, 0.4, 0.2}}, "clay"));
    glass = scene.add(Material(Dielectric{}, "glass"));
    mesh = scene.add(MeshArrays{.positions = std::span<const float>(floor_positions),
                                .indices = floor_indices,
                                .uvs = std::span<const float>(floor_uvs),
                                .name = "plane"});
    image = scene.add(
        Pixels{.width = 2, .height = 1, .channels = 1, .bytes = std::vector<uint8_t>{10, 200}, .name = "grey"});
    texture = scene.add(Texture(ImageTexture{.image = image}, "paint"));
    floor = scene.add(Shape{.geometry = mesh, .material = clay, .name = "ground"});
    ball = scene.add(Shape{Sphere{0.5}, glass});
    group = scene.add_group("pair");
    part = scene.add(Shape{Sphere{0.2}, clay}, group);
    instance = scene.add(Instance{.group = group, .transform = Transform::translate({1, 0, 0})});
    lamp = scene.add(Light(PointLight{{10, 9, 8}, {1, 3, -2}}, "lamp"));
    sky = scene.set_environment(Colour(0.3));
  }
};

TEST_F(SceneChanges, ListsAndNames) {
  Sample s;
  EXPECT_EQ(s.scene.meshes(), std::vector{s.mesh});
  EXPECT_EQ(s.scene.images(), std::vector{s.image});
  EXPECT_EQ(s.scene.textures(), std::vector{s.texture}) << "not the colours of materials";
  EXPECT_EQ(s.scene.materials(), (std::vector{s.clay, s.glass}));
  EXPECT_EQ(s.scene.shapes(), (std::vector{s.floor, s.ball, s.part}));
  EXPECT_EQ(s.scene.groups(), std::vector{s.group});
  EXPECT_EQ(s.scene.instances(), std::vector{s.instance});
  EXPECT_EQ(s.scene.lights(), (std::vector{s.lamp, s.sky}));
  EXPECT_EQ(s.scene.find_material("clay"), s.clay);
  EXPECT_EQ(s.scene.name(s.clay), "clay");
  EXPECT_FALSE(s.scene.find_material("brass"));
  EXPECT_EQ(s.scene.find_texture("paint"), s.texture);
  EXPECT_EQ(s.scene.find_mesh("plane"), s.mesh);
  EXPECT_EQ(s.scene.find_image("grey"), s.image);
  EXPECT_EQ(s.scene.find_group("pair"), s.group);
  EXPECT_EQ(s.scene.find_shapes("ground"), std::vector{s.floor});
  EXPECT_EQ(s.scene.name(s.ball), "sphere.1");
  EXPECT_EQ(s.scene.find_shapes("sphere.1"), std::vector{s.ball});
  EXPECT_EQ(s.scene.name(s.instance), "pair.1");
  EXPECT_EQ(s.scene.find_instances("pair.1"), std::vector{s.instance});
  EXPECT_EQ(s.scene.find_lights("lamp"), std::vector{s.lamp});
  EXPECT_EQ(s.scene.name(s.sky), "environment");
  EXPECT_TRUE(s.scene.find_lights("moon").empty());
  EXPECT_EQ(s.scene.group_of(s.part), s.group);
  EXPECT_FALSE(s.scene.group_of(s.ball));
  const MaterialId unnamed = s.scene.add(Diffuse{});
  EXPECT_EQ(s.scene.name(unnamed), "material.3");
  EXPECT_EQ(s.scene.find_material("material.3"), unnamed);
  const Box box = s.scene.bounds();
  EXPECT_EQ(box.low, (Vec3{-3, -1, -3}));
  EXPECT_EQ(box.high, (Vec3{3, 0.5, 3}));
  EXPECT_TRUE(Scene().bounds().is_empty());
  std::unordered_set<MaterialId> set{s.clay, s.glass, s.clay};
  EXPECT_EQ(set.size(), 2u);
}

TEST_F(SceneChanges, PartsOfAFileAreFoundByName) {
  Scene scene = Scene::load(folder_.write_text(
      "named.pbrt", std::string(pbrt_view) +
                        "WorldBegin MakeNamedMaterial \"clay\" \"string type\" \"diffuse\" "
                        "NamedMaterial \"clay\" Shape \"sphere\" "
                        "Texture \"t\" \"spectrum\" \"checkerboard\" "
                        "LightSource \"point\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 0 0 0 0 0 0]"));
  const MaterialId clay = scene.find_material("clay");
  ASSERT_TRUE(clay);
  EXPECT_TRUE(scene.find_texture("t"));
  EXPECT_EQ(scene.find_lights(scene.name(scene.lights().at(0))), scene.lights());
  ASSERT_EQ(scene.find_shapes("sphere.1").size(), 1u);
  EXPECT_EQ(scene.shape(scene.find_shapes("sphere.1")[0]).material, clay);
  EXPECT_EQ(scene.file(), folder_.file("named.pbrt"));
  Material material = scene.material(clay);
  EXPECT_EQ(std::get<Diffuse>(material.bsdf).reflectance, ColourInput(0.5));
  std::get<Diffuse>(material.bsdf).reflectance = {0.9, 0.1, 0.1};
  scene.set(clay, material);
  EXPECT_EQ(std::get<Diffuse>(scene.material(clay).bsdf).reflectance, ColourInput(0.9, 0.1, 0.1));
}

TEST_F(SceneChanges, ErrorsAndWarningsOfFilesHaveTheirPlace) {
  const std::string bad = folder_.write_text("bad.pbrt", "WorldBegin\n  Shape \"blob\"\n");
  try {
    Scene::load(bad);
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("bad.pbrt:2:3"), std::string::npos) << error.what();
  }
  EXPECT_THROW(Scene::load(folder_.file("missing.ply")), InputError);
  LoadOptions options;
  options.variant = "red";
  EXPECT_THROW(Scene::load(folder_.write_text("good.pbrt", "WorldBegin"), options), InputError);
  const Scene warned = Scene::load(folder_.file("good.pbrt"));
  ASSERT_EQ(warned.warnings().size(), 1u);
  EXPECT_NE(warned.warnings()[0].message.find("no shapes"), std::string::npos);
  Settings settings = quick_settings();
  settings.camera = "1";
  EXPECT_NE(error_of([&] { render(warned, settings); }).find("'camera'"), std::string::npos);
}

TEST_F(SceneChanges, CopiesAreIndependent) {
  Sample s;
  const Planes before = rendered(s.scene);
  Scene copy = s.scene;
  copy.set(s.clay, Diffuse{.reflectance = {0.1, 0.1, 0.9}});  // handles from before the copy are its own as well
  copy.set_transform(s.ball, Transform::translate({0, 0.4, 0}));
  const std::vector<float> other_positions(floor_positions.begin(), floor_positions.end());
  copy.set_positions(s.mesh, std::vector<double>{-2, -1, -3, -3, -1, 3, 3, -1, 3, 3, -1, -3});
  EXPECT_EQ(rendered(s.scene), before);
  EXPECT_NE(rendered(copy), before);
  const MaterialId of_copy = copy.add(Diffuse{});
  const MaterialId of_original = s.scene.add(Conductor{});
  EXPECT_NE(error_of([&] { s.scene.material(of_copy); }).find("another scene"), std::string::npos);
  EXPECT_NE(error_of([&] { copy.material(of_original); }).find("another scene"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<Diffuse>(copy.material(of_copy).bsdf));
  Scene moved = std::move(copy);
  EXPECT_TRUE(std::holds_alternative<Diffuse>(moved.material(of_copy).bsdf));
  EXPECT_NE(error_of([&] { copy.materials(); }).find("moved"), std::string::npos);  // NOLINT: on purpose
  copy = s.scene;
  copy.set(s.clay, Diffuse{});
  EXPECT_EQ(rendered(s.scene), before);
}

TEST_F(SceneChanges, HandlesOfOthersAreRefused) {
  Sample s, t;
  const auto check = [](const auto& work, const char* argument) {
    const std::string message = error_of(work);
    EXPECT_EQ(message.find("'" + std::string(argument) + "'"), 0u) << message;
  };
  check([&] { s.scene.material(t.clay); }, "material");
  check([&] { s.scene.mesh(t.mesh); }, "mesh");
  check([&] { s.scene.image(t.image); }, "image");
  check([&] { s.scene.texture(t.texture); }, "texture");
  check([&] { s.scene.shape(t.ball); }, "shape");
  check([&] { s.scene.instance(t.instance); }, "instance");
  check([&] { s.scene.light(t.lamp); }, "light");
  check([&] { s.scene.add(Instance{.group = t.group}); }, "group");
  check([&] { s.scene.add(Instance{}); }, "group");
  check([&] { s.scene.add(Shape{t.mesh}); }, "geometry");
  check([&] { s.scene.add(Shape{MeshId{}}); }, "geometry");
  check([&] { s.scene.add(Shape{Sphere{}, t.clay}); }, "material");
  check([&] { s.scene.add(Shape{Sphere{}}, t.group); }, "group");
  check([&] { s.scene.add(Diffuse{.reflectance = t.texture}); }, "reflectance");
  check([&] { s.scene.add(ImageTexture{}); }, "image");
  check([&] { s.scene.add(ImageTexture{.image = t.image}); }, "image");
  check([&] { s.scene.add(Mix{}); }, "materials");
  check([&] { s.scene.set(MaterialId{}, Diffuse{}); }, "material");
  check([&] { s.scene.remove(LightId{}); }, "light");
}

TEST_F(SceneChanges, PartsCanBeRemoved) {
  Sample s;
  const Planes whole = rendered(s.scene);
  const ShapeId extra = s.scene.add(Shape{Cylinder{}, s.clay});
  const LightId flash = s.scene.add(PointLight{50, {0, 1, -3}});
  EXPECT_NE(rendered(s.scene), whole);
  s.scene.remove(flash);
  s.scene.remove(extra);
  EXPECT_EQ(rendered(s.scene), whole);
  s.scene.remove(s.floor);
  EXPECT_EQ(std::get<Sphere>(s.scene.shape(s.ball).geometry).radius, 0.5) << "other handles stay";
  EXPECT_NE(error_of([&] { s.scene.shape(s.floor); }).find("removed"), std::string::npos);
  s.scene.remove(s.lamp);
  EXPECT_EQ(std::get<ConstantInfiniteLight>(s.scene.light(s.sky).kind).radiance, Colour(0.3));
  EXPECT_THROW(s.scene.light(s.lamp), InputError);
  s.scene.remove(s.instance);
  EXPECT_TRUE(s.scene.instances().empty());
  EXPECT_THROW(s.scene.set_transform(s.instance, Transform()), InputError);
  EXPECT_EQ(s.scene.shapes(), (std::vector{s.ball, s.part}));
}

TEST_F(SceneChanges, RevisionsCountWhatChanges) {
  Sample s;
  using Counter = uint64_t impl::SceneRevisions::*;
  const auto expect = [&](const auto& change, const std::set<int>& counters, const char* what) {
    const std::array<Counter, 8> all{&impl::SceneRevisions::geometry,  &impl::SceneRevisions::transforms,
                                     &impl::SceneRevisions::materials, &impl::SceneRevisions::images,
                                     &impl::SceneRevisions::lights,    &impl::SceneRevisions::environment,
                                     &impl::SceneRevisions::camera,    &impl::SceneRevisions::film};
    const impl::SceneRevisions before = s.scene.state().revisions;
    change();
    for (int i = 0; i < 8; ++i) {
      const Counter counter = all[static_cast<size_t>(i)];
      EXPECT_EQ(s.scene.state().revisions.*counter != before.*counter, counters.contains(i)) << what << ' ' << i;
    }
  };
  expect([&] { s.scene.set_positions(s.mesh, std::span<const float>(floor_positions)); }, {0}, "positions");
  expect([&] { s.scene.set_transform(s.ball, Transform::scale(2)); }, {1}, "transform");
  expect([&] { s.scene.set_transform(s.ball, Transform::scale(2)); }, {}, "the same transform");
  expect([&] { s.scene.set_transform(s.instance, Transform::scale(2)); }, {1}, "instance");
  expect([&] { s.scene.set_material(s.ball, s.clay); }, {0}, "material of a shape");
  expect([&] { s.scene.set(s.ball, s.scene.shape(s.ball)); }, {}, "the same shape");
  expect([&] { s.scene.set(s.clay, Conductor{}); }, {2}, "material");
  expect([&] { s.scene.set(s.texture, FbmTexture{}); }, {2}, "texture");
  expect([&] { s.scene.set_image(s.image, s.scene.image(s.image)); }, {3}, "image");
  expect([&] { s.scene.set(s.lamp, PointLight{}); }, {4}, "light");
  expect([&] { s.scene.set(s.sky, ConstantInfiniteLight{}); }, {5}, "sky");
  expect([&] { s.scene.set(s.lamp, ConstantInfiniteLight{}); }, {4, 5}, "a light that becomes a sky");
  expect([&] { s.scene.look_at({0, 1, 5}, {0, 0, 0}); }, {6}, "camera");
  expect([&] { s.scene.set_film({.width = 10}); }, {7}, "film");
  expect([&] { s.scene.set_render_defaults({}); }, {7}, "defaults");
  Shape lamp = s.scene.shape(s.ball);
  lamp.emission = Emission{};
  expect([&] { s.scene.set(s.ball, lamp); }, {0, 4}, "a shape that becomes a light");
  lamp.emission->radiance = 2;
  expect([&] { s.scene.set(s.ball, lamp); }, {4}, "its radiance");
  expect([&] { EXPECT_THROW(s.scene.set(s.clay, Diffuse{.reflectance = 2.0}), InputError); }, {}, "an error");
}

/// The colour of a material is changed in place: textures do not pile up.
TEST_F(SceneChanges, ChangingAColourOftenKeepsItsSize) {
  Sample s;
  s.scene.set(s.clay, Principled{.metallic = 0.5, .roughness = 0.3});
  const size_t textures = s.scene.state().description.textures.size();
  for (int i = 0; i < 100; ++i) {
    s.scene.set(s.clay, Principled{.base_colour = {0.01 * i, 0.2, 0.3}, .metallic = 0.004 * i, .roughness = 0.3});
    s.scene.set(s.clay, Diffuse{.reflectance = 0.003 * i});
    s.scene.set(s.clay, CoatedDiffuse{.reflectance = s.texture, .roughness = {0.1, 0.003 * i + 0.2}});
  }
  EXPECT_LE(s.scene.state().description.textures.size(), textures + 3);
  EXPECT_EQ(s.scene.textures(), std::vector{s.texture});
}

TEST_F(SceneChanges, PrincipledIsDescribedInFull) {
  Scene scene;
  const TextureId noise = scene.add(FbmTexture{});
  Principled all{.base_colour = {0.1, 0.2, 0.3},
                 .metallic = 0.1,
                 .roughness = noise,
                 .specular = 0.7,
                 .specular_colour = {0.5, 0.6, 0.7},
                 .ior = 1.4,
                 .transmission = 0.2,
                 .thin = true,
                 .attenuation_colour = {0.9, 0.8, 0.7},
                 .attenuation_distance = 3,
                 .dispersion = 0.2,
                 .clearcoat = 0.3,
                 .clearcoat_roughness = 0.4,
                 .clearcoat_normal_map = noise,
                 .clearcoat_normal_scale = 0.5,
                 .sheen_colour = {0.1, 0.1, 0.2},
                 .sheen_roughness = 0.6,
                 .iridescence = 0.7,
                 .iridescence_thickness = 300,
                 .iridescence_ior = 1.2,
                 .anisotropy = 0.8,
                 .anisotropy_rotation = 30,
                 .anisotropy_direction = noise,
                 .diffuse_transmission = 0.25,
                 .diffuse_transmission_colour = {0.3, 0.2, 0.1}};
  const MaterialId id = scene.add(all);
  const auto p = std::get<Principled>(scene.material(id).bsdf);
  EXPECT_EQ(p.base_colour, all.base_colour);
  EXPECT_EQ(p.metallic, all.metallic);
  EXPECT_EQ(p.roughness, all.roughness);
  EXPECT_EQ(p.specular, all.specular);
  EXPECT_EQ(p.specular_colour, all.specular_colour);
  EXPECT_EQ(p.ior, all.ior);
  EXPECT_EQ(p.transmission, all.transmission);
  EXPECT_EQ(p.thin, all.thin);
  EXPECT_EQ(p.attenuation_colour, all.attenuation_colour);
  EXPECT_EQ(p.attenuation_distance, all.attenuation_distance);
  EXPECT_EQ(p.dispersion, all.dispersion);
  EXPECT_EQ(p.clearcoat, all.clearcoat);
  EXPECT_EQ(p.clearcoat_roughness, all.clearcoat_roughness);
  EXPECT_EQ(p.clearcoat_normal_map, all.clearcoat_normal_map);
  EXPECT_EQ(p.clearcoat_normal_scale, all.clearcoat_normal_scale);
  EXPECT_EQ(p.sheen_colour, all.sheen_colour);
  EXPECT_EQ(p.sheen_roughness, all.sheen_roughness);
  EXPECT_EQ(p.iridescence, all.iridescence);
  EXPECT_EQ(p.iridescence_thickness, all.iridescence_thickness);
  EXPECT_EQ(p.iridescence_ior, all.iridescence_ior);
  EXPECT_EQ(p.anisotropy, all.anisotropy);
  EXPECT_EQ(p.anisotropy_rotation, all.anisotropy_rotation);
  EXPECT_EQ(p.anisotropy_direction, all.anisotropy_direction);
  EXPECT_EQ(p.diffuse_transmission, all.diffuse_transmission);
  EXPECT_EQ(p.diffuse_transmission_colour, all.diffuse_transmission_colour);
  // In the description: what is at its default there is absent.
  const impl::Principled& inside =
      scene.state()
          .description.materials[impl::HandleAccess::index(scene.add(Principled{.base_colour = 1.0}))]
          .principled;
  EXPECT_EQ(inside.base_colour, impl::no_index);
  EXPECT_EQ(inside.sheen_colour, impl::no_index);
  EXPECT_NE(inside.roughness, impl::no_index);
  EXPECT_FALSE(inside.thin);
}

TEST_F(SceneChanges, FilesKeepWhatIsSetAsItWasRead) {
  for (const char* file : {"cornell.pbrt", "cornell-glass.pbrt", "lamp.xml", "studio.glb", "panel.pbrt", "mesh.pbrt"}) {
    const std::string path = std::string(ALHAZEN_SOURCE_DIR) + "/scenes/" + file;
    Settings settings = quick_settings();
    settings.samples_per_pixel = 1;
    const Planes expected = render(path, settings).planes;
    Scene scene = Scene::load(path);
    EXPECT_EQ(rendered(scene, settings), expected) << file;
    for (const MeshId mesh : scene.meshes()) {
      const MeshView view = scene.mesh(mesh);
      scene.set_mesh(mesh, {.positions = view.positions,
                            .indices = view.indices,
                            .normals = view.normals,
                            .uvs = view.uvs,
                            .second_uvs = view.second_uvs,
                            .colours = view.colours,
                            .tangents = view.tangents,
                            .name = scene.name(mesh)});
    }
    for (const ImageId image : scene.images()) scene.set_image(image, scene.image(image));
    for (const TextureId texture : scene.textures()) scene.set(texture, scene.texture(texture));
    for (const MaterialId material : scene.materials()) scene.set(material, scene.material(material));
    for (const ShapeId shape : scene.shapes()) scene.set(shape, scene.shape(shape));
    for (const InstanceId instance : scene.instances()) scene.set(instance, scene.instance(instance));
    for (const LightId light : scene.lights()) scene.set(light, scene.light(light));
    scene.set_film(scene.film());
    scene.set_pixel_filter(scene.pixel_filter());
    scene.set_render_defaults(scene.render_defaults());
    scene.set_camera(scene.camera());
    EXPECT_EQ(rendered(scene, settings), expected) << file;
    // Every material anew, as it would be made in memory.
    std::vector<std::pair<MaterialId, MaterialId>> anew;
    for (const MaterialId material : scene.materials())
      anew.emplace_back(material, scene.add(scene.material(material)));
    for (const auto& [old, fresh] : anew)
      for (const ShapeId shape : scene.shapes())
        if (scene.shape(shape).material == old) scene.set_material(shape, fresh);
    EXPECT_EQ(rendered(scene, settings), expected) << file;
  }
}

TEST_F(SceneChanges, WrongArgumentsAreNamed) {
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

TEST_F(SceneChanges, NothingContainsItself) {
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
TEST_F(SceneChanges, RandomArgumentsNeverCrash) {
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

/// Where the camera is placed, as the settings of a render do it.
TEST_F(SceneChanges, CamerasArePlacedAsBySettings) {
  for (const bool is_left_handed : {false, true}) {
    Scene scene;
    if (is_left_handed) scene.set_camera(view_of_pbrt());
    add_floor(scene);
    scene.add(Shape{Sphere{}});
    add_lights(scene);
    Settings settings = quick_settings();
    scene.set_film({.width = settings.width, .height = settings.height});
    Scene other = scene;
    other.look_at({1, 2, 5}, {0, 0, 0});
    settings.look_at = {1, 2, 5, 0, 0, 0};
    EXPECT_EQ(rendered(other), rendered(scene, settings));
    other = scene;
    other.orbit(40, 10);
    settings = quick_settings();
    settings.orbit = {40, 10};
    EXPECT_EQ(rendered(other), rendered(scene, settings));
    other = scene;
    other.fit();
    settings = quick_settings();
    settings.fit = true;
    EXPECT_EQ(rendered(other), rendered(scene, settings));
  }
  // The two ways to say it, and which way x goes.
  Scene scene;
  scene.add(Shape{Sphere{}});
  scene.look_at({0, 0, 5}, {0, 0, 0});
  Scene by_transform = scene;
  Camera camera = scene.camera();
  camera.transform = Transform::look_at({0, 0, 5}, {0, 0, 0});
  by_transform.set_camera(camera);
  EXPECT_EQ(rendered(scene), rendered(by_transform));
  EXPECT_EQ(Transform::look_at({0, 0, 5}, {0, 0, 0}).direction({1, 0, 0}), (Vec3{1, 0, 0}));
  EXPECT_EQ(Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Handedness::left).direction({1, 0, 0}),
            (Vec3{-1, 0, 0}));
  // With z upwards the default view has it so.
  Scene upright;
  upright.set_up({0, 0, 1});
  upright.add(Shape{Sphere{}});
  const Vec3 up = upright.camera().transform.start.direction({0, 1, 0});
  EXPECT_GT(up.z, 0.9);
}

TEST_F(SceneChanges, TransformsComposeAndInvert) {
  const Transform a = Transform::translate({1, 2, 3}) * Transform::rotate(90, {0, 0, 1});
  const Vec3 p = a.point({1, 0, 0});
  EXPECT_NEAR(p.x, 1, 1e-12);
  EXPECT_NEAR(p.y, 3, 1e-12);
  EXPECT_NEAR(p.z, 3, 1e-12);
  const Vec3 back = a.inverse().point(p);
  EXPECT_NEAR(back.x, 1, 1e-12);
  EXPECT_NEAR(back.y, 0, 1e-12);
  EXPECT_EQ(Transform::from_matrix(a.matrix()), a);
  EXPECT_EQ(Transform::from_matrix(std::vector<double>{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7}),
            Transform::translate({5, 6, 7}));
}

}  // namespace

}  // namespace alhazen::test
