// A scene of which parts are compiled again has the same arrays as one that is compiled from the start.

#include "compile/update_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "scene/outline.h"
#include "support/compiled_scenes.h"

namespace alhazen::impl::test {

namespace {

constexpr const char* scene_text = R"(
LookAt 0 2 -6  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "point" "rgb I" [10 9 8] "point3 from" [1 3 -2]
LightSource "distant" "rgb L" [1 2 3]
LightSource "spot" "rgb I" [4 4 4] "point3 from" [0 5 0] "point3 to" [0 0 0]
LightSource "infinite" "rgb L" [0.1 0.2 0.3]
Texture "checks" "spectrum" "checkerboard" "float uscale" 4
Shape "trianglemesh" "point3 P" [-3 -1 -3  -3 -1 3  3 -1 3  3 -1 -3] "integer indices" [0 1 2 0 2 3]
Shape "sphere" "float radius" 0.5
AttributeBegin
  Translate 1 0.5 0
  Shape "disk" "float radius" 0.4
  Shape "cylinder" "float radius" 0.2
AttributeEnd
AttributeBegin
  Material "diffuse" "texture reflectance" "checks"
  Translate -1 0 1
  Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0  0 0 1] "integer indices" [0 1 2 0 2 3 0 3 1 1 3 2]
    "normal N" [0 0 -1  1 0 0  0 1 0  0 0 1] "point2 uv" [0 0  1 0  0 1  1 1]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [3 2 1]
  Translate 0 2 0
  Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  1 0 1  0 0 1] "integer indices" [0 1 2 0 2 3]
  Translate 2 0 0
  Shape "sphere" "float radius" 0.25
AttributeEnd
ObjectBegin "pair"
  Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0  0 0 1] "integer indices" [0 1 2 0 2 3 0 3 1 1 3 2]
  Shape "trianglemesh" "point3 P" [2 0 0  3 0 0  2 1 0] "integer indices" [0 1 2]
ObjectEnd
ObjectBegin "lamp"
  Shape "trianglemesh" "point3 P" [0 0 0  0.3 0 0  0 0.3 0] "integer indices" [0 1 2]
  AreaLightSource "diffuse" "rgb L" [1 2 1]
  Shape "sphere" "float radius" 0.1
ObjectEnd
AttributeBegin Translate -2 0 0 ObjectInstance "pair" AttributeEnd
AttributeBegin Translate 0 0 2 Rotate 30 0 1 0 ObjectInstance "pair" AttributeEnd
AttributeBegin Translate 2 1 2 Scale 0.5 1 2 ObjectInstance "pair" AttributeEnd
AttributeBegin Translate -2 2 0 ObjectInstance "lamp" AttributeEnd
AttributeBegin Translate 2 2 0 ObjectInstance "lamp" AttributeEnd
ActiveTransform EndTime Translate 0 0.5 0 ActiveTransform All
ObjectBegin "moving"
  Shape "trianglemesh" "point3 P" [0 0 0  0.2 0 0  0 0.2 0] "integer indices" [0 1 2]
ObjectEnd
ObjectInstance "moving"
)";

ImageTexels map_of(int size, float peak) {
  ImageTexels map;
  map.width = map.height = size;
  map.srgb = false;
  for (int i = 0; i < 3 * size * size; ++i) map.floats.push_back(0.1f + (i % 7 == 0 ? peak : 0.0f));
  return map;
}

Light environment_light(uint32_t map) {
  Light light;
  light.kind = LightKind::environment;
  light.radiance = {1, 1, 1};
  light.environment = map;
  return light;
}

Scene whole_scene() {
  Scene scene = described_scene(scene_text);
  scene.environments.push_back(map_of(32, 5));
  scene.lights.push_back(environment_light(0));
  scene.light_images.push_back(map_of(4, 2));
  Light goniometric;
  goniometric.kind = LightKind::goniometric;
  goniometric.radiance = {2, 2, 2};
  goniometric.position = {0, 4, 1};
  goniometric.image = 0;
  scene.lights.push_back(goniometric);
  return scene;
}

template <class Real>
void expect_same_arrays(const CompiledScene<Real>& a, const CompiledScene<Real>& b) {
#define ALHAZEN_ARRAY(type, name)                                                                     \
  ASSERT_EQ(a.view.name##_count, b.view.name##_count) << #name;                                       \
  if (a.view.name##_count > 0) {                                                                      \
    EXPECT_EQ(std::memcmp(a.view.name, b.view.name, a.view.name##_count * sizeof(type)), 0) << #name; \
  }
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  EXPECT_EQ(a.view.background, b.view.background);
  EXPECT_EQ(a.view.infinite_irradiance, b.view.infinite_irradiance);
  EXPECT_EQ(a.view.bounds.low, b.view.bounds.low);
  EXPECT_EQ(a.view.bounds.high, b.view.bounds.high);
  EXPECT_EQ(a.view.has_narrow_triangles, b.view.has_narrow_triangles);
  EXPECT_EQ(a.statistics.lights, b.statistics.lights);
  EXPECT_EQ(a.statistics.nodes, b.statistics.nodes);
  EXPECT_EQ(a.statistics.tree_bytes, b.statistics.tree_bytes);
}

/// A scene that is compiled once and changes.
template <class Real>
class ChangingScene {
 public:
  ChangingScene(Scene scene, const CompileOptions& options) : scene_(std::move(scene)), options_(options) {
    flat_ = compile_scene<Real>(Scene(scene_), options_, diagnostics_, parts_);
  }

  /// Changes the scene and expects what compiling it from the start gives; returns false if it had to be.
  bool change(const SceneChanges& changes, const std::function<void(Scene&)>& work) {
    work(scene_);
    Scene outline = outline_of(scene_, changes.light_maps);
    if (!update_scene(changes, scene_.meshes, std::move(outline), flat_, parts_)) return false;
    EXPECT_TRUE(find_lost_light_again(options_.path_segments, flat_, parts_));
    expect_same();
    return true;
  }

  void expect_same() const {
    Diagnostics diagnostics;
    BuiltParts<Real> parts;
    const CompiledScene<Real> fresh = compile_scene<Real>(Scene(scene_), options_, diagnostics, parts);
    expect_same_arrays(flat_, fresh);
    EXPECT_EQ(parts_.measures, parts.measures);
    ASSERT_EQ(parts_.search_tree.size(), parts.search_tree.size());
    if (!parts.search_tree.empty()) {
      EXPECT_EQ(std::memcmp(parts_.search_tree.data(), parts.search_tree.data(),
                            parts.search_tree.size() * sizeof(Bvh2Node<Real>)),
                0);
    }
    std::vector<std::string> lost, fresh_lost;
    for (const auto& warning : parts_.lost_light.warnings()) lost.push_back(warning.to_string());
    for (const auto& warning : parts.lost_light.warnings()) fresh_lost.push_back(warning.to_string());
    EXPECT_EQ(lost, fresh_lost);
  }

  const Scene& scene() const { return scene_; }
  const CompiledScene<Real>& flat() const { return flat_; }

 private:
  Scene scene_;
  CompileOptions options_;
  Diagnostics diagnostics_;
  CompiledScene<Real> flat_;
  BuiltParts<Real> parts_;
};

CompileOptions options_for(uint64_t max_copied,
                           BvhLayouts layouts = {BvhLayout::bvh2, BvhLayout::bvh8, BvhLayout::cwbvh}) {
  CompileOptions options;
  options.threads = 1;
  options.layouts = layouts;
  options.max_copied_triangles = max_copied;
  options.for_cameras = true;
  options.path_segments = 5;
  return options;
}

constexpr SceneChanges lights{.lights = true}, maps{.lights = true, .light_maps = true}, transforms{.transforms = true},
    all{.lights = true, .light_maps = true, .transforms = true};

MovingTransform moved(const MovingTransform& transform, const Transform& by) {
  return {by * transform.start, by * transform.end};
}

template <class Real>
class UpdateScene : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(UpdateScene, Reals);

TYPED_TEST(UpdateScene, ChangesLights) {
  for (const uint64_t max_copied : {uint64_t{0}, uint64_t{1} << 17}) {
    ChangingScene<TypeParam> scene(whole_scene(), options_for(max_copied));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[0].radiance = {1, 2, 30}; }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[0].position = {1, 20, 30}; }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[0].radiance = {}; })) << "one fewer";
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[0].radiance = {1, 1, 1}; })) << "one more";
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights.push_back(s.lights[0]); })) << "one more";
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights.erase(s.lights.begin()); }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[1].kind = LightKind::point; }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights.back().radiance = {3, 2, 1}; }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) {
      s.groups[0].shapes[5].emission->radiance = {9, 9, 9};
      s.groups[2].shapes[1].emission->radiance = {0.5, 9, 9};
    }));
    EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.groups[0].shapes[5].emission->two_sided = true; }));
    EXPECT_FALSE(scene.change(lights, [](Scene& s) { s.groups[0].shapes[5].emission->radiance = {}; })) << "no light";
  }
}

TYPED_TEST(UpdateScene, ChangesTheEnvironment) {
  ChangingScene<TypeParam> scene(whole_scene(), options_for(0));
  EXPECT_TRUE(scene.change(lights, [](Scene& s) {
    for (Light& light : s.lights)
      if (light.kind == LightKind::environment) light.radiance = {2, 1, 0.5};
  }));
  EXPECT_TRUE(scene.change(lights, [](Scene& s) {
    for (Light& light : s.lights)
      if (light.kind == LightKind::environment) light.axes = {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}};
  }));
  EXPECT_TRUE(scene.change(maps, [](Scene& s) { s.environments[0] = map_of(32, 50); })) << "of the same size";
  EXPECT_TRUE(scene.change(maps, [](Scene& s) { s.environments[0] = map_of(48, 3); })) << "of another size";
  EXPECT_TRUE(scene.change(lights, [](Scene& s) { s.lights[3].radiance = {7, 0, 7}; })) << "the constant one";
  EXPECT_TRUE(scene.change(maps, [](Scene& s) {
    s.environments.push_back(map_of(16, 4));
    s.lights.push_back(environment_light(1));
  }));
  EXPECT_TRUE(scene.change(maps, [](Scene& s) {
    std::erase_if(s.lights, [](const Light& light) { return light.kind == LightKind::environment; });
  }));
  EXPECT_TRUE(scene.change(maps, [](Scene& s) { s.lights.clear(); })) << "shapes alone";
}

TYPED_TEST(UpdateScene, MovesInstances) {
  for (const uint64_t max_copied : {uint64_t{0}, uint64_t{1} << 17})
    for (const BvhLayouts layouts :
         {BvhLayouts{BvhLayout::bvh2, BvhLayout::bvh8, BvhLayout::cwbvh}, BvhLayouts{BvhLayout::bvh8}, BvhLayouts{}}) {
      ChangingScene<TypeParam> scene(whole_scene(), options_for(max_copied, layouts));
      EXPECT_GT(scene.flat().view.instances_count, 0u);
      for (size_t i = 0; i < scene.scene().instances.size(); ++i)
        EXPECT_TRUE(scene.change(transforms, [i](Scene& s) {
          MovingTransform& transform = s.instances[i].world_from_group;
          transform = moved(transform, Transform::translate({0.3, 0.1, -0.2}) * Transform::rotate(20, {0, 1, 0}));
        })) << i;
      EXPECT_TRUE(scene.change(transforms, [](Scene& s) {
        double offset = 0;
        for (Instance& instance : s.instances)
          instance.world_from_group = moved(instance.world_from_group, Transform::translate({offset += 3, 0, 0}));
      })) << "all, so that the tree is another one";
      EXPECT_TRUE(scene.change(transforms, [](Scene& s) {
        s.instances[0].world_from_group.start = Transform::scale({-1, 1, 1});  // a mirror image
        s.instances[0].world_from_group.end = s.instances[0].world_from_group.start;
      }));
      EXPECT_TRUE(scene.change(all, [](Scene& s) {
        s.lights[0].radiance = {1, 1, 1};
        s.instances[3].world_from_group = moved(s.instances[3].world_from_group, Transform::translate({0, 1, 0}));
      }));
    }
}

TYPED_TEST(UpdateScene, MovesShapesOfTheWorld) {
  ChangingScene<TypeParam> scene(whole_scene(), options_for(0));
  for (size_t i = 0; i < scene.scene().groups[0].shapes.size(); ++i)
    EXPECT_TRUE(scene.change(transforms, [i](Scene& s) {
      MovingTransform& transform = s.groups[0].shapes[i].world_from_object;
      transform = moved(transform, Transform::translate({0.3, 0.1, -0.2}) * Transform::scale({-2, 2, 2}));
    })) << i;
  EXPECT_TRUE(scene.change(transforms, [](Scene& s) {
    for (Shape& shape : s.groups[0].shapes)
      shape.world_from_object = moved(shape.world_from_object, Transform::translate({5, 0, 1}));
  }));
}

TYPED_TEST(UpdateScene, SaysWhatItCannotDo) {
  const auto fails = [](const char* what, const std::function<void(Scene&)>& work, bool one_sided = false) {
    SCOPED_TRACE(what);
    Scene described = whole_scene();
    if (one_sided) described.materials.at(0).double_sided = false;
    ChangingScene<TypeParam> scene(std::move(described), options_for(0));
    EXPECT_FALSE(scene.change(all, work));
  };
  const Transform up = Transform::translate({0, 1, 0});
  fails("a group that moves and did not", [&](Scene& s) { s.instances[3].world_from_group.end = up; });
  fails("a shape of an object", [&](Scene& s) { s.groups[1].shapes[0].world_from_object = {up, up}; });
  fails("a shape that begins to move", [&](Scene& s) { s.groups[0].shapes[0].world_from_object.end = up; });
  fails("a sphere that begins to move", [&](Scene& s) { s.groups[0].shapes[1].world_from_object.end = up; });
  fails("triangles without area", [&](Scene& s) {
    const Transform tiny = Transform::scale({1e-200, 1e-200, 1e-200});
    s.groups[0].shapes[4].world_from_object = {tiny, tiny};
  });
  fails(
      "a one-sided shape",
      [&](Scene& s) {
        s.groups[0].shapes[4].world_from_object = {up, up};
      },
      true);
  fails("a map that is missing", [&](Scene& s) { s.environments[0].floats.clear(); });
}

/// The arrays change their sizes up and down, and are moved where they do not fit.
TYPED_TEST(UpdateScene, FollowsManyChanges) {
  ChangingScene<TypeParam> scene(whole_scene(), options_for(0, {BvhLayout::bvh8, BvhLayout::cwbvh}));
  std::mt19937 random(5);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto index = [&](size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(random); };
  const auto any_move = [&] {
    return Transform::translate({number(-3, 3), number(-1, 3), number(-3, 3)}) *
           Transform::rotate(number(0, 360), {number(-1, 1), 1, number(-1, 1)});
  };
  const auto change_any = [&](Scene& s) {
    switch (index(5)) {
      case 0:
        s.lights[index(4)].radiance = Vec3d{1, 2, 3} * static_cast<double>(index(3));
        break;
      case 1:
        s.groups[0].shapes[5 + index(2)].emission->radiance = {number(1, 9), number(1, 9), 1};
        break;
      case 2: {
        const Transform transform = any_move();
        s.groups[0].shapes[index(7)].world_from_object = {transform, transform};
        break;
      }
      default: {
        const Transform transform = any_move();
        s.instances[index(5)].world_from_group = {transform, transform};
      }
    }
  };
  for (int i = 0; i < 60; ++i)
    EXPECT_TRUE(scene.change(index(4) == 0 ? all : SceneChanges{.lights = true, .transforms = true}, [&](Scene& s) {
      for (size_t k = index(4); k > 0; --k) change_any(s);
    })) << i;
}

}  // namespace

}  // namespace alhazen::impl::test
