#include "io/mitsuba/serialized.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace alhazen::impl::mitsuba {

namespace {

enum Flag : uint32_t { has_normals = 1, has_uvs = 2, has_colours = 8, is_flat = 16, is_double = 0x2000 };

[[noreturn]] void damaged(const std::string& name, const std::string& what) { throw InputError({name}, what); }

/// The little-endian number of `count` bytes at `at`. Throws if the file ends before.
uint64_t number_at(std::span<const uint8_t> bytes, uint64_t at, size_t count, const std::string& name) {
  if (at > bytes.size() || bytes.size() - at < count) damaged(name, "the file is truncated");
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value |= uint64_t{bytes[static_cast<size_t>(at) + i]} << (8 * i);
  return value;
}

/// Data compressed by zlib, read bit by bit.
class Inflater {
 public:
  Inflater(std::span<const uint8_t> bytes, const std::string& name) : left_(bytes), name_(name) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  void read(void* into, size_t count) {
    auto* out = static_cast<uint8_t*>(into);
    while (count > 0) {
      constexpr size_t step = size_t{1} << 24;  // zlib counts in 32 bits
      if (stream_.avail_in == 0) {
        const size_t given = std::min(step, left_.size());
        stream_.next_in = const_cast<uint8_t*>(left_.data());  // zlib only reads it
        stream_.avail_in = static_cast<uInt>(given);
        left_ = left_.subspan(given);
      }
      const size_t wanted = std::min(step, count);
      stream_.next_out = out;
      stream_.avail_out = static_cast<uInt>(wanted);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      const size_t got = wanted - stream_.avail_out;
      out += got;
      count -= got;
      if (count == 0) return;
      if (status == Z_MEM_ERROR) throw std::bad_alloc();
      if (status == Z_STREAM_END || (status == Z_BUF_ERROR && left_.empty()))
        damaged(name_, "the mesh is truncated: its counts ask for more data than there are");
      if (status != Z_OK && status != Z_BUF_ERROR) damaged(name_, "the compressed data are damaged");
    }
  }

  template <class Number>
  Number number() {
    Number value{};
    read(&value, sizeof value);
    return value;
  }

 private:
  std::span<const uint8_t> left_;
  const std::string& name_;
  z_stream stream_{};
};

static_assert(std::endian::native == std::endian::little, "the numbers of the file are read as they are");

/// Calls `add` with each row of `columns` numbers. Arrays grow as data arrive, whatever the counts promise.
template <size_t columns, class Add>
void read_rows(Inflater& data, uint64_t count, bool doubles, const Add& add) {
  for (uint64_t row = 0; row < count; ++row) {
    double values[columns];
    for (double& value : values) value = doubles ? data.number<double>() : static_cast<double>(data.number<float>());
    add(values);
  }
}

void read_vertices(Inflater& data, uint64_t count, uint32_t flags, Mesh& mesh) {
  const bool doubles = (flags & is_double) != 0;
  read_rows<3>(data, count, doubles, [&](const double* v) {
    if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
      damaged(mesh.name, "vertex " + std::to_string(mesh.positions.size()) + " has a coordinate that is not finite");
    mesh.positions.push_back({v[0], v[1], v[2]});
  });
  bool normals_are_sound = true;
  if ((flags & has_normals) != 0)
    read_rows<3>(data, count, doubles, [&](const double* v) {
      const Vec3f normal{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
      const float squared = length_squared(normal);
      normals_are_sound = normals_are_sound && squared > 0 && std::isfinite(squared);
      mesh.normals.push_back(normal);
    });
  if (!normals_are_sound) mesh.normals = {};
  bool uvs_are_sound = true;
  if ((flags & has_uvs) != 0)
    read_rows<2>(data, count, doubles, [&](const double* v) {
      const Vec2f uv{static_cast<float>(v[0]), static_cast<float>(v[1])};
      uvs_are_sound = uvs_are_sound && std::isfinite(uv.x) && std::isfinite(uv.y);
      mesh.uvs.push_back(uv);
    });
  if (!uvs_are_sound) mesh.uvs = {};
  if ((flags & has_colours) != 0)
    read_rows<3>(data, count, doubles, [&](const double* v) {
      const auto channel = [](double value) { return static_cast<float>(std::fmin(std::fmax(value, 0), 1e30)); };
      mesh.colours.push_back({channel(v[0]), channel(v[1]), channel(v[2]), 1});
    });
}

uint64_t offset_of(std::span<const uint8_t> bytes, uint64_t index, uint64_t version, const std::string& name) {
  if (index == 0) return 0;
  const uint64_t size = bytes.size(), count = number_at(bytes, size - std::min<uint64_t>(size, 4), 4, name);
  if (index >= count)
    damaged(name, "there is no mesh " + std::to_string(index) + "; the file has " + std::to_string(count) +
                      ", numbered from 0");
  const size_t width = version == 3 ? 4 : 8;
  const uint64_t back = (count - index) * width + 4;
  if (back > size) damaged(name, "the list of meshes at the end of the file is truncated");
  return number_at(bytes, size - back, width, name);
}

}  // namespace

SerializedMesh read_serialized(const InputPath& path, uint64_t index) {
  const std::vector<uint8_t> bytes = InputFile(path).read_all();
  const std::string& name = path.name;
  constexpr uint64_t magic = 0x041c;
  if (number_at(bytes, 0, 2, name) != magic) damaged(name, "this is not a .serialized file of Mitsuba");
  const uint64_t version = number_at(bytes, 2, 2, name);
  if (version != 3 && version != 4)
    damaged(name,
            "version " + std::to_string(version) + " of the format is not supported; 3 and 4 are: save it as PLY");
  const uint64_t offset = offset_of(bytes, index, version, name);
  if (number_at(bytes, offset, 2, name) != magic || number_at(bytes, offset + 2, 2, name) != version)
    damaged(name, "there is no mesh where the list at the end of the file says");
  Inflater data(std::span<const uint8_t>(bytes).subspan(static_cast<size_t>(offset) + 4), name);
  Mesh mesh;
  mesh.name = name;
  const auto flags = data.number<uint32_t>();
  if (version == 4)
    while (data.number<char>() != '\0') {
    }
  const auto vertices = data.number<uint64_t>(), faces = data.number<uint64_t>();
  if (vertices >= no_index) damaged(name, "the mesh has too many vertices for indices of 32 bits");
  read_vertices(data, vertices, flags, mesh);
  for (uint64_t face = 0; face < faces; ++face)
    for (int corner = 0; corner < 3; ++corner) {
      const auto vertex = data.number<uint32_t>();
      if (vertex >= vertices)
        damaged(name, "face " + std::to_string(face) + " has vertex " + std::to_string(vertex) + ", but there are " +
                          std::to_string(vertices));
      mesh.indices.push_back(vertex);
    }
  return {std::move(mesh), (flags & is_flat) != 0};
}

}  // namespace alhazen::impl::mitsuba
