#pragma once

// Mitsuba's binary meshes, files named .serialized, of versions 3 and 4.

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl::mitsuba {

struct SerializedMesh {
  Mesh mesh;
  bool has_face_normals = false;  ///< it is flat, unless the scene says otherwise
};

/// Reads mesh `index` of the file. Throws InputError with the file: another version, truncated or damaged data, an
/// index out of range.
SerializedMesh read_serialized(const InputPath& path, uint64_t index);

}  // namespace alhazen::impl::mitsuba
