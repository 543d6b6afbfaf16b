#pragma once

// Typed access to the properties of an object. It knows which of them have been looked up.

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "io/mitsuba/document.h"

namespace alhazen::impl::mitsuba {

class ObjectReader {
 public:
  ObjectReader(const Document& document, uint32_t object);

  const Object& object() const { return object_; }
  uint32_t index() const { return index_; }
  const Place& place() const { return object_.place; }
  /// `the bsdf "diffuse"`, for messages.
  std::string name() const;

  bool has(std::string_view name) const;
  /// Where the property is, or the object if there is none.
  const Place& place_of(std::string_view name) const;
  /// The property, which counts as looked up; null if there is none.
  const Property* find(std::string_view name);

  /// Each returns `fallback` if there is no such property, and throws if it has another type.
  double number(std::string_view name, double fallback);
  double positive(std::string_view name, double fallback);
  int64_t integer(std::string_view name, int64_t fallback);
  bool boolean(std::string_view name, bool fallback);
  std::string text(std::string_view name, const std::string& fallback);
  Vec3d vector(std::string_view name, const Vec3d& fallback);
  Transform transform(std::string_view name);

  /// The nested and referenced objects with that tag, which count as looked up.
  std::vector<const Property*> objects(std::string_view tag);

  void ignore(std::initializer_list<std::string_view> names);
  /// Of objects that are replaced.
  void ignore_all() { used_.assign(used_.size(), true); }
  /// Throws for a property that has not been looked up.
  void reject_unknown() const;

 private:
  const Property* find(std::string_view name, ValueKind kind, const char* kind_name);

  const Document& document_;
  const Object& object_;
  uint32_t index_;
  std::vector<bool> used_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace alhazen::impl::mitsuba
