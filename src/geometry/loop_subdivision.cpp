#include "geometry/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace alhazen::impl::pbrt {

namespace {

/// An undirected edge and its adjacent faces. Edges of one or of more than two faces count as boundary.
struct Edge {
  uint32_t low = 0, high = 0;
  uint32_t faces = 0;
  Vec3d opposite_sum;  ///< sum of the corners opposite to it
  bool is_boundary() const { return faces != 2; }
};

/// The edges of a mesh, each once, and for each corner of each triangle the edge that leaves it.
struct EdgeTable {
  std::vector<Edge> edges;
  std::vector<uint32_t> edge_of_corner;
};

EdgeTable find_edges(const Mesh& mesh) {
  const auto corners = static_cast<uint32_t>(mesh.indices.size());
  const auto next = [](uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  std::vector<std::pair<uint64_t, uint32_t>> keyed;  // both end points in one number, and the corner
  keyed.reserve(corners);
  for (uint32_t corner = 0; corner < corners; ++corner) {
    const auto [low, high] = std::minmax(mesh.indices[corner], mesh.indices[next(corner)]);
    keyed.emplace_back(uint64_t{low} << 32 | high, corner);
  }
  std::sort(keyed.begin(), keyed.end());
  EdgeTable table;
  table.edge_of_corner.resize(corners);
  for (size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].first != keyed[i - 1].first) {
      Edge& edge = table.edges.emplace_back();
      edge.low = static_cast<uint32_t>(keyed[i].first >> 32);
      edge.high = static_cast<uint32_t>(keyed[i].first & 0xffffffffu);
    }
    const uint32_t corner = keyed[i].second;
    Edge& edge = table.edges.back();
    ++edge.faces;
    edge.opposite_sum += mesh.positions[mesh.indices[next(next(corner))]];
    table.edge_of_corner[corner] = static_cast<uint32_t>(table.edges.size() - 1);
  }
  return table;
}

/// The neighbourhood of a vertex.
struct Ring {
  uint32_t valence = 0, boundary_valence = 0;
  Vec3d sum, boundary_sum;  ///< of the neighbours, and of those along boundary edges
};

std::vector<Ring> find_rings(const Mesh& mesh, const std::vector<Edge>& edges) {
  std::vector<Ring> rings(mesh.positions.size());
  const auto join = [&](uint32_t vertex, uint32_t neighbour, bool boundary) {
    Ring& ring = rings[vertex];
    ++ring.valence;
    ring.sum += mesh.positions[neighbour];
    if (!boundary) return;
    ++ring.boundary_valence;
    ring.boundary_sum += mesh.positions[neighbour];
  };
  for (const Edge& edge : edges) {
    join(edge.low, edge.high, edge.is_boundary());
    join(edge.high, edge.low, edge.is_boundary());
  }
  return rings;
}

/// Weight of each neighbour of an interior vertex.
double beta(uint32_t valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8 * valence); }

/// Blends a vertex with its ring. Boundary corners and isolated vertices remain in place.
Vec3d blended(const Vec3d& p, const Ring& ring, double inner_weight, double boundary_weight) {
  if (ring.valence == 0) return p;
  if (ring.boundary_valence == 0) return p * (1 - ring.valence * inner_weight) + ring.sum * inner_weight;
  if (ring.boundary_valence == 2) return p * (1 - 2 * boundary_weight) + ring.boundary_sum * boundary_weight;
  return p;
}

Mesh subdivided(const Mesh& mesh) {
  const EdgeTable table = find_edges(mesh);
  const std::vector<Ring> rings = find_rings(mesh, table.edges);
  const auto old_count = static_cast<uint32_t>(mesh.positions.size());
  Mesh finer;
  finer.positions.reserve(old_count + table.edges.size());
  for (uint32_t i = 0; i < old_count; ++i)
    finer.positions.push_back(blended(mesh.positions[i], rings[i], beta(rings[i].valence), 1.0 / 8));
  for (const Edge& edge : table.edges) {
    const Vec3d ends = mesh.positions[edge.low] + mesh.positions[edge.high];
    finer.positions.push_back(edge.is_boundary() ? ends * 0.5 : ends * (3.0 / 8) + edge.opposite_sum * (1.0 / 8));
  }
  finer.indices.reserve(4 * mesh.indices.size());
  for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) {
    const uint32_t a = mesh.indices[corner], b = mesh.indices[corner + 1], c = mesh.indices[corner + 2];
    const uint32_t ab = old_count + table.edge_of_corner[corner], bc = old_count + table.edge_of_corner[corner + 1],
                   ca = old_count + table.edge_of_corner[corner + 2];
    finer.indices.insert(finer.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  return finer;
}

void move_to_limit(Mesh& mesh) {
  const EdgeTable table = find_edges(mesh);
  const std::vector<Ring> rings = find_rings(mesh, table.edges);
  std::vector<Vec3d> limit;
  limit.reserve(mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const uint32_t valence = rings[i].valence;
    const double gamma = valence == 0 ? 0 : 1 / (valence + 3 / (8 * beta(valence)));
    limit.push_back(blended(mesh.positions[i], rings[i], gamma, 1.0 / 5));
  }
  mesh.positions = std::move(limit);
}

/// Computes normals as area-weighted means of the adjacent face normals.
void add_normals(Mesh& mesh) {
  std::vector<Vec3d> sums(mesh.positions.size());
  for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) {
    const Vec3d& p = mesh.positions[mesh.indices[corner]];
    const Vec3d normal =
        cross(mesh.positions[mesh.indices[corner + 1]] - p, mesh.positions[mesh.indices[corner + 2]] - p);
    for (size_t i = 0; i < 3; ++i) sums[mesh.indices[corner + i]] += normal;
  }
  mesh.normals.reserve(sums.size());
  for (const Vec3d& sum : sums) {
    const double size = length(sum);
    mesh.normals.push_back(size > 0 && std::isfinite(size) ? convert<float>(sum / size) : Vec3f{0, 0, 1});
  }
}

}  // namespace

Mesh loop_subdivided(Mesh control, int levels) {
  for (int level = 0; level < levels; ++level) control = subdivided(control);
  move_to_limit(control);
  add_normals(control);
  return control;
}

}  // namespace alhazen::impl::pbrt
