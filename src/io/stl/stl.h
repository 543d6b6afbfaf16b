#pragma once

// STL files, binary and ASCII: triangles, and colours of facets where a binary file has them.

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads a mesh. Equal corners become one vertex; the normals in the file are not used, as facets are flat. Colours are
/// those of the dialects of Magics ("COLOR=" in the header) and of VisCAM. Throws InputError with the file, of ASCII
/// files with line and column, of binary ones with the number of the facet.
Mesh read_stl(const InputPath& path, Diagnostics& diagnostics);

/// The same for bytes in memory; `name` replaces the file in messages.
Mesh parse_stl(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);

}  // namespace alhazen::impl
