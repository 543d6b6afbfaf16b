// Vertex attributes other than normals and the first uv set: second uvs, colours, tangents.

#include <gtest/gtest.h>

#include "core/shapes/tangents.h"
#include "core/textures/texture.h"
#include "support/compiled_scenes.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

/// A triangle (0, 0), (1, 0), (0, 1) with all attributes; one without any precedes it, so that offsets are not 0.
Scene scene_with_attributes(const Transform& transform) {
  Scene scene = described_scene(film_of(4, 4) +
                                "WorldBegin LightSource \"infinite\" Shape \"trianglemesh\" \"point3 P\" [5 0 0  6 0 0 "
                                " 5 1 0] \"point2 uv\" [0 0 1 0 0 1]");
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.second_uvs = {{0.5f, 0.5f}, {0.5f, 2.5f}, {4.5f, 0.5f}};
  mesh.colours = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}};
  mesh.tangents = {{0, 1, 0, -1}, {0, 1, 0, -1}, {0, 1, 0, -1}};
  scene.meshes.push_back(mesh);
  Shape shape;
  shape.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
  shape.world_from_object = {transform, transform};
  for (const TextureKind kind : {TextureKind::vertex_colour, TextureKind::vertex_alpha, TextureKind::coordinates}) {
    Texture texture;
    texture.kind = kind;
    texture.uv_set = 1;
    scene.textures.push_back(texture);
    Material material;
    material.reflectance = static_cast<uint32_t>(scene.textures.size() - 1);
    scene.materials.push_back(material);
  }
  scene.groups[0].shapes.push_back(shape);
  return scene;
}

template <class Real>
class VertexAttributes : public ::testing::Test {
 protected:
  /// The triangle with attributes (`plain`: the other) at the weights 0.5, 0.25, 0.25.
  Hit<Real> hit(const CompiledScene<Real>& scene, bool plain = false) const {
    for (uint32_t i = 0; i < scene.view.triangles_count; ++i)
      if ((scene.view.surfaces[scene.view.triangles[i].surface].attributes == no_offset) == plain)
        return {Real(1), Real(0.25), Real(0.25), {PrimitiveKind::triangle, i}};
    ADD_FAILURE() << "no such triangle";
    return {};
  }
  Vec3d value(const CompiledScene<Real>& scene, uint32_t from_the_last, const Hit<Real>& hit) const {
    // The default material follows, for shapes without one.
    const TextureRange range = scene.view.materials[scene.view.materials_count - 2 - from_the_last].diffuse.reflectance;
    return convert<double>(
        evaluate_texture(scene.view, range, TexturePoint<Real>{{}, {Real(0.25), Real(0.75)}, {}, hit}));
  }
};
TYPED_TEST_SUITE(VertexAttributes, Reals);

TYPED_TEST(VertexAttributes, AreInterpolated) {
  const auto scene = compiled_scene<TypeParam>(scene_with_attributes({}));
  const auto hit = this->hit(scene);
  EXPECT_EQ(this->value(scene, 2, hit), (Vec3d{0.5, 0.25, 0.25}));
  EXPECT_EQ(this->value(scene, 1, hit), splat(0.625));
  EXPECT_EQ(this->value(scene, 0, hit), (Vec3d{1.5, 1, 0}));
}

TYPED_TEST(VertexAttributes, MeshesWithoutThemAreWhiteAndHaveOneSetOfUvs) {
  const auto scene = compiled_scene<TypeParam>(scene_with_attributes({}));
  const auto hit = this->hit(scene, true);
  EXPECT_EQ(this->value(scene, 2, hit), splat(1.0));
  EXPECT_EQ(this->value(scene, 1, hit), splat(1.0));
  EXPECT_EQ(this->value(scene, 0, hit), (Vec3d{0.25, 0.75, 0}));
}

TYPED_TEST(VertexAttributes, TangentsAreThoseOfTheMeshOrOfItsUvs) {
  using Real = TypeParam;
  const auto tangents = [&](const CompiledScene<Real>& scene, bool plain) {
    const Hit<Real> hit = this->hit(scene, plain);
    return surface_tangents(scene.view, hit, triangle_interaction(scene.view, hit));
  };
  const auto scene = compiled_scene<Real>(scene_with_attributes({}));
  EXPECT_EQ(tangents(scene, false).dpdu, (Vec3<Real>{0, 1, 0}));
  EXPECT_EQ(tangents(scene, false).dpdv, (Vec3<Real>{1, 0, 0}));
  EXPECT_EQ(tangents(scene, true).dpdu, (Vec3<Real>{1, 0, 0}));
  EXPECT_EQ(mesh_tangent(scene.view, this->hit(scene)).handedness, -1);
  EXPECT_EQ(mesh_tangent(scene.view, this->hit(scene, true)).handedness, 0);
  // A mirror swaps handedness; scales do not change the length of tangents.
  const auto mirrored = compiled_scene<Real>(scene_with_attributes(Transform::scale({1, -3, 1})));
  EXPECT_EQ(tangents(mirrored, false).dpdu, (Vec3<Real>{0, -1, 0}));
  EXPECT_EQ(tangents(mirrored, false).dpdv, (Vec3<Real>{1, 0, 0}));
  EXPECT_EQ(mesh_tangent(mirrored.view, this->hit(mirrored)).handedness, 1);
}

/// Area of (u, v) per area of the surface: 1 for the first set, 8 for the second; scales matter.
TYPED_TEST(VertexAttributes, DensityOfUvs) {
  using Real = TypeParam;
  const auto scene = compiled_scene<Real>(scene_with_attributes(Transform::scale({2, 2, 2})));
  EXPECT_NEAR(static_cast<double>(uv_density(scene.view, this->hit(scene), Real(0), Vec3<Real>{0, 0, 1}, 0u)), 0.25,
              1e-6);
  EXPECT_NEAR(static_cast<double>(uv_density(scene.view, this->hit(scene), Real(0), Vec3<Real>{0, 0, 1}, 1u)), 2, 1e-6);
  EXPECT_NEAR(static_cast<double>(uv_density(scene.view, this->hit(scene, true), Real(0), Vec3<Real>{0, 0, 1}, 1u)), 1,
              1e-6);
}

/// An instance that grows threefold while the shutter is open: its texture is stretched with it.
TYPED_TEST(VertexAttributes, DensityOfUvsWhereAnInstanceIsAtTheTime) {
  using Real = TypeParam;
  for (const double end : {1.0, 3.0}) {
    Scene described = scene_with_attributes({});
    described.groups.push_back({{}, {described.groups[0].shapes.back()}});
    described.groups[0].shapes.pop_back();
    Instance instance;
    instance.group = static_cast<uint32_t>(described.groups.size() - 1);
    instance.world_from_group.end = Transform::scale({end, end, end});
    described.instances.assign(2, instance);
    CompileOptions options;
    options.max_copied_triangles = 0;
    Diagnostics diagnostics;
    const auto scene = compile_scene<Real>(std::move(described), options, diagnostics);
    Hit<Real> hit = this->hit(scene);
    hit.instance = 0;
    const auto density = [&](Real time) {
      const SurfaceInteraction<Real> si = surface_interaction(scene.view, Ray<Real>{{}, {0, 0, 1}, time}, hit);
      const TexturePoint<Real> at = texture_point(si, hit);
      return static_cast<double>(uv_density(scene.view, at.hit, at.time, at.normal, 0u));
    };
    EXPECT_NEAR(density(Real(0)), 1, 1e-6);
    EXPECT_NEAR(density(Real(0.5)), 4 / ((1 + end) * (1 + end)), 1e-6);
    EXPECT_NEAR(density(Real(1)), 1 / (end * end), 1e-6);
  }
}

TEST(VertexAttributeErrors, NumbersMustFit) {
  Scene scene = scene_with_attributes({});
  scene.meshes.back().colours.pop_back();
  Diagnostics diagnostics;
  EXPECT_THROW(compile_scene<float>(std::move(scene), {}, diagnostics), InputError);
}

}  // namespace
}  // namespace alhazen::impl::test
