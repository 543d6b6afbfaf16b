#include "io/gltf/document.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

constexpr uint32_t json_chunk = 0x4e4f534a, binary_chunk_type = 0x004e4942;

uint32_t little_endian(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t{bytes[at]} | uint32_t{bytes[at + 1]} << 8 | uint32_t{bytes[at + 2]} << 16 |
         uint32_t{bytes[at + 3]} << 24;
}

bool has_binary_header(std::span<const uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

std::string_view text_of(std::span<const uint8_t> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

const std::vector<Json> no_items;

}  // namespace

Document::Document(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder,
                   Diagnostics& diagnostics, const FileSearch& search)
    : path_(path.name),
      folder_(folder),
      scope_(path.scope),
      search_(search),
      is_binary_(has_binary_header(bytes)),
      diagnostics_(diagnostics) {
  if (is_binary_)
    read_container(bytes);
  else
    root_ = parse_json(text_of(bytes), path_);
  if (root_.kind != JsonKind::object) fail(root_, "a glTF file is a JSON object");
  check_version();
}

void Document::read_container(std::span<const uint8_t> bytes) {
  const auto bad = [&](const std::string& message) { throw InputError({path_}, message); };
  if (bytes.size() < 12) bad("the .glb file ends within its header of 12 bytes");
  const uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) bad("the .glb file has version " + std::to_string(version) + "; only version 2 is supported");
  if (length > bytes.size())
    bad("the .glb file is truncated: its header gives " + std::to_string(length) + " bytes and it has " +
        std::to_string(bytes.size()));
  if (length < 12) bad("the length in the header of the .glb file is shorter than the header");
  bool has_json = false;
  for (size_t at = 12; at < length;) {
    if (length - at < 8) bad("the .glb file ends within the header of a chunk");
    const uint32_t size = little_endian(bytes, at), type = little_endian(bytes, at + 4);
    at += 8;
    if (size > length - at)
      bad("a chunk of the .glb file has " + std::to_string(size) + " bytes where " + std::to_string(length - at) +
          " are left");
    const std::span<const uint8_t> chunk = bytes.subspan(at, size);
    if (!has_json) {
      if (type != json_chunk) bad("the first chunk of the .glb file is not JSON");
      root_ = parse_json(text_of(chunk), path_);
      has_json = true;
    } else if (type == binary_chunk_type && !binary_chunk_) {
      binary_chunk_ = chunk;
    } else if (type == json_chunk) {
      bad("the .glb file has more than one JSON chunk");
    }
    at += size;
  }
  if (!has_json) bad("the .glb file has no JSON chunk");
}

void Document::check_version() const {
  const Json* asset = object(root_, "asset");
  if (asset == nullptr) fail(root_, "the file has no \"asset\", so it is not glTF 2.0");
  const std::string version = string(*asset, "version"), minimum = string(*asset, "minVersion");
  if (!version.starts_with("2."))
    fail(*asset, version.empty() ? std::string("\"asset\" has no \"version\"; only glTF 2.0 is supported")
                                 : "the file is glTF " + quoted(version) + "; only glTF 2.0 is supported: convert it");
  if (!minimum.empty() && minimum != "2.0")
    fail(*asset, "the file needs glTF " + quoted(minimum) + "; only glTF 2.0 is supported");
}

void Document::fail(const Json& at, const std::string& message) const { throw InputError(place(at), message); }

const Json* Document::member(const Json& object, const char* key, JsonKind kind, const char* kind_name) const {
  const Json* value = object.find(key);
  if (value != nullptr && value->kind != kind) fail(*value, std::string("\"") + key + "\" must be " + kind_name);
  return value;
}

const std::vector<Json>& Document::array(const char* name) const {
  const Json* items = list(root_, name);
  return items == nullptr ? no_items : items->items;
}

const Json& Document::item(const char* array_name, size_t index) const {
  const Json& value = array(array_name).at(index);
  if (value.kind != JsonKind::object)
    fail(value, "every item of \"" + std::string(array_name) + "\" must be an object");
  return value;
}

const Json* Document::object(const Json& object, const char* key) const {
  return member(object, key, JsonKind::object, "an object");
}

const Json* Document::list(const Json& object, const char* key) const {
  return member(object, key, JsonKind::array, "an array");
}

double Document::number(const Json& object, const char* key, double fallback) const {
  const Json* value = member(object, key, JsonKind::number, "a number");
  return value == nullptr ? fallback : value->number;
}

bool Document::flag(const Json& object, const char* key, bool fallback) const {
  const Json* value = member(object, key, JsonKind::boolean, "true or false");
  return value == nullptr ? fallback : value->boolean;
}

std::string Document::string(const Json& object, const char* key, const std::string& fallback) const {
  const Json* value = member(object, key, JsonKind::string, "a string");
  return value == nullptr ? fallback : value->string;
}

std::optional<uint64_t> Document::whole(const Json& object, const char* key) const {
  const Json* value = member(object, key, JsonKind::number, "a whole number");
  if (value == nullptr) return std::nullopt;
  if (!(value->number >= 0 && value->number <= 0x1p53) || value->number != std::floor(value->number))
    fail(*value, std::string("\"") + key + "\" must be a whole number that is not negative");
  return static_cast<uint64_t>(value->number);
}

uint64_t Document::required_whole(const Json& object, const char* key) const {
  const std::optional<uint64_t> value = whole(object, key);
  if (!value) fail(object, std::string("\"") + key + "\" is missing here");
  return *value;
}

uint32_t Document::as_index(const Json& value, const char* array_name) const {
  const size_t count = array(array_name).size();
  if (value.kind != JsonKind::number || value.number < 0 || value.number != std::floor(value.number))
    fail(value, std::string("an index into \"") + array_name + "\" must be a whole number that is not negative");
  if (value.number >= static_cast<double>(count))
    fail(value, std::string("index out of range: \"") + array_name + "\" has " + std::to_string(count) + " items");
  return static_cast<uint32_t>(value.number);
}

std::optional<uint32_t> Document::index(const Json& object, const char* key, const char* array_name) const {
  const Json* value = object.find(key);
  if (value == nullptr) return std::nullopt;
  return as_index(*value, array_name);
}

uint32_t Document::required_index(const Json& object, const char* key, const char* array_name) const {
  const std::optional<uint32_t> value = index(object, key, array_name);
  if (!value) fail(object, std::string("\"") + key + "\" is missing here");
  return *value;
}

std::vector<double> Document::numbers(const Json& object, const char* key, size_t count) const {
  const Json* values = list(object, key);
  if (values == nullptr) return {};
  if (values->items.size() != count)
    fail(*values, std::string("\"") + key + "\" must have " + std::to_string(count) + " numbers, not " +
                      std::to_string(values->items.size()));
  std::vector<double> result;
  for (const Json& value : values->items) {
    if (value.kind != JsonKind::number) fail(value, std::string("\"") + key + "\" must hold numbers");
    result.push_back(value.number);
  }
  return result;
}

Vec3d Document::vec3(const Json& object, const char* key, const Vec3d& fallback) const {
  const std::vector<double> v = numbers(object, key, 3);
  return v.empty() ? fallback : Vec3d{v[0], v[1], v[2]};
}

const Json* Document::extension(const Json& object, const char* name) const {
  const Json* extensions = this->object(object, "extensions");
  return extensions == nullptr ? nullptr : this->object(*extensions, name);
}

}  // namespace alhazen::impl::gltf
