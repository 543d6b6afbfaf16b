#pragma once

// Closed meshes about a point: a cube, icospheres, smooth and dented.

#include <array>
#include <map>
#include <utility>

#include "scene/scene.h"
#include "support/random.h"

namespace alhazen::impl::test {

/// The icosahedron, with each triangle split into four `subdivisions` times, vertices on the unit sphere.
/// Counter-clockwise seen from outside.
inline Mesh icosphere(int subdivisions) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (Vec3d& p : mesh.positions) p = normalize(p);
  for (int i = 0; i < subdivisions; ++i) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [found, added] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
      if (added) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
      return found->second;
    };
    std::vector<uint32_t> finer;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      const uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    mesh.indices = std::move(finer);
  }
  return mesh;
}

/// [-1, 1]^3, two triangles per side.
inline Mesh cube() {
  Mesh mesh;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) mesh.positions.push_back({x, y, z});
  mesh.indices = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                  2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  return mesh;
}

/// Moves vertices radially by up to `amount` of their distance from the origin, which stays inside.
inline void jitter_radii(Mesh& mesh, double amount, Random& random) {
  for (Vec3d& p : mesh.positions) p *= 1 + random.between(-amount, amount);
}

}  // namespace alhazen::impl::test
