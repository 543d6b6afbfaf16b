#include "io/ply/parse_ply.h"

#include <algorithm>

#include "io/ply/ascii_values.h"
#include "io/ply/binary_values.h"
#include "io/ply/face_rows.h"
#include "io/ply/ply_header.h"
#include "io/ply/vertex_rows.h"

namespace alhazen::impl {

namespace {

/// The information from the header that the rows need, checked before any of them is read.
struct Plan {
  const PlyElement* vertices = nullptr;
  VertexLayout layout;
  uint64_t plausible_bytes = 0;
};

Plan make_plan(const PlyHeader& header, const std::string& name, uint64_t bytes, PlyColours colours,
               Diagnostics& diagnostics) {
  Plan plan;
  plan.plausible_bytes = bytes;
  plan.vertices = header.find("vertex");
  if (!plan.vertices) throw InputError({name, header.lines}, "the header has no element 'vertex'");
  if (plan.vertices->count >= no_index)
    throw InputError({name, plan.vertices->line},
                     "too many vertices; there can be " + std::to_string(no_index - 1) + " at most");
  plan.layout = vertex_layout(*plan.vertices, name, colours, diagnostics);
  return plan;
}

template <class Values>
void skip_rows(Values& values, const PlyElement& element) {
  // Rows without properties take neither bytes nor lines, so there may be any number of them.
  if (element.properties.empty()) return;
  for (uint64_t i = 0; i < element.count; ++i) {
    values.begin_row(element, i);
    for (const PlyProperty& property : element.properties)
      values.skip(property, property.is_list ? values.list_length(property) : 1);
    values.end_row();
  }
}

template <class Values>
void read_rows(Values values, const PlyHeader& header, const Plan& plan, Mesh& mesh, Diagnostics& diagnostics) {
  const uint64_t vertex_count = plan.vertices->count;
  const uint64_t possible = plan.plausible_bytes / plan.vertices->smallest_row(header.format) + 1;
  Polygons polygons;
  VertexRows vertices(plan.layout, std::min(vertex_count, possible), mesh);
  for (const PlyElement& element : header.elements) {
    if (&element == plan.vertices)
      read_vertices(values, element, plan.layout, vertices);
    else if (element.name == "face" || element.name == "tristrips")
      read_faces(values, element, element.name == "face" ? FaceKind::polygon : FaceKind::strips,
                 index_list(element, mesh.name), vertex_count, plan.plausible_bytes, mesh.indices, polygons);
    else
      skip_rows(values, element);
  }
  polygons.triangulate(mesh);
  vertices.warn(diagnostics);
  values.expect_end(diagnostics);
}

}  // namespace

Mesh parse_ply(ByteSource& source, const std::string& name, Diagnostics& diagnostics, PlyColours colours) {
  InputBuffer input(source);
  const PlyHeader header = read_ply_header(input, name);
  const Plan plan = make_plan(header, name, source.plausible_size(), colours, diagnostics);

  Mesh mesh;
  mesh.name = name;
  switch (header.format) {
    case PlyFormat::ascii:
      read_rows(AsciiValues(input, name, header), header, plan, mesh, diagnostics);
      break;
    case PlyFormat::binary_little_endian:
      read_rows(BinaryValues<std::endian::little>(input, name), header, plan, mesh, diagnostics);
      break;
    case PlyFormat::binary_big_endian:
      read_rows(BinaryValues<std::endian::big>(input, name), header, plan, mesh, diagnostics);
      break;
  }

  if (mesh.indices.empty()) {
    diagnostics.warn({name}, "the mesh has no faces");
    mesh = Mesh();
    mesh.name = name;
  }
  return mesh;
}

}  // namespace alhazen::impl
