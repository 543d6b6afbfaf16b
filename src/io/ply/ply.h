#pragma once

// Stanford PLY files: ascii, binary little-endian and big-endian, gzip-compressed or not.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen {

/// Reads a mesh: element `vertex` with x y z, optionally nx ny nz and (u v | s t | texture_u texture_v |
/// texture_s texture_t), and element `face` with a list of vertex indices (`vertex_indices` or `vertex_index`).
/// Triangles are taken as they are, larger faces are cut into a fan, or by their ears where a fan would leave them.
/// Other elements and properties are skipped.
///
/// Throws InputError with file and, for ascii data and for the header, line and column: unreadable or truncated file,
/// malformed header, no positions, index out of range, coordinate that is NaN or infinite, face of under 3 vertices.
/// The file is streamed: the peak of memory is little more than the mesh that is returned.
Mesh read_ply(const InputPath& path, Diagnostics& diagnostics);

}  // namespace alhazen
