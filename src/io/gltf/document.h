#pragma once

// A glTF document: its JSON, its path, and how members are read. Every function checks the kind and the range of what
// it reads and throws InputError with the location in the file.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "files/input_file.h"
#include "io/find_file.h"
#include "io/gltf/json.h"
#include "util/diagnostics.h"

namespace alhazen::impl::gltf {

class Document {
 public:
  /// `bytes` are those of a .gltf or .glb file and must outlive the document; other files are relative to `folder`.
  Document(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder, Diagnostics& diagnostics,
           const FileSearch& search = {});

  const Json& root() const { return root_; }
  /// Values may be changed as long as nobody holds a reference to one that moves.
  Json& mutable_root() { return root_; }
  const std::string& path() const { return path_; }
  /// For the files that the document refers to.
  const InputScope& scope() const { return scope_; }
  const std::string& folder() const { return folder_; }
  const FileSearch& search() const { return search_; }
  bool is_binary() const { return is_binary_; }
  /// The binary chunk of a .glb file, if there is one.
  const std::optional<std::span<const uint8_t>>& binary_chunk() const { return binary_chunk_; }
  Diagnostics& diagnostics() const { return diagnostics_; }

  SourceLocation place(const Json& at) const { return {path_, at.line, at.column}; }
  [[noreturn]] void fail(const Json& at, const std::string& message) const;
  void warn(const Json& at, const std::string& message) const { diagnostics_.warn(place(at), message); }

  /// The items of an array of the root ("nodes", "meshes", ...); empty if there is none.
  const std::vector<Json>& array(const char* name) const;
  /// Item `index` of such an array, which must be an object.
  const Json& item(const char* array_name, size_t index) const;

  // Members of `object`; absent ones give the fallback, or null.
  const Json* object(const Json& object, const char* key) const;
  const Json* list(const Json& object, const char* key) const;
  double number(const Json& object, const char* key, double fallback) const;
  bool flag(const Json& object, const char* key, bool fallback) const;
  std::string string(const Json& object, const char* key, const std::string& fallback = {}) const;
  /// An integer in [0, 2^53].
  std::optional<uint64_t> whole(const Json& object, const char* key) const;
  uint64_t required_whole(const Json& object, const char* key) const;
  /// An integer below the number of items of the root's array `array_name`.
  std::optional<uint32_t> index(const Json& object, const char* key, const char* array_name) const;
  uint32_t required_index(const Json& object, const char* key, const char* array_name) const;
  /// The same for a value instead of a member.
  uint32_t as_index(const Json& value, const char* array_name) const;
  /// Exactly `count` numbers; empty if absent.
  std::vector<double> numbers(const Json& object, const char* key, size_t count) const;
  Vec3d vec3(const Json& object, const char* key, const Vec3d& fallback) const;
  /// The member `name` of the member "extensions".
  const Json* extension(const Json& object, const char* name) const;

 private:
  void read_container(std::span<const uint8_t> bytes);
  void check_version() const;
  const Json* member(const Json& object, const char* key, JsonKind kind, const char* kind_name) const;

  std::string path_, folder_;
  InputScope scope_;
  FileSearch search_;
  bool is_binary_ = false;
  Diagnostics& diagnostics_;
  Json root_;
  std::optional<std::span<const uint8_t>> binary_chunk_;
};

/// Throws if the file requires an unknown extension; warns of unknown ones that it uses.
void check_extensions(const Document& document);

}  // namespace alhazen::impl::gltf
