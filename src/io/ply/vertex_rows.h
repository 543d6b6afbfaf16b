#pragma once

// Reads the element `vertex`: assigns properties to attributes, and copies values to the mesh.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "io/ply/ply.h"
#include "io/ply/ply_header.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Destinations of the values of a row, in this order, whatever the order in the file.
enum VertexSlot {
  slot_x,
  slot_y,
  slot_z,
  slot_nx,
  slot_ny,
  slot_nz,
  slot_u,
  slot_v,
  slot_red,
  slot_green,
  slot_blue,
  slot_alpha,
  slot_count,
  slot_none
};

struct VertexLayout {
  std::vector<VertexSlot> slots;  ///< of each property of the element
  bool normals = false, uvs = false;
  PlyColours colours = PlyColours::none;
  double colour_unit = 1;  ///< the value of a colour that is 1
};

/// Throws InputError if there are no positions. `colours`: whether they are wanted.
VertexLayout vertex_layout(const PlyElement& element, const std::string& name, PlyColours colours,
                           Diagnostics& diagnostics);

/// Accepts rows in the order of slots. If normals or uvs are unusable, they are dropped for all vertices, with a
/// warning; colours that are not from 0 to 1 are clamped, with one.
class VertexRows {
 public:
  using Row = std::array<double, slot_count>;

  VertexRows(const VertexLayout& layout, uint64_t expected, Mesh& mesh);
  void add(const Row& row);
  void warn(Diagnostics& diagnostics) const;

 private:
  void add_normal(const Row& row);
  void add_uv(const Row& row);
  void add_colour(const Row& row);

  Mesh& mesh_;
  bool normals_, uvs_;
  PlyColours colours_;
  double colour_unit_;
  std::string complaint_about_normals_, complaint_about_uvs_;
  uint64_t clamped_ = 0;  ///< vertices
};

template <class Values>
void read_vertices(Values& values, const PlyElement& element, const VertexLayout& layout, VertexRows& rows) {
  static constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  static constexpr std::array<const char*, 4> colours{"red", "green", "blue", "alpha"};
  VertexRows::Row row{};
  row[slot_alpha] = layout.colour_unit;
  for (uint64_t i = 0; i < element.count; ++i) {
    values.begin_row(element, i);
    for (size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const VertexSlot slot = layout.slots[p];
      if (slot == slot_none) {
        values.skip(property, property.is_list ? values.list_length(property) : 1);
        continue;
      }
      row[slot] = values.real(property);
      if (slot <= slot_z && !std::isfinite(row[slot]))
        values.fail(std::string(axes[slot]) + " is " + std::to_string(row[slot]) + "; coordinates must be finite");
      if (slot >= slot_red && slot <= slot_alpha && !std::isfinite(row[slot]))
        values.fail(std::string(colours[slot - slot_red]) + " is " + std::to_string(row[slot]) +
                    "; colours must be finite");
    }
    values.end_row();
    rows.add(row);
  }
}

}  // namespace alhazen::impl
