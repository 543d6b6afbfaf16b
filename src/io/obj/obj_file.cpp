#include "io/obj/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "geometry/polygons.h"
#include "images/image.h"
#include "io/obj/lines.h"
#include "util/quoted.h"

namespace alhazen::impl::obj {

namespace {

/// A corner of a face: numbers of position, uv and normal, from 0.
using Corner = std::array<uint32_t, 3>;

struct CornerHash {
  size_t operator()(const Corner& corner) const {
    uint64_t hash = 0;
    for (const uint32_t number : corner) hash = (hash ^ number) * 0x9e3779b97f4a7c15u;
    return static_cast<size_t>(hash ^ hash >> 29);
  }
};

/// A part while it is read.
struct OpenPart {
  Part part;
  Polygons polygons;
  std::unordered_map<Corner, uint32_t, CornerHash> vertices;
  bool has_bad_normal = false;
};

const std::set<std::string_view> omitted{"l", "p", "curv", "curv2", "surf", "vp"};
/// Without effect on polygons, or only within what is omitted.
const std::set<std::string_view> without_effect{
    "s",     "cstype", "deg",    "bmat",  "step",     "parm",     "trim", "hole",       "scrv",      "sp",
    "end",   "con",    "mg",     "bevel", "c_interp", "d_interp", "lod",  "shadow_obj", "trace_obj", "ctech",
    "stech", "maplib", "usemap", "cdc",   "cdp",      "bsp",      "bzp",  "res"};

class ObjReader {
 public:
  ObjReader(Lines& lines, Division division, Diagnostics& diagnostics)
      : lines_(lines), division_(division), diagnostics_(diagnostics) {}

  File run() {
    while (lines_.next()) read_statement();
    File file;
    file.libraries = std::move(libraries_);
    for (OpenPart& open : parts_) {
      open.polygons.triangulate(open.part.mesh);
      if (open.has_bad_normal) {
        diagnostics_.warn(open.part.where, "a normal of these faces has no direction: their normals are ignored");
        open.part.mesh.normals = {};
      }
      file.parts.push_back(std::move(open.part));
    }
    return file;
  }

 private:
  void read_statement() {
    const std::string_view keyword = lines_.words()[0].text;
    if (keyword == "v")
      read_position();
    else if (keyword == "vt")
      uvs_.push_back({to_float(1), lines_.words().size() > 2 ? to_float(2) : 0.0f});
    else if (keyword == "vn")
      normals_.push_back({to_float(1), to_float(2), to_float(3)});
    else if (keyword == "f" || keyword == "fo")
      read_face();
    else if (keyword == "o" || keyword == "g")
      set_object();
    else if (keyword == "usemtl")
      set_material();
    else if (keyword == "mtllib")
      libraries_.push_back({std::string(lines_.rest(1)), lines_.place()});
    else if (omitted.contains(keyword))
      diagnostics_.warn(lines_.place(), "points, lines, curves and surfaces of OBJ files are omitted");
    else if (!without_effect.contains(keyword))
      diagnostics_.warn(lines_.place(), "the statement " + quoted(keyword) + " is unknown; it is ignored");
  }

  float to_float(size_t word) const {
    const double value = lines_.number(word);
    if (std::abs(value) > 1e30) lines_.fail(word, quoted(lines_.words()[word].text) + " is too large");
    return static_cast<float>(value);
  }

  void read_position() {
    positions_.push_back({lines_.number(1), lines_.number(2), lines_.number(3)});
    if (positions_.size() >= no_index) lines_.fail(0, "the file has too many vertices for indices of 32 bits");
    // Six numbers are a position and a colour as it is displayed; a fourth alone is a weight.
    const bool has_colour = lines_.words().size() >= 7;
    if (!has_colour && colours_.empty()) return;
    colours_.resize(positions_.size(), {1, 1, 1, 1});
    if (!has_colour) return;
    bool is_clamped = false;
    for (size_t i = 0; i < 3; ++i) {
      const double read = lines_.number(4 + i), value = std::clamp(read, 0.0, 1.0);
      is_clamped = is_clamped || value != read;
      colours_.back()[i] = static_cast<float>(srgb_decode(value));
    }
    if (is_clamped) diagnostics_.warn(lines_.place(), "colours of vertices that are not from 0 to 1 are clamped");
  }

  void set_object() {
    object_ = lines_.rest(1);
    current_ = {};
  }

  void set_material() {
    material_ = lines_.rest(1);
    material_place_ = lines_.place(1);
    current_ = {};
  }

  /// One index of a corner; negative ones count back from the last.
  uint32_t index(std::string_view text, size_t word, size_t count, const char* what) const {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      lines_.fail(word, quoted(lines_.words()[word].text) + " is not a corner of a face: v, v/vt, v//vn or v/vt/vn");
    const int64_t from_zero = value < 0 ? static_cast<int64_t>(count) + value : value - 1;
    if (value == 0 || from_zero < 0 || from_zero >= static_cast<int64_t>(count))
      lines_.fail(word, std::string(what) + " " + std::to_string(value) + " is out of range (" + std::to_string(count) +
                            " are given before this)");
    return static_cast<uint32_t>(from_zero);
  }

  Corner read_corner(size_t word) const {
    std::string_view text = lines_.words()[word].text;
    Corner corner{no_index, no_index, no_index};
    const std::array<size_t, 3> counts{positions_.size(), uvs_.size(), normals_.size()};
    constexpr std::array<const char*, 3> names{"vertex", "texture vertex", "normal"};
    for (size_t i = 0; i < 3; ++i) {
      const size_t slash = text.find('/');
      const std::string_view part = text.substr(0, slash);
      if (!part.empty() || i == 0) corner[i] = index(part, word, counts[i], names[i]);
      if (slash == std::string_view::npos) return corner;
      text.remove_prefix(slash + 1);
    }
    lines_.fail(word, quoted(lines_.words()[word].text) + " has too many numbers: v, v/vt, v//vn or v/vt/vn");
  }

  void read_face() {
    const size_t count = lines_.words().size() - 1;
    if (count < 3) lines_.fail(0, "a face needs 3 corners or more, this one has " + std::to_string(count));
    corners_.clear();
    bool has_uvs = true, has_normals = true;
    for (size_t i = 0; i < count; ++i) {
      corners_.push_back(read_corner(i + 1));
      has_uvs = has_uvs && corners_.back()[1] != no_index;
      has_normals = has_normals && corners_.back()[2] != no_index;
    }
    OpenPart& open = part(has_uvs, has_normals);
    std::vector<uint32_t>& indices = open.part.mesh.indices;
    uint32_t first = 0, previous = 0;
    for (size_t i = 0; i < count; ++i) {
      Corner corner = corners_[i];
      if (!has_uvs) corner[1] = no_index;
      if (!has_normals) corner[2] = no_index;
      const uint32_t vertex = vertex_of(open, corner);
      if (i == 0) first = vertex;
      if (i >= 2) indices.insert(indices.end(), {first, previous, vertex});
      previous = vertex;
    }
    if (count > 3) open.polygons.add(indices.size() / 3, count);
  }

  OpenPart& part(bool has_uvs, bool has_normals) {
    const size_t kind = (has_uvs ? 1u : 0u) + (has_normals ? 2u : 0u);
    if (current_[kind] != 0) return parts_[current_[kind] - 1];
    const bool is_named = division_ == Division::named;
    const auto [entry, is_new] =
        numbers_.try_emplace({is_named ? object_ : "", is_named ? material_ : "", kind}, parts_.size());
    if (is_new) {
      Part& part = parts_.emplace_back().part;
      if (is_named) part.object = object_, part.material = material_;
      part.where = lines_.place();
      part.material_place = material_place_;
      part.mesh.name = lines_.name();
    }
    current_[kind] = entry->second + 1;
    return parts_[entry->second];
  }

  uint32_t vertex_of(OpenPart& open, const Corner& corner) {
    Mesh& mesh = open.part.mesh;
    const auto [entry, is_new] = open.vertices.try_emplace(corner, static_cast<uint32_t>(mesh.positions.size()));
    if (!is_new) return entry->second;
    if (mesh.positions.size() >= no_index) lines_.fail(0, "the file has too many corners for indices of 32 bits");
    mesh.positions.push_back(positions_[corner[0]]);
    open.part.points.push_back(corner[0]);
    if (corner[1] != no_index) mesh.uvs.push_back(uvs_[corner[1]]);
    if (corner[2] != no_index) {
      const Vec3f& normal = normals_[corner[2]];
      const float squared = length_squared(normal);
      if (!(squared > 0) || !std::isfinite(squared)) open.has_bad_normal = true;
      mesh.normals.push_back(normal);
    }
    if (!colours_.empty()) {
      // Vertices before the first that has a colour are white.
      mesh.colours.resize(mesh.positions.size(), {1, 1, 1, 1});
      if (corner[0] < colours_.size()) mesh.colours.back() = colours_[corner[0]];
    }
    return entry->second;
  }

  Lines& lines_;
  Division division_;
  Diagnostics& diagnostics_;
  std::vector<Vec3d> positions_;
  std::vector<std::array<float, 4>> colours_;
  std::vector<Vec2f> uvs_;
  std::vector<Vec3f> normals_;
  std::vector<Corner> corners_;
  std::vector<OpenPart> parts_;
  std::map<std::tuple<std::string, std::string, size_t>, size_t> numbers_;  ///< in `parts_`
  std::array<size_t, 4> current_{};  ///< by kind of corners: 1 + number in `parts_`, or 0
  std::vector<Library> libraries_;
  std::string object_, material_;
  SourceLocation material_place_;
};

}  // namespace

File parse_obj(ByteSource& source, const std::string& name, Division division, Diagnostics& diagnostics) {
  Lines lines(source, name);
  return ObjReader(lines, division, diagnostics).run();
}

File read_obj(const InputPath& path, Division division, Diagnostics& diagnostics) {
  FileSource source(path);
  return parse_obj(source, path.name, division, diagnostics);
}

}  // namespace alhazen::impl::obj
