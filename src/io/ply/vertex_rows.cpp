#include "io/ply/vertex_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "images/image.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

constexpr std::array<const char*, 3> position_names{"x", "y", "z"};
constexpr std::array<const char*, 3> normal_names{"nx", "ny", "nz"};
constexpr std::array<std::array<const char*, 2>, 4> uv_names{
    {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};

constexpr std::array<std::array<const char*, 3>, 2> colour_names{
    {{"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}}};

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

/// The value of a property of that type that stands for 1: integers have the range of the type.
double unit_of(PlyType type) {
  if (!is_integer(type)) return 1;
  const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  return std::ldexp(1.0, 8 * static_cast<int>(size_of(type)) - (is_signed ? 1 : 0)) - 1;
}

void assign_colours(VertexLayout& layout, const PlyElement& element, PlyColours wanted) {
  for (const auto& names : colour_names) {
    if (layout.colours != PlyColours::none || count_scalars(element, names) < names.size()) continue;
    assign(layout, element, names, slot_red);
    const PlyType type = element.properties[static_cast<size_t>(element.find(names[0]))].type;
    layout.colours = is_integer(type) ? wanted : PlyColours::linear;
    layout.colour_unit = unit_of(type);
    const int alpha = element.find("alpha");
    if (alpha >= 0 && has_scalar(element, "alpha") && element.properties[static_cast<size_t>(alpha)].type == type)
      layout.slots[static_cast<size_t>(alpha)] = slot_alpha;
  }
}

/// Converts to float. Doubles beyond its range become infinite, since the conversion itself is undefined for them.
float to_float(double value) {
  constexpr double largest = static_cast<double>(std::numeric_limits<float>::max());
  if (std::abs(value) <= largest) return static_cast<float>(value);
  return std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
}

}  // namespace

VertexLayout vertex_layout(const PlyElement& element, const std::string& name, PlyColours colours,
                           Diagnostics& diagnostics) {
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
  if (colours != PlyColours::none) assign_colours(layout, element, colours);
  return layout;
}

VertexRows::VertexRows(const VertexLayout& layout, uint64_t expected, Mesh& mesh)
    : mesh_(mesh),
      normals_(layout.normals),
      uvs_(layout.uvs),
      colours_(layout.colours),
      colour_unit_(layout.colour_unit) {
  const size_t count = static_cast<size_t>(expected);
  mesh_.positions.reserve(count);
  if (normals_) mesh_.normals.reserve(count);
  if (uvs_) mesh_.uvs.reserve(count);
  if (colours_ != PlyColours::none) mesh_.colours.reserve(count);
}

void VertexRows::add(const Row& row) {
  mesh_.positions.push_back({row[slot_x], row[slot_y], row[slot_z]});
  if (normals_) add_normal(row);
  if (uvs_) add_uv(row);
  if (colours_ != PlyColours::none) add_colour(row);
}

void VertexRows::add_colour(const Row& row) {
  std::array<float, 4> colour{};
  bool is_clamped = false;
  for (size_t i = 0; i < 4; ++i) {
    const double read = row[slot_red + i] / colour_unit_, value = std::clamp(read, 0.0, 1.0);
    is_clamped = is_clamped || value != read;
    colour[i] = static_cast<float>(i < 3 && colours_ == PlyColours::displayed ? srgb_decode(value) : value);
  }
  clamped_ += is_clamped ? 1 : 0;
  mesh_.colours.push_back(colour);
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
  if (clamped_ > 0)
    diagnostics.warn({mesh_.name}, "the colours of " + std::to_string(clamped_) +
                                       (clamped_ == 1 ? " vertex" : " vertices") +
                                       " are not from 0 to 1: they are clamped");
}

}  // namespace alhazen::impl
