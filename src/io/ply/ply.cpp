#include "io/ply/ply.h"

#include "io/ply/byte_source.h"
#include "io/ply/parse_ply.h"

namespace alhazen {

Mesh read_ply(const std::string& path, Diagnostics& diagnostics) {
  FileSource source(path);
  return parse_ply(source, path, diagnostics);
}

}  // namespace alhazen
