// What is known of a scene and how it changes: handles, names, copies, removal and revisions.

#include <set>
#include <unordered_set>

#include "api/scene_state.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

using SceneChanges = SceneTest;

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
