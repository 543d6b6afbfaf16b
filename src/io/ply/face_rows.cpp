#include "io/ply/face_rows.h"

#include <algorithm>

#include "util/diagnostics.h"

namespace alhazen::impl {

int index_list(const PlyElement& element, const std::string& name) {
  if (element.count == 0) return -1;
  const SourceLocation where{name, element.line};
  int found = -1;
  for (const char* const candidate : {"vertex_indices", "vertex_index"})
    if (found < 0) found = element.find(candidate);
  if (found < 0) throw InputError(where, "element '" + element.name + "' has no list 'vertex_indices'");
  const PlyProperty& property = element.properties[static_cast<size_t>(found)];
  if (!property.is_list) throw InputError(where, "'" + property.name + "' must be a list");
  if (!is_integer(property.type)) throw InputError(where, "'" + property.name + "' must list integers");
  return found;
}

void reserve_triangles(std::vector<uint32_t>& indices, uint64_t rows, uint64_t triangles_of_first, uint64_t bytes,
                       PlyType type) {
  // Each triangle of a fan or a strip takes one more index. Uses doubles: the product of two false counts may overflow.
  const double possible = static_cast<double>(bytes) / static_cast<double>(size_of(type));
  const double promised = static_cast<double>(rows) * static_cast<double>(triangles_of_first);
  const size_t triangles = static_cast<size_t>(std::min(possible, promised));
  indices.reserve(indices.size() + 3 * triangles);
}

}  // namespace alhazen::impl
