#pragma once

// Stanford PLY files: ascii, binary little-endian and big-endian, gzip-compressed or not.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// What is done with the colours of vertices: properties red, green and blue, and alpha.
enum class PlyColours {
  none,       ///< they are skipped
  linear,     ///< as they are
  displayed,  ///< integers are encoded as sRGB, as programs that display meshes have them
};

/// Reads a mesh: element `vertex` with x y z, optionally nx ny nz and (u v | s t | texture_u texture_v |
/// texture_s texture_t), and element `face` with a list of vertex indices (`vertex_indices` or `vertex_index`).
/// Triangles are used as they are; larger faces are split into a fan, or by ear clipping if a fan would be wrong.
/// Other elements and properties are skipped.
///
/// Throws InputError with the file, and for ascii data and the header with line and column: unreadable or truncated
/// file, malformed header, missing positions, index out of range, coordinate that is NaN or infinite, face of under 3
/// vertices. The file is streamed: peak memory is little more than the resulting mesh.
Mesh read_ply(const InputPath& path, Diagnostics& diagnostics, PlyColours colours = PlyColours::none);

}  // namespace alhazen::impl
