#include "io/stl/stl.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <vector>

#include "files/byte_source.h"
#include "images/image.h"
#include "io/obj/lines.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

constexpr size_t header_bytes = 80, facet_bytes = 50;
constexpr size_t max_bytes = size_t{1} << 36;

using Colour = std::array<float, 4>;

/// A corner as its bits and, where facets have colours, that colour's.
struct VertexKey {
  std::array<double, 3> position{};
  uint32_t colour = 0;
  bool operator==(const VertexKey&) const = default;
};

struct VertexHash {
  size_t operator()(const VertexKey& key) const {
    uint64_t hash = key.colour;
    for (const double value : key.position)
      hash = (hash ^ std::bit_cast<uint64_t>(value)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
    return static_cast<size_t>(hash);
  }
};

/// Makes one vertex of equal corners.
class MeshBuilder {
 public:
  explicit MeshBuilder(const std::string& name) { mesh_.name = name; }

  /// `colour`: null if facets have none.
  void add(const Vec3d& position, uint32_t key, const Colour* colour) {
    // Adding zero turns -0 into 0, which is equal to it and has other bits.
    const VertexKey vertex{{position.x + 0.0, position.y + 0.0, position.z + 0.0}, key};
    const auto [entry, is_new] = vertices_.try_emplace(vertex, static_cast<uint32_t>(mesh_.positions.size()));
    if (is_new) {
      if (mesh_.positions.size() >= no_index)
        throw InputError({mesh_.name}, "the file has too many vertices for indices of 32 bits");
      mesh_.positions.push_back(position);
      if (colour) mesh_.colours.push_back(*colour);
    }
    mesh_.indices.push_back(entry->second);
  }
  Mesh finish() { return std::move(mesh_); }

 private:
  Mesh mesh_;
  std::unordered_map<VertexKey, uint32_t, VertexHash> vertices_;
};

uint32_t little_endian(std::string_view bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i)
    value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

/// The colours of facets: 5 bits for each channel, and one that says whether they are meant.
class FacetColours {
 public:
  explicit FacetColours(std::string_view bytes) {
    const std::string_view header = bytes.substr(0, header_bytes);
    const size_t at = header.find("COLOR=");
    is_magics_ = at != std::string_view::npos && at + 10 <= header_bytes;
    if (is_magics_) {
      for (size_t i = 0; i < 4; ++i) default_[i] = decoded(little_endian(header, at + 6 + i, 1) / 255.0);
      default_[3] = 1;
      any_ = true;
    }
    for (size_t at_facet = header_bytes + 4; !any_ && at_facet + facet_bytes <= bytes.size(); at_facet += facet_bytes)
      any_ = (little_endian(bytes, at_facet + 48, 2) & 0x8000u) != 0;
  }
  bool any() const { return any_; }

  /// A number that is equal for equal colours.
  static uint32_t key(uint32_t attribute, bool is_default) { return is_default ? 0x10000u : attribute & 0x7fffu; }
  /// In the dialect of Magics the bit is set for facets of the default colour; in that of VisCAM for those with their
  /// own.
  bool is_default(uint32_t attribute) const { return ((attribute & 0x8000u) != 0) == is_magics_; }
  Colour colour(uint32_t attribute) const {
    if (is_default(attribute)) return default_;
    const auto channel = [&](unsigned shift) { return decoded((attribute >> shift & 31u) / 31.0); };
    // Red is lowest in the dialect of Magics, and highest in that of VisCAM.
    return is_magics_ ? Colour{channel(0), channel(5), channel(10), 1} : Colour{channel(10), channel(5), channel(0), 1};
  }

 private:
  static float decoded(double value) { return static_cast<float>(srgb_decode(value)); }

  bool is_magics_ = false, any_ = false;
  Colour default_{0.5f, 0.5f, 0.5f, 1};
};

Mesh parse_binary(std::string_view bytes, const std::string& name, Diagnostics& diagnostics) {
  if (bytes.size() < header_bytes + 4)
    throw InputError({name}, "the file has " + std::to_string(bytes.size()) +
                                 " bytes; a binary STL file has 84 or more, and an ASCII one begins with 'solid'");
  const uint64_t count = little_endian(bytes, header_bytes, 4);
  const uint64_t wanted = header_bytes + 4 + count * facet_bytes;
  if (bytes.size() < wanted)
    throw InputError({name}, "the file is truncated: its header gives " + std::to_string(count) +
                                 " facets, which take " + std::to_string(wanted) + " bytes, and it has " +
                                 std::to_string(bytes.size()));
  if (bytes.size() > wanted) diagnostics.warn({name}, "there are bytes after the last facet; they are ignored");
  bytes = bytes.substr(0, static_cast<size_t>(wanted));
  const FacetColours colours(bytes);
  MeshBuilder mesh(name);
  for (uint64_t facet = 0; facet < count; ++facet) {
    const size_t at = static_cast<size_t>(header_bytes + 4 + facet * facet_bytes);
    const uint32_t attribute = little_endian(bytes, at + 48, 2);
    const Colour colour = colours.colour(attribute);
    for (size_t corner = 0; corner < 3; ++corner) {
      Vec3d position{};
      for (size_t axis = 0; axis < 3; ++axis) {
        const float value = std::bit_cast<float>(little_endian(bytes, at + 12 + 12 * corner + 4 * axis, 4));
        if (!std::isfinite(value))
          throw InputError({name}, "facet " + std::to_string(facet) + " has a coordinate that is not finite");
        position[static_cast<int>(axis)] = static_cast<double>(value);
      }
      const uint32_t key = colours.any() ? FacetColours::key(attribute, colours.is_default(attribute)) : 0;
      mesh.add(position, key, colours.any() ? &colour : nullptr);
    }
  }
  return mesh.finish();
}

bool is_word(const obj::Lines& lines, size_t word, std::string_view text) {
  if (word >= lines.words().size() || lines.words()[word].text.size() != text.size()) return false;
  const std::string_view found = lines.words()[word].text;
  for (size_t i = 0; i < text.size(); ++i)
    if ((found[i] | 0x20) != text[i]) return false;
  return true;
}

Mesh parse_ascii(std::string_view bytes, const std::string& name) {
  MemorySource source(bytes);
  obj::Lines lines(source, name);
  MeshBuilder mesh(name);
  int corners = -1;  // of the open loop; -1: none is open
  bool is_ended = false;
  while (lines.next()) {
    is_ended = is_word(lines, 0, "endsolid");
    if (is_word(lines, 0, "vertex")) {
      if (corners < 0) lines.fail(0, "'vertex' is outside 'outer loop'");
      if (++corners > 3) lines.fail(0, "a facet has three vertices; this is the fourth");
      mesh.add({lines.number(1), lines.number(2), lines.number(3)}, 0, nullptr);
    } else if (is_word(lines, 0, "outer")) {
      if (corners >= 0) lines.fail(0, "'outer loop' is within another; 'endloop' is missing before it");
      corners = 0;
    } else if (is_word(lines, 0, "endloop")) {
      if (corners != 3)
        lines.fail(0, "a facet has three vertices; this one has " + std::to_string(std::max(corners, 0)));
      corners = -1;
    } else if (!is_word(lines, 0, "facet") && !is_word(lines, 0, "endfacet") && !is_word(lines, 0, "solid") &&
               !is_ended) {
      lines.fail(0, quoted(lines.words()[0].text) +
                        " is not a word of STL: solid, facet, outer loop, vertex, endloop, endfacet, endsolid");
    }
  }
  if (!is_ended) lines.fail(0, "the file ends without 'endsolid'; it is truncated");
  return mesh.finish();
}

/// Some binary files begin with 'solid', too; text has no zero bytes.
bool is_ascii(std::string_view bytes) {
  const size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || !bytes.substr(begin).starts_with("solid")) return false;
  return bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

}  // namespace

Mesh parse_stl(std::string_view bytes, const std::string& name, Diagnostics& diagnostics) {
  Mesh mesh = is_ascii(bytes) ? parse_ascii(bytes, name) : parse_binary(bytes, name, diagnostics);
  if (mesh.indices.empty()) diagnostics.warn({name}, "the mesh has no faces");
  return mesh;
}

Mesh read_stl(const InputPath& path, Diagnostics& diagnostics) {
  FileSource source(path);
  std::string bytes;
  std::vector<char> chunk(size_t{1} << 18);
  while (const size_t count = source.read(chunk.data(), chunk.size())) {
    if (bytes.size() + count > max_bytes) throw InputError({path.name}, "the file has over 64 GiB");
    bytes.append(chunk.data(), count);
  }
  return parse_stl(bytes, path.name, diagnostics);
}

}  // namespace alhazen::impl
