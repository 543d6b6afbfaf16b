#include "io/ply/vertex_rows.h"

#include <limits>

#include "util/diagnostics.h"

namespace alhazen {

namespace {

constexpr std::array<const char*, 3> position_names{"x", "y", "z"};
constexpr std::array<const char*, 3> normal_names{"nx", "ny", "nz"};
constexpr std::array<std::array<const char*, 2>, 4> uv_names{
    {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};

bool has_scalar(const PlyElement& element, const char* name) {
  const int property = element.find(name);
  return property >= 0 && !element.properties[static_cast<size_t>(property)].is_list;
}

template <class Names>
size_t count_scalars(const PlyElement& element, const Names& names) {
  size_t count = 0;
  for (const char* const name : names) count += has_scalar(element, name);
  return count;
}

template <class Names>
void assign(VertexLayout& layout, const PlyElement& element, const Names& names, int first_slot) {
  for (size_t i = 0; i < names.size(); ++i)
    layout.slots[static_cast<size_t>(element.find(names[i]))] =
        static_cast<VertexSlot>(first_slot + static_cast<int>(i));
}

/// Converts to float. Doubles beyond its range become infinite, since the conversion itself is undefined for them.
float to_float(double value) {
  constexpr double largest = static_cast<double>(std::numeric_limits<float>::max());
  if (std::abs(value) <= largest) return static_cast<float>(value);
  return std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
}

}  // namespace

VertexLayout vertex_layout(const PlyElement& element, const std::string& name, Diagnostics& diagnostics) {
  const SourceLocation where{name, element.line};
  for (const char* const axis : position_names)
    if (!has_scalar(element, axis))
      throw InputError(where, std::string("element 'vertex' has no property '") + axis + "' that is a number");

  VertexLayout layout;
  layout.slots.assign(element.properties.size(), slot_none);
  assign(layout, element, position_names, slot_x);

  const size_t normal_count = count_scalars(element, normal_names);
  layout.normals = normal_count == normal_names.size();
  if (layout.normals) assign(layout, element, normal_names, slot_nx);
  if (normal_count > 0 && !layout.normals)
    diagnostics.warn(where, "some of nx, ny, nz are missing: the normals are ignored");

  for (const auto& names : uv_names) {
    if (layout.uvs || count_scalars(element, names) < names.size()) continue;
    layout.uvs = true;
    assign(layout, element, names, slot_u);
  }
  return layout;
}

VertexRows::VertexRows(const VertexLayout& layout, uint64_t expected, Mesh& mesh)
    : mesh_(mesh), normals_(layout.normals), uvs_(layout.uvs) {
  const size_t count = static_cast<size_t>(expected);
  mesh_.positions.reserve(count);
  if (normals_) mesh_.normals.reserve(count);
  if (uvs_) mesh_.uvs.reserve(count);
}

void VertexRows::add(const Row& row) {
  mesh_.positions.push_back({row[slot_x], row[slot_y], row[slot_z]});
  if (normals_) add_normal(row);
  if (uvs_) add_uv(row);
}

void VertexRows::add_normal(const Row& row) {
  const Vec3f normal{to_float(row[slot_nx]), to_float(row[slot_ny]), to_float(row[slot_nz])};
  // Also rejects normals that would become zero or infinite when normalized.
  const float squared = length_squared(normal);
  if (std::isfinite(squared) && squared > 0) {
    mesh_.normals.push_back(normal);
    return;
  }
  normals_ = false;
  mesh_.normals = {};
  complaint_about_normals_ = "the normal of vertex " + std::to_string(mesh_.positions.size() - 1) +
                             " has no direction: all normals are ignored";
}

void VertexRows::add_uv(const Row& row) {
  const Vec2f uv{to_float(row[slot_u]), to_float(row[slot_v])};
  if (std::isfinite(uv.x) && std::isfinite(uv.y)) {
    mesh_.uvs.push_back(uv);
    return;
  }
  uvs_ = false;
  mesh_.uvs = {};
  complaint_about_uvs_ =
      "the uv of vertex " + std::to_string(mesh_.positions.size() - 1) + " is not finite: all uvs are ignored";
}

void VertexRows::warn(Diagnostics& diagnostics) const {
  for (const std::string& complaint : {complaint_about_normals_, complaint_about_uvs_})
    if (!complaint.empty()) diagnostics.warn({mesh_.name}, complaint);
}

}  // namespace alhazen
