#pragma once

// PLY from any source of bytes: the part of read_ply that knows no files.

#include <string>

#include "files/byte_source.h"
#include "scene/scene.h"

namespace alhazen {

/// As read_ply (io/ply/ply.h); `name` stands for the file in messages.
Mesh parse_ply(ByteSource& source, const std::string& name, Diagnostics& diagnostics);

}  // namespace alhazen
