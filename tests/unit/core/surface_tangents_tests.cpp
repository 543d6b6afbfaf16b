// Tangents are derivatives of the position by uv, for any shape and transform: a step along dpdu changes u but not v.
// Normal maps and bump maps tilt normals in the right direction.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/bvh/bvh2/traversal.h"
#include "core/integrators/stages.h"
#include "support/compiled_scenes.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

struct NamedText {
  const char* name;
  const char* text;
};

constexpr NamedText shapes[] = {
    {"sphere", R"(Shape "sphere")"},
    {"half a sphere", R"(Shape "sphere" "float zmin" -0.5 "float phimax" 200)"},
    {"triangles with uv", R"(Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0.3  -1 1 0]
      "point2 uv" [0.1 0.2  0.8 0.1  0.9 0.9  0 1] "integer indices" [0 1 2 0 2 3])"},
    {"triangles with mirrored uv and normals", R"(Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]
      "point2 uv" [0.9 0.2  0.2 0.1  0.1 0.9  1 1] "normal3 N" [0 0 1  0 0 1  0 0.1 1  0 0 1]
      "integer indices" [0 1 2 0 2 3])"},
    {"triangle without uv", R"(Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0.5])"},
    {"disk", R"(Shape "disk" "float innerradius" 0.2)"},
    {"disk without a hole", R"(Shape "disk" "float radius" 0.9)"},
    {"part of a disk", R"(Shape "disk" "float innerradius" 0.3 "float phimax" 200 "float height" 0.2)"},
    {"cylinder", R"(Shape "cylinder")"},
    {"part of a cylinder", R"(Shape "cylinder" "float radius" 0.9 "float zmin" -0.5 "float phimax" 200)"},
    {"bilinear patch", R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0.2  -1 1 0.5  1 1 -0.3])"},
    {"curve", R"(Shape "curve" "string type" "cylinder" "point3 P" [-1 -1 0  -0.3 1 0  0.3 -1 0  1 1 0.2]
      "float width" 0.5)"},
    {"loop subdivision",
     R"(Shape "loopsubdiv" "integer levels" 1 "point3 P" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1]
      "integer indices" [0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5])"}};

constexpr const char* transforms[] = {"",
                                      "Scale -1 1 1",
                                      "Scale 1 -1 1",
                                      "Scale 1 1 -1",
                                      "Scale -1 -1 1",
                                      "Scale -1 -1 -1",
                                      "Rotate 40 1 2 3 Scale -1 1 1 Rotate 70 3 1 2",
                                      "Rotate 40 1 2 3 Scale -1.2 0.9 0.8",
                                      "Scale 0.8 0.9 1.1"};

constexpr const char* bump = R"(Texture "u" "float" "bilerp" "float v00" 0 "float v01" 0 "float v10" 0.3 "float v11" 0.3
    Material "diffuse" "texture displacement" "u")";

/// Ways of placing a shape in the world.
enum class PlacementKind { alone, moving, as_instance, as_moving_instance };

std::string placed(const std::string& shape, const std::string& transform, bool reversed,
                   PlacementKind placement_kind) {
  const std::string orientation = reversed ? "ReverseOrientation " : "";
  const std::string motion = "ActiveTransform EndTime Translate 0.2 0.1 0 Rotate 50 0 1 1 ActiveTransform All ";
  const std::string turned = "ActiveTransform EndTime Translate 0.2 0.1 0 ActiveTransform All ";
  switch (placement_kind) {
    case PlacementKind::alone:
      return orientation + transform + " " + shape;
    case PlacementKind::moving:
      return orientation + (shape.find("\"sphere\"") == std::string::npos ? motion : turned) + transform + " " + shape;
    case PlacementKind::as_instance:
    case PlacementKind::as_moving_instance:
      break;
  }
  return "ObjectBegin \"o\" Scale 1 1 -1 " + shape + " ObjectEnd " + orientation +
         (placement_kind == PlacementKind::as_moving_instance ? motion : "") + transform +
         " ObjectInstance \"o\" Translate 90 0 0 ObjectInstance \"o\"";
}

template <class Real>
CompiledScene<Real> scene_of(Scene scene) {
  Diagnostics diagnostics;
  CompileOptions options;
  options.threads = 1;
  options.max_copied_triangles = 0;
  options.layouts = {BvhLayout::bvh2};
  CompiledScene<Real> flat = compile_scene<Real>(std::move(scene), options, diagnostics);
  expect_no_warnings(diagnostics);
  return flat;
}

/// The hit of a ray, with its tangents.
template <class Real>
struct Found {
  Hit<Real> hit;
  SurfaceInteraction<Real> si;
  SurfaceTangents<Real> tangents;
};

template <class Real>
bool find(const CompiledScene<Real>& scene, const Vec3<Real>& from, const Vec3<Real>& to, Real time,
          Found<Real>& found) {
  const Ray<Real> ray{from, normalize(to - from), time};
  if (!Bvh2Intersector<Real>(scene.view).closest_hit(ray, infinity<Real>, found.hit)) return false;
  found.si = surface_interaction(scene.view, ray, found.hit);
  found.tangents = surface_tangents(scene.view, found.hit, found.si);
  return true;
}

/// Calls check(found) for a hundred points of the shape, at random times. Rays come from all directions.
template <class Real, class Check>
void at_points(const CompiledScene<Real>& scene, const Check& check) {
  Random random(7);
  int found_count = 0;
  for (int i = 0; i < 4000 && found_count < 100; ++i) {
    const Vec3<Real> from = convert<Real>(random.on_sphere() * 4), to = convert<Real>(random.in_box(-0.9, 0.9));
    Found<Real> found;
    if (!find(scene, from, to, random.uniform<Real>(), found)) continue;
    ++found_count;
    check(found);
  }
  EXPECT_EQ(found_count, 100);
}

template <class Real>
class SurfaceTangentsOf : public ::testing::Test {
 protected:
  template <class Check>
  void for_each_case(const char* material, const Check& check) {
    for (const NamedText& shape : shapes)
      for (const char* transform : transforms)
        for (const bool reversed : {false, true})
          for (const PlacementKind placement_kind : {PlacementKind::alone, PlacementKind::moving,
                                                     PlacementKind::as_instance, PlacementKind::as_moving_instance}) {
            SCOPED_TRACE(std::string(shape.name) + ", " + transform + (reversed ? ", reversed" : "") + ", " +
                         std::to_string(static_cast<int>(placement_kind)));
            std::string text = "WorldBegin LightSource \"infinite\" " + std::string(material) + " " +
                               placed(shape.text, transform, reversed, placement_kind);
            check(text);
            if (this->HasFailure()) return;
          }
  }
};
TYPED_TEST_SUITE(SurfaceTangentsOf, Reals);

/// A step of dpdu du + dpdv dv from a point, projected back to the surface, changes uv by (du, dv). Steps over an edge
/// of a mesh, and over the seam of u, are skipped.
TYPED_TEST(SurfaceTangentsOf, AreDerivativesOfThePosition) {
  using Real = TypeParam;
  this->for_each_case(bump, [&](const std::string& text) {
    const CompiledScene<Real> scene = scene_of<Real>(described_scene(text));
    int right = 0, all = 0;
    at_points(scene, [&](const Found<Real>& at) {
      for (const Vec2<Real> step : {Vec2<Real>{Real(0.0005), 0}, Vec2<Real>{0, Real(0.0005)}}) {
        const Vec3<Real> aim = at.si.position + at.tangents.dpdu * step.x + at.tangents.dpdv * step.y;
        Found<Real> there;
        if (!find(scene, aim + at.si.normal * Real(0.05), aim, at.si.time, there)) continue;
        const double du = static_cast<double>(there.si.uv.x - at.si.uv.x - step.x);
        const double dv = static_cast<double>(there.si.uv.y - at.si.uv.y - step.y);
        ++all;
        right += std::abs(du) < 5e-5 && std::abs(dv) < 5e-5;
      }
    });
    EXPECT_GT(all, 150);
    EXPECT_GT(right, all * 0.75);
  });
}

/// A normal map with the normal (0.6, 0, 0.8) tilts it along dpdu, towards the front.
TYPED_TEST(SurfaceTangentsOf, NormalMapsLeanAlongU) {
  using Real = TypeParam;
  this->for_each_case(bump, [&](const std::string& text) {
    // The file has a bump map, which the normal map replaces.
    Scene described = described_scene(text);
    Texture lean;
    lean.kind = TextureKind::constant;
    lean.value = {0.8, 0.5 + 0.5 * 0.3, 0.9};
    described.textures.push_back(lean);
    for (Material& material : described.materials) {
      if (material.displacement == no_index) continue;
      material.displacement = no_index;
      material.normal_map = static_cast<uint32_t>(described.textures.size() - 1);
    }
    const CompiledScene<Real> scene = scene_of<Real>(std::move(described));
    at_points(scene, [&](const Found<Real>& at) {
      const SurfaceInteraction<Real>& si = at.si;
      const MaterialRecord<Real>& material = scene.view.materials[scene.view.surfaces[si.surface].material];
      const Vec3<Real> n = mapped_normal(scene.view, material.normal_map, material.normal_scale,
                                         texture_point(si, at.hit), frame_along(si.shading_normal, at.tangents));
      EXPECT_GT(dot(n, si.shading_normal), Real(0.7));
      // Along dpdu, and then along the part of dpdv that is perpendicular to it.
      const Vec3<Real>& ns = si.shading_normal;
      const Vec3<Real> u = normalize(at.tangents.dpdu - ns * dot(ns, at.tangents.dpdu));
      const Vec3<Real> v = at.tangents.dpdv - ns * dot(ns, at.tangents.dpdv);
      EXPECT_GT(dot(n, u), Real(0.5));
      EXPECT_GT(dot(n, normalize(v - u * dot(u, v))), Real(0.2));
    });
  });
}

/// If the displacement increases with u, the normal tilts against dpdu, and stays on the front side.
TYPED_TEST(SurfaceTangentsOf, BumpsLeanAgainstTheSlope) {
  using Real = TypeParam;
  this->for_each_case(bump, [&](const std::string& text) {
    // Shading normals of curves tilt along u by more than this bump.
    if (text.find("\"curve\"") != std::string::npos) return;
    const CompiledScene<Real> scene = scene_of<Real>(described_scene(text));
    at_points(scene, [&](const Found<Real>& at) {
      const SurfaceInteraction<Real>& si = at.si;
      const MaterialRecord<Real>& material = scene.view.materials[scene.view.surfaces[si.surface].material];
      ASSERT_GT(material.displacement.count, 0u);
      const Vec3<Real> n =
          bumped_normal(scene.view, material.displacement, texture_point(si, at.hit), at.tangents, si.shading_normal);
      EXPECT_GT(dot(n, si.shading_normal), Real(0));
      const Vec3<Real> along = normalize(at.tangents.dpdu);
      EXPECT_LT(dot(n, along), dot(si.shading_normal, along) - Real(0.01));
    });
  });
}

/// A mesh with tangents that agree with its uvs tilts the same way, whatever its placement: in the world and in
/// instances, still or moving.
TYPED_TEST(SurfaceTangentsOf, TangentsOfAMeshAgreeWithItsUvs) {
  using Real = TypeParam;
  this->for_each_case(bump, [&](const std::string& text) {
    if (text.find("\"point2 uv\"") == std::string::npos) return;
    Scene described = described_scene(text);
    const CompiledScene<Real> by_uv = scene_of<Real>(described);
    for (Mesh& mesh : described.meshes) {
      const bool is_mirrored = mesh.uvs[1].x < mesh.uvs[0].x;
      const Vec3d e1 = mesh.positions[1] - mesh.positions[0], e2 = mesh.positions[2] - mesh.positions[0];
      const auto d = [&](size_t i, auto part) { return static_cast<double>(part(mesh.uvs[i]) - part(mesh.uvs[0])); };
      const auto u = [](const Vec2f& uv) { return uv.x; };
      const auto v = [](const Vec2f& uv) { return uv.y; };
      const double determinant = d(1, u) * d(2, v) - d(1, v) * d(2, u);
      const Vec3f along = convert<float>(normalize((e1 * d(2, v) - e2 * d(1, v)) / determinant));
      mesh.tangents.assign(mesh.positions.size(), {along.x, along.y, along.z, is_mirrored ? -1.0f : 1.0f});
    }
    const CompiledScene<Real> by_tangent = scene_of<Real>(std::move(described));
    ASSERT_GT(by_tangent.view.vertex_attributes_count, 0u);
    at_points(by_uv, [&](const Found<Real>& at) {
      const SurfaceTangents<Real> own = surface_tangents(by_tangent.view, at.hit, at.si);
      EXPECT_GT(dot(normalize(own.dpdu), normalize(at.tangents.dpdu)), Real(0.9));
      const Frame<Real> expected = frame_along(at.si.shading_normal, at.tangents);
      EXPECT_GT(dot(frame_along(at.si.shading_normal, own).bitangent, expected.bitangent), Real(0.9));
    });
  });
}

}  // namespace
}  // namespace alhazen::impl::test
