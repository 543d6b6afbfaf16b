#include "io/ply/ply.h"

#include "files/byte_source.h"
#include "io/ply/parse_ply.h"

namespace alhazen::impl {

Mesh read_ply(const InputPath& path, Diagnostics& diagnostics, PlyColours colours) {
  FileSource source(path);
  return parse_ply(source, path.name, diagnostics, colours);
}

}  // namespace alhazen::impl
