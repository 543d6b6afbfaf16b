// The meshes of a public scene.

#include <cmath>
#include <limits>

#include "alhazen/scene.h"
#include "api/caller_errors.h"
#include "api/parts.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// The number of elements, of `size` values each.
size_t count_elements(const char* name, size_t values, size_t size) {
  if (values % size != 0)
    impl::refuse_argument(name, "must have " + std::to_string(size) +
                                    " values for each element: " + std::to_string(values) + " is no multiple of it");
  return values / size;
}

void check_finite(const char* name, const Reals& values) {
  for (size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      impl::refuse_argument(name, "holds a value that is infinite or not a number, at position " + std::to_string(i));
}

void check_size(const char* name, size_t values, size_t vertices, size_t size) {
  if (values != 0 && values != vertices * size)
    impl::refuse_argument(name, "must have " + std::to_string(size) + " values for each of the " +
                                    std::to_string(vertices) + " vertices, or none, not " + std::to_string(values));
}

float single(const char* name, double value) {
  if (std::abs(value) > double{std::numeric_limits<float>::max()})
    impl::refuse_argument(name, "holds a value that is too large for single precision");
  return static_cast<float>(value);
}

std::vector<impl::Vec3d> positions_of(const Reals& values) {
  if (values.empty()) impl::refuse_argument("positions", "must not be empty");
  const size_t count = count_elements("positions", values.size(), 3);
  if (count > 0xfffffff0u) impl::refuse_argument("positions", "must be of fewer than 2^32 vertices");
  check_finite("positions", values);
  std::vector<impl::Vec3d> positions(count);
  for (size_t i = 0; i < count; ++i) positions[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return positions;
}

std::vector<impl::Vec3f> normals_of(const Reals& values, size_t vertices) {
  check_size("normals", values.size(), vertices, 3);
  check_finite("normals", values);
  std::vector<impl::Vec3f> normals(values.size() / 3);
  for (size_t i = 0; i < normals.size(); ++i)
    normals[i] = {single("normals", values[3 * i]), single("normals", values[3 * i + 1]),
                  single("normals", values[3 * i + 2])};
  return normals;
}

std::vector<impl::Vec2f> uvs_of(const char* name, const Reals& values, size_t vertices) {
  check_size(name, values.size(), vertices, 2);
  check_finite(name, values);
  std::vector<impl::Vec2f> uvs(values.size() / 2);
  for (size_t i = 0; i < uvs.size(); ++i) uvs[i] = {single(name, values[2 * i]), single(name, values[2 * i + 1])};
  return uvs;
}

std::vector<std::array<float, 4>> colours_of(const Reals& values, size_t vertices) {
  const bool has_alpha = values.size() == 4 * vertices;
  if (!has_alpha) check_size("colours", values.size(), vertices, 3);
  check_finite("colours", values);
  const size_t size = has_alpha ? 4 : 3;
  std::vector<std::array<float, 4>> colours(values.size() / size);
  for (size_t i = 0; i < colours.size(); ++i) {
    colours[i][3] = 1;
    for (size_t c = 0; c < size; ++c) colours[i][c] = single("colours", values[size * i + c]);
  }
  return colours;
}

std::vector<std::array<float, 4>> tangents_of(const Reals& values, size_t vertices) {
  check_size("tangents", values.size(), vertices, 4);
  check_finite("tangents", values);
  std::vector<std::array<float, 4>> tangents(values.size() / 4);
  for (size_t i = 0; i < tangents.size(); ++i) {
    for (size_t c = 0; c < 4; ++c) tangents[i][c] = single("tangents", values[4 * i + c]);
    if (std::abs(tangents[i][3]) != 1) impl::refuse_argument("tangents", "must have 1 or -1 as their fourth value");
  }
  return tangents;
}

impl::Mesh mesh_of(const MeshArrays& arrays) {
  impl::Mesh mesh;
  mesh.positions = positions_of(arrays.positions);
  const size_t vertices = mesh.positions.size();
  if (arrays.indices.empty()) impl::refuse_argument("indices", "must not be empty");
  count_elements("indices", arrays.indices.size(), 3);
  for (const uint32_t index : arrays.indices)
    if (index >= vertices)
      impl::refuse_argument("indices", "holds " + std::to_string(index) + ", but there are only " +
                                           std::to_string(vertices) + " vertices");
  mesh.indices.assign(arrays.indices.begin(), arrays.indices.end());
  mesh.normals = normals_of(arrays.normals, vertices);
  mesh.uvs = uvs_of("uvs", arrays.uvs, vertices);
  mesh.second_uvs = uvs_of("second_uvs", arrays.second_uvs, vertices);
  mesh.colours = colours_of(arrays.colours, vertices);
  mesh.tangents = tangents_of(arrays.tangents, vertices);
  mesh.name = arrays.name;
  return mesh;
}

/// The components of vectors, which are stored one after the other.
template <class Value, class Element>
std::span<const Value> values_of(const std::vector<Element>& elements) {
  static_assert(sizeof(Element) % sizeof(Value) == 0 && std::is_standard_layout_v<Element>);
  return {reinterpret_cast<const Value*>(elements.data()), elements.size() * (sizeof(Element) / sizeof(Value))};
}

}  // namespace

MeshId Scene::add(const MeshArrays& arrays) {
  impl::SceneState& s = state();
  const auto index = static_cast<uint32_t>(s.description.meshes.size());
  s.description.meshes.push_back(impl::for_caller([&] { return mesh_of(arrays); }));
  s.meshes.add(index, s.id);
  ++s.revisions.geometry;
  return impl::handle_of<MeshId>(index, s.meshes);
}

MeshView Scene::mesh(MeshId mesh) const {
  const impl::Mesh& m = state().description.meshes[impl::index_of("mesh", mesh, state())];
  return {.positions = values_of<double>(m.positions),
          .indices = m.indices,
          .normals = values_of<float>(m.normals),
          .uvs = values_of<float>(m.uvs),
          .second_uvs = values_of<float>(m.second_uvs),
          .tangents = values_of<float>(m.tangents),
          .colours = values_of<float>(m.colours)};
}

void Scene::set_mesh(MeshId mesh, const MeshArrays& arrays) {
  const uint32_t index = impl::index_of("mesh", mesh, state());
  state().description.meshes[index] = impl::for_caller([&] { return mesh_of(arrays); });
  ++state().revisions.geometry;
}

void Scene::set_positions(MeshId mesh, const Reals& positions, const Reals& normals) {
  impl::Mesh& m = state().description.meshes[impl::index_of("mesh", mesh, state())];
  std::vector<impl::Vec3d> moved = impl::for_caller([&] { return positions_of(positions); });
  if (moved.size() != m.positions.size())
    impl::refuse_argument("positions", "must be of the " + std::to_string(m.positions.size()) +
                                           " vertices of the mesh, not of " + std::to_string(moved.size()));
  std::vector<impl::Vec3f> turned = impl::for_caller([&] { return normals_of(normals, moved.size()); });
  m.positions = std::move(moved);
  if (!turned.empty()) m.normals = std::move(turned);
  ++state().revisions.geometry;
}

}  // namespace ALHAZEN_NAMESPACE
