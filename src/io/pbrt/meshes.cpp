#include "io/pbrt/meshes.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "geometry/loop_subdivision.h"
#include "geometry/tessellate.h"
#include "io/ply/ply.h"

namespace alhazen::impl::pbrt {

namespace {

/// Limit on triangles after subdivision.
constexpr size_t max_subdivided_triangles = size_t{1} << 22;

/// Limit on vertices for 32-bit indices, with room for one more patch.
constexpr size_t max_vertices = (size_t{1} << 32) - 1000;

void orient_by_normals(Mesh& mesh) {
  if (mesh.normals.empty()) return;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    uint32_t &a = mesh.indices[i], &b = mesh.indices[i + 1], &c = mesh.indices[i + 2];
    const Vec3d face = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    const Vec3d normal =
        convert<double>(mesh.normals[a]) + convert<double>(mesh.normals[b]) + convert<double>(mesh.normals[c]);
    if (dot(face, normal) < 0) std::swap(b, c);
  }
}

/// Reads positions and indices with `corners` per face. A single face needs no indices.
Mesh read_faces(ParameterList& list, size_t corners) {
  Mesh mesh;
  const Place indices_place = list.place_of("indices");
  mesh.positions = list.take_points3("P");
  mesh.indices = list.take_integers("indices");
  if (mesh.positions.empty())
    fail(list.place(), list.directive() + " has no positions; give \"point3 P\" [ x y z ... ]");
  if (mesh.indices.empty() && mesh.positions.size() == corners)
    for (uint32_t i = 0; i < corners; ++i) mesh.indices.push_back(i);
  if (mesh.indices.empty())
    fail(list.place(), list.directive() + " has no \"integer indices\"; only a single face can do without");
  if (mesh.indices.size() % corners != 0)
    fail(indices_place, "\"indices\" has " + std::to_string(mesh.indices.size()) + " values, not a multiple of " +
                            std::to_string(corners));
  for (const uint32_t index : mesh.indices)
    if (index >= mesh.positions.size())
      fail(indices_place, "index " + std::to_string(static_cast<int32_t>(index)) + " is out of range: \"P\" has " +
                              std::to_string(mesh.positions.size()) + " points");
  return mesh;
}

void require_per_vertex(const Place& place, std::string_view name, size_t count, size_t vertices) {
  if (count != 0 && count != vertices)
    fail(place, "\"" + std::string(name) + "\" has " + std::to_string(count) + " values for " +
                    std::to_string(vertices) + " points; it takes one per point");
}

/// Reads normals and uvs with one value per vertex, if there are any.
void read_vertex_data(ParameterList& list, Mesh& mesh) {
  const Place normals_place = list.place_of("N"), uvs_place = list.place_of("uv");
  mesh.normals = list.take_normals("N");
  mesh.uvs = list.take_points2("uv");
  require_per_vertex(normals_place, "N", mesh.normals.size(), mesh.positions.size());
  require_per_vertex(uvs_place, "uv", mesh.uvs.size(), mesh.positions.size());
}

/// Frees the unused capacity of an array that grew, which may be as large as its contents.
void release_slack(Mesh& mesh) {
  mesh.positions.shrink_to_fit();
  mesh.indices.shrink_to_fit();
  mesh.normals.shrink_to_fit();
  mesh.uvs.shrink_to_fit();
}

}  // namespace

uint32_t add_mesh(Build& build, const ParameterList& list, Mesh mesh) {
  for (const Vec3d& position : mesh.positions)
    if (!is_finite(position)) fail(list.place(), list.directive() + ": a coordinate exceeds double precision");
  orient_by_normals(mesh);
  release_slack(mesh);
  build.scene.meshes.push_back(std::move(mesh));
  return static_cast<uint32_t>(build.scene.meshes.size() - 1);
}

uint32_t read_triangle_mesh(Build& build, ParameterList& list) {
  Mesh mesh = read_faces(list, 3);
  read_vertex_data(list, mesh);
  list.ignore({"S", "faceIndices"});
  return add_mesh(build, list, std::move(mesh));
}

uint32_t read_bilinear_mesh(Build& build, ParameterList& list) {
  Mesh patches = read_faces(list, 4);
  read_vertex_data(list, patches);
  list.ignore({"faceIndices"});
  if (list.has("emissionfilename"))
    build.warn(list.place_of("emissionfilename"), "emission images of patches are not supported");
  Mesh mesh;
  for (size_t i = 0; i < patches.indices.size(); i += 4) {
    BilinearPatch patch{{}, {}, {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0, 1}, Vec2f{1, 1}}};
    for (size_t corner = 0; corner < 4; ++corner) {
      const uint32_t vertex = patches.indices[i + corner];
      patch.corners[corner] = patches.positions[vertex];
      if (!patches.normals.empty()) patch.normals[corner] = patches.normals[vertex];
      if (!patches.uvs.empty()) patch.uvs[corner] = patches.uvs[vertex];
    }
    append_bilinear_patch(patch, !patches.normals.empty(), mesh);
    if (mesh.positions.size() > max_vertices)
      fail(list.place(), list.directive() + " has too many patches for indices of 32 bits; split it");
  }
  return add_mesh(build, list, std::move(mesh));
}

uint32_t read_ply_mesh(Build& build, ParameterList& list) {
  list.ignore({"edgelength"});
  if (list.has("displacement"))
    build.warn(list.place_of("displacement"), "\"displacement\" of meshes is not supported; it is ignored");
  if (!list.has("filename")) fail(list.place(), list.directive() + " needs \"string filename\" [ \"mesh.ply\" ]");
  const InputPath path = build.existing_file(list.place_of("filename"), list.string("filename", ""));
  const auto [entry, is_new] = build.meshes_by_key.try_emplace("ply " + path.name, 0u);
  if (is_new) {
    build.diagnostics.activity().begin("reading meshes", build.scene.meshes.size() + 1);
    entry->second = add_mesh(build, list, read_ply(path, build.diagnostics));
  }
  return entry->second;
}

uint32_t read_loop_subdivision(Build& build, ParameterList& list) {
  Mesh control = read_faces(list, 3);
  const int levels = list.integer("levels", 3);
  list.ignore({"scheme", "N", "uv", "S"});
  if (levels < 0 || levels > 6) fail(list.place_of("levels"), "\"levels\" must be from 0 to 6");
  if (control.triangle_count() << (2 * levels) > max_subdivided_triangles)
    fail(list.place_of("levels"), "subdividing " + std::to_string(control.triangle_count()) + " triangles " +
                                      std::to_string(levels) + " times makes over four million; use fewer levels");
  return add_mesh(build, list, loop_subdivided(std::move(control), levels));
}

}  // namespace alhazen::impl::pbrt
