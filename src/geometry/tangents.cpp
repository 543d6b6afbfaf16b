#include "geometry/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace alhazen::impl::gltf {

namespace {

struct Corner {
  std::array<uint64_t, 3> position{};
  std::array<uint32_t, 5> normal_and_uv{};
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  size_t operator()(const Corner& corner) const {
    uint64_t h = 0x9e3779b97f4a7c15u;
    const auto add = [&](uint64_t value) { h = (h ^ value) * 0xff51afd7ed558ccdu, h ^= h >> 32; };
    for (const uint64_t value : corner.position) add(value);
    for (const uint32_t value : corner.normal_and_uv) add(value);
    return static_cast<size_t>(h);
  }
};

Vec3d on_plane(const Vec3d& v, const Vec3d& normal) {
  const Vec3d flat = v - normal * dot(v, normal);
  const double size = length(flat);
  return size > 0 ? flat * (1 / size) : Vec3d{};
}

class TangentBuilder {
 public:
  TangentBuilder(Mesh& mesh, int uv_set) : mesh_(mesh), uvs_(uv_set == 1 ? mesh.second_uvs : mesh.uvs) {}

  void run() {
    weld();
    sums_.assign(2 * groups_, Vec3d{});
    for (size_t t = 0; t < mesh_.triangle_count(); ++t) add_triangle(t);
    write();
  }

 private:
  /// Assigns a common number to equal vertices.
  void weld() {
    std::unordered_map<Corner, uint32_t, CornerHash> known;
    known.reserve(mesh_.positions.size());
    for (size_t i = 0; i < mesh_.positions.size(); ++i) {
      const Vec3d p = mesh_.positions[i] + Vec3d{};  // -0 is 0
      const Vec3f n = mesh_.normals[i] + Vec3f{};
      const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
      const Corner corner{{std::bit_cast<uint64_t>(p.x), std::bit_cast<uint64_t>(p.y), std::bit_cast<uint64_t>(p.z)},
                          {bits(n.x), bits(n.y), bits(n.z), bits(uvs_[i].x + 0.0f), bits(uvs_[i].y + 0.0f)}};
      group_.push_back(known.try_emplace(corner, static_cast<uint32_t>(known.size())).first->second);
    }
    groups_ = known.size();
  }

  /// Twice the signed area in uv: above 0 if uv has the winding of the corners.
  double turn(size_t t) const {
    const uint32_t* v = &mesh_.indices[3 * t];
    const auto uv = [&](int i) { return Vec2d{static_cast<double>(uvs_[v[i]].x), static_cast<double>(uvs_[v[i]].y)}; };
    const Vec2d a = uv(0), b = uv(1), c = uv(2);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  /// Adds to each corner the direction of increasing u, projected perpendicular to the normal and weighted by the
  /// angle.
  void add_triangle(size_t t) {
    const double determinant = turn(t);
    if (determinant == 0 || !std::isfinite(determinant)) return;
    const uint32_t* v = &mesh_.indices[3 * t];
    const Vec3d p[3] = {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    const double dv1 = static_cast<double>(uvs_[v[1]].y) - static_cast<double>(uvs_[v[0]].y),
                 dv2 = static_cast<double>(uvs_[v[2]].y) - static_cast<double>(uvs_[v[0]].y);
    const Vec3d along_u = ((p[1] - p[0]) * dv2 - (p[2] - p[0]) * dv1) * (determinant < 0 ? -1.0 : 1.0);
    for (size_t i = 0; i < 3; ++i) {
      const Vec3f& n = mesh_.normals[v[i]];
      const Vec3d normal{static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
      const Vec3d to_next = on_plane(p[(i + 1) % 3] - p[i], normal), to_last = on_plane(p[(i + 2) % 3] - p[i], normal);
      const double angle = std::acos(std::clamp(dot(to_next, to_last), -1.0, 1.0));
      const Vec3d sum = sums_[slot(v[i], determinant < 0)] + on_plane(along_u, normal) * angle;
      if (is_finite(sum)) sums_[slot(v[i], determinant < 0)] = sum;
    }
  }

  size_t slot(uint32_t vertex, bool mirrored) const { return 2 * size_t{group_[vertex]} + (mirrored ? 1 : 0); }

  void write() {
    enum : uint8_t { unused, straight, mirrored };
    std::vector<uint8_t> orientation(mesh_.positions.size(), unused);
    std::unordered_map<uint32_t, uint32_t> twins;
    for (size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const double determinant = turn(t);
      for (size_t i = 0; i < 3; ++i) {
        uint32_t& vertex = mesh_.indices[3 * t + i];
        // A triangle without uv area fits either orientation.
        const uint8_t wanted = determinant < 0 ? mirrored : straight;
        if (orientation[vertex] == unused) orientation[vertex] = wanted;
        if (orientation[vertex] == wanted || determinant == 0) continue;
        const auto [twin, is_new] = twins.try_emplace(vertex, static_cast<uint32_t>(mesh_.positions.size()));
        if (is_new) {
          duplicate(vertex);
          orientation.push_back(wanted);
        }
        vertex = twin->second;
      }
    }
    for (uint32_t i = 0; i < mesh_.positions.size(); ++i) {
      const Vec3d sum = sums_[slot(i, orientation[i] == mirrored)];
      const double size = length(sum);
      const Vec3d unit = size > 0 ? sum * (1 / size) : Vec3d{};
      mesh_.tangents.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
                                orientation[i] == mirrored ? -1.0f : 1.0f});
    }
  }

  void duplicate(uint32_t vertex) {
    const auto again = [&](auto& values) {
      if (values.empty()) return;
      const auto value = values[vertex];
      values.push_back(value);
    };
    again(mesh_.positions);
    again(mesh_.normals);
    again(mesh_.uvs);
    again(mesh_.second_uvs);
    again(mesh_.colours);
    group_.push_back(group_[vertex]);
  }

  Mesh& mesh_;
  const std::vector<Vec2f>& uvs_;
  std::vector<uint32_t> group_;  ///< of each vertex
  size_t groups_ = 0;
  std::vector<Vec3d> sums_;  ///< of each group: of triangles with uv in order, and of mirrored ones
};

}  // namespace

void add_tangents(Mesh& mesh, int uv_set) {
  const size_t count = (uv_set == 1 ? mesh.second_uvs : mesh.uvs).size();
  if (!mesh.tangents.empty() || mesh.normals.empty() || mesh.indices.empty() || count == 0) return;
  TangentBuilder(mesh, uv_set).run();
}

}  // namespace alhazen::impl::gltf
