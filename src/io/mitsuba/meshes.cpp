#include "io/mitsuba/meshes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "geometry/tessellate.h"
#include "io/mitsuba/serialized.h"
#include "io/obj/obj_file.h"
#include "io/ply/ply.h"

namespace alhazen::impl::mitsuba {

namespace {

/// Normals of vertices: the sum of those of the triangles about each point, weighted by their angles there (Thuermer,
/// Wuethrich 1998). `points` says which vertices are one point; empty: each is its own.
void add_smooth_normals(Mesh& mesh, const std::vector<uint32_t>& points) {
  const auto point_of = [&](uint32_t vertex) { return points.empty() ? vertex : points[vertex]; };
  uint32_t count = 0;
  for (uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) count = std::max(count, point_of(vertex) + 1);
  std::vector<Vec3d> sums(count);
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::array<uint32_t, 3> corner{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    const Vec3d p[3] = {mesh.positions[corner[0]], mesh.positions[corner[1]], mesh.positions[corner[2]]};
    const Vec3d face = cross(p[1] - p[0], p[2] - p[0]);
    const double area = length(face);
    if (!(area > 0) || !std::isfinite(area)) continue;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      sums[point_of(corner[k])] += face / area * std::atan2(length(cross(a, b)), dot(a, b));
    }
  }
  mesh.normals.reserve(mesh.positions.size());
  for (uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const Vec3d& sum = sums[point_of(vertex)];
    const double size = length(sum);
    mesh.normals.push_back(convert<float>(size > 1e-12 ? sum / size : Vec3d{0, 0, 1}));
  }
}

/// A mesh as it is in a file.
struct FileMesh {
  Mesh mesh;
  std::vector<uint32_t> points;   ///< which vertices are one point; empty: each is its own
  bool has_face_normals = false;  ///< the file says that it is flat
};

std::vector<FileMesh> read_file(Build& build, const std::string& type, const InputPath& path, uint64_t index) {
  std::vector<FileMesh> meshes;
  if (type == "obj") {
    for (obj::Part& part : obj::read_obj(path, obj::Division::none, build.diagnostics).parts)
      meshes.push_back({std::move(part.mesh), std::move(part.points)});
  } else if (type == "ply") {
    meshes.push_back({read_ply(path, build.diagnostics, PlyColours::linear), {}});
  } else {
    SerializedMesh serialized = read_serialized(path, index);
    meshes.push_back({std::move(serialized.mesh), {}, serialized.has_face_normals});
  }
  return meshes;
}

/// Which mesh of the file is meant; only files of type serialized have several.
uint64_t read_shape_index(ObjectReader& reader) {
  if (reader.object().type != "serialized") return 0;
  const int64_t index = reader.integer("shape_index", 0);
  if (index < 0) fail(reader.place_of("shape_index"), "'shape_index' must not be negative");
  return static_cast<uint64_t>(index);
}

/// A mesh that is made only once.
template <class Make>
uint32_t shared(Build& build, const std::string& key, const Make& make) {
  const auto [entry, is_new] = build.meshes.try_emplace(key, no_index);
  if (is_new) {
    entry->second = static_cast<uint32_t>(build.scene.meshes.size());
    build.scene.meshes.push_back(make());
  }
  return entry->second;
}

}  // namespace

std::vector<ReadMesh> read_mesh_file(Build& build, ObjectReader& reader) {
  if (!reader.has("filename")) fail(reader.place(), reader.name() + " needs <string name=\"filename\" value=\"...\"/>");
  const InputPath path = build.document.existing_file(reader.place_of("filename"), reader.text("filename", ""));
  const std::string& type = reader.object().type;
  // Only where the scene says nothing does the file count.
  const bool file_decides = type == "serialized" && !reader.has("face_normals");
  const bool wants_flat = reader.boolean("face_normals", false);
  const bool flips_uvs = reader.boolean("flip_tex_coords", type == "obj");
  const uint64_t shape_index = read_shape_index(reader);
  const std::string key = type +
                          (file_decides ? " as stored"
                           : wants_flat ? " flat"
                                        : " smooth") +
                          (flips_uvs ? " flipped " : " ") + std::to_string(shape_index) + " " + path.name + " ";
  std::vector<ReadMesh> read;
  for (size_t i = 0;; ++i) {
    const auto own = build.meshes.find(key + std::to_string(i) + " own");
    const auto found = own != build.meshes.end() ? own : build.meshes.find(key + std::to_string(i));
    if (found == build.meshes.end()) break;
    read.push_back({found->second, found == own});
  }
  if (!read.empty()) return read;
  build.diagnostics.activity().begin("reading meshes", build.scene.meshes.size() + 1);
  for (auto& [mesh, points, has_face_normals] : read_file(build, type, path, shape_index)) {
    if (mesh.indices.empty()) continue;
    if (flips_uvs)
      for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
    const bool is_flat = file_decides ? has_face_normals : wants_flat;
    if (is_flat) mesh.normals = {};
    const bool is_own = !mesh.normals.empty();
    if (!is_own && !is_flat) add_smooth_normals(mesh, points);
    const auto index = static_cast<uint32_t>(build.scene.meshes.size());
    build.meshes[key + std::to_string(read.size()) + (is_own ? " own" : "")] = index;
    build.scene.meshes.push_back(std::move(mesh));
    read.push_back({index, is_own});
  }
  if (read.empty()) build.warn(reader.place_of("filename"), "the mesh \"" + path.name + "\" has no faces");
  return read;
}

uint32_t rectangle_mesh(Build& build) {
  return shared(build, "rectangle", [] {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
  });
}

uint32_t cube_mesh(Build& build) {
  return shared(build, "cube", [] {
    // The corners of the faces -y, +y, +x, +z, -x, -z; bits 0, 1 and 2 of a corner are the signs of x, y and z.
    constexpr std::array<std::array<unsigned, 4>, 6> faces{
        {{1, 5, 4, 0}, {3, 2, 6, 7}, {1, 3, 7, 5}, {5, 7, 6, 4}, {4, 6, 2, 0}, {3, 1, 0, 2}}};
    constexpr std::array<Vec2f, 4> uvs{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    Mesh mesh;
    for (const auto& face : faces) {
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      for (size_t k = 0; k < 4; ++k) {
        const auto sign = [&](unsigned bit) { return (face[k] >> bit & 1u) != 0 ? 1.0 : -1.0; };
        mesh.positions.push_back({sign(0), sign(1), sign(2)});
        mesh.uvs.push_back(uvs[k]);
      }
      for (const uint32_t corner : {0u, 1u, 2u, 3u, 0u, 2u}) mesh.indices.push_back(first + corner);
    }
    return mesh;
  });
}

uint32_t disk_mesh(Build& build) {
  return shared(build, "disk", [] {
    Mesh mesh = pbrt::tessellated_disk(1, 0, 0, 360);
    // u is the radius here, and v the azimuth.
    for (Vec2f& uv : mesh.uvs) uv = {1 - uv.y, uv.x};
    return mesh;
  });
}

uint32_t cylinder_mesh(Build& build) {
  return shared(build, "cylinder", [] { return pbrt::tessellated_cylinder(1, 0, 1, 360); });
}

uint32_t sphere_mesh(Build& build) {
  return shared(build, "sphere", [] {
    Mesh mesh = pbrt::tessellated_sphere(1, -1, 1, 360);
    for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
    return mesh;
  });
}

bool is_open(const Mesh& mesh) {
  struct Hash {
    size_t operator()(const std::array<uint64_t, 3>& bits) const {
      uint64_t hash = 0;
      for (const uint64_t each : bits) hash = (hash ^ each) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
      return static_cast<size_t>(hash);
    }
  };
  std::unordered_map<std::array<uint64_t, 3>, uint32_t, Hash> points;
  std::vector<uint32_t> point_of;
  for (const Vec3d& p : mesh.positions) {
    const std::array<uint64_t, 3> key{std::bit_cast<uint64_t>(p.x + 0.0), std::bit_cast<uint64_t>(p.y + 0.0),
                                      std::bit_cast<uint64_t>(p.z + 0.0)};
    point_of.push_back(points.try_emplace(key, static_cast<uint32_t>(points.size())).first->second);
  }
  // The sum over the directed edges of both ways is zero for each edge of a closed mesh.
  std::unordered_map<uint64_t, int> edges;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = point_of[mesh.indices[i + k]], b = point_of[mesh.indices[i + (k + 1) % 3]];
      if (a != b) edges[a < b ? a << 32 | b : b << 32 | a] += a < b ? 1 : -1;
    }
  return std::any_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; });
}

}  // namespace alhazen::impl::mitsuba
