#pragma once

// Parses PLY from any source of bytes.

#include <string>

#include "files/byte_source.h"
#include "io/ply/ply.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// As read_ply (io/ply/ply.h); `name` replaces the file in messages.
Mesh parse_ply(ByteSource& source, const std::string& name, Diagnostics& diagnostics,
               PlyColours colours = PlyColours::none);

}  // namespace alhazen::impl
