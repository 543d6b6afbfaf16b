#pragma once

// Reads the elements `face` and `tristrips`: lists of vertex indices, split into triangles.

#include <string>
#include <vector>

#include "geometry/polygons.h"
#include "io/ply/ply_header.h"

namespace alhazen::impl {

/// The index of the property of `element` that lists vertex indices, or -1 if the element is empty. Throws InputError
/// if there is none or it cannot be used.
int index_list(const PlyElement& element, const std::string& name);

/// Reserves memory for `rows` rows with as many triangles as the first, but for no more indices than `bytes` could
/// hold.
void reserve_triangles(std::vector<uint32_t>& indices, uint64_t rows, uint64_t triangles_of_first, uint64_t bytes,
                       PlyType type);

template <class Values>
uint32_t checked_index(Values& values, int64_t index, uint64_t vertex_count) {
  if (index < 0 || static_cast<uint64_t>(index) >= vertex_count)
    values.fail("vertex index " + std::to_string(index) + " is out of range (the file has " +
                std::to_string(vertex_count) + " vertices)");
  return static_cast<uint32_t>(index);
}

/// How a list of indices forms triangles.
enum class FaceKind {
  polygon,  ///< a fan about the first vertex, which Polygons retriangulates if it is wrong
  strips,   ///< each vertex forms a triangle with the two before it; -1 starts the next strip
};

template <class Values>
void read_polygon(Values& values, const PlyProperty& list, uint64_t length, uint64_t vertex_count,
                  std::vector<uint32_t>& indices, Polygons& polygons) {
  if (length < 3) values.fail("a face needs 3 vertices or more, this one has " + std::to_string(length));
  uint32_t first = 0, previous = 0;
  for (uint64_t i = 0; i < length; ++i) {
    const uint32_t index = checked_index(values, values.integer(list), vertex_count);
    if (i == 0) first = index;
    if (i >= 2) indices.insert(indices.end(), {first, previous, index});
    previous = index;
  }
  if (length > 3) polygons.add(indices.size() / 3, length);
}

template <class Values>
void read_strips(Values& values, const PlyProperty& list, uint64_t length, uint64_t vertex_count,
                 std::vector<uint32_t>& indices) {
  uint32_t a = 0, b = 0;
  uint64_t in_strip = 0;
  for (uint64_t i = 0; i < length; ++i) {
    const int64_t raw = values.integer(list);
    if (raw == -1) {
      in_strip = 0;
      continue;
    }
    const uint32_t c = checked_index(values, raw, vertex_count);
    // Every other triangle is reversed so that all have the winding of the first.
    const bool turned = in_strip % 2 == 1;
    if (in_strip >= 2) indices.insert(indices.end(), {turned ? b : a, turned ? a : b, c});
    a = b;
    b = c;
    ++in_strip;
  }
}

/// `list`: the property with the indices. `bytes`: estimate for the whole file.
template <class Values>
void read_faces(Values& values, const PlyElement& element, FaceKind kind, int list, uint64_t vertex_count,
                uint64_t bytes, std::vector<uint32_t>& indices, Polygons& polygons) {
  for (uint64_t i = 0; i < element.count; ++i) {
    values.begin_row(element, i);
    for (size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const uint64_t length = property.is_list ? values.list_length(property) : 1;
      if (static_cast<int>(p) != list) {
        values.skip(property, length);
        continue;
      }
      if (i == 0 && length > 2) reserve_triangles(indices, element.count, length - 2, bytes, property.type);
      if (kind == FaceKind::polygon)
        read_polygon(values, property, length, vertex_count, indices, polygons);
      else
        read_strips(values, property, length, vertex_count, indices);
    }
    values.end_row();
  }
}

}  // namespace alhazen::impl
