#pragma once

// Wavefront OBJ files: polygons, with the names of objects, groups and materials.

#include <string>
#include <vector>

#include "files/byte_source.h"
#include "scene/scene.h"

namespace alhazen::impl::obj {

/// Faces of one object or group with one material. Where a corner has a normal or uv, all corners of the mesh do.
struct Part {
  Mesh mesh;
  std::vector<uint32_t> points;   ///< of each vertex of the mesh, the number of its position in the file
  std::string object, material;   ///< names; may be empty
  SourceLocation where;           ///< its first face
  SourceLocation material_place;  ///< the statement that chose the material
};

/// A statement `mtllib`, whose text is the name of a file or of several.
struct Library {
  std::string text;
  SourceLocation where;
};

struct File {
  std::vector<Part> parts;
  std::vector<Library> libraries;
};

enum class Division {
  none,  ///< names are not used: as few meshes as possible
  named  ///< one mesh for each object and material
};

/// Reads a file. Faces of more than three corners become fans, or are cut by ear clipping if a fan would be wrong.
/// Lines, points, curves and surfaces are omitted with a warning. Throws InputError with line and column: malformed
/// statements, indices out of range, coordinates that are not finite.
File parse_obj(ByteSource& source, const std::string& name, Division division, Diagnostics& diagnostics);
File read_obj(const InputPath& path, Division division, Diagnostics& diagnostics);

}  // namespace alhazen::impl::obj
