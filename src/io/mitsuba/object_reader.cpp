#include "io/mitsuba/object_reader.h"

#include <algorithm>
#include <cmath>

#include "util/quoted.h"
#include "util/suggestion.h"

namespace alhazen::impl::mitsuba {

ObjectReader::ObjectReader(const Document& document, uint32_t object)
    : document_(document),
      object_(document.objects[object]),
      index_(object),
      used_(document.objects[object].properties.size(), false) {}

std::string ObjectReader::name() const { return "the " + object_.tag + " " + quoted(object_.type); }

bool ObjectReader::has(std::string_view name) const {
  return std::any_of(object_.properties.begin(), object_.properties.end(),
                     [&](const Property& property) { return property.name == name; });
}

const Place& ObjectReader::place_of(std::string_view name) const {
  for (const Property& property : object_.properties)
    if (property.name == name) return property.place;
  return object_.place;
}

const Property* ObjectReader::find(std::string_view name) {
  asked_.emplace(name);
  for (size_t i = 0; i < used_.size(); ++i)
    if (object_.properties[i].name == name) {
      used_[i] = true;
      return &object_.properties[i];
    }
  return nullptr;
}

const Property* ObjectReader::find(std::string_view name, ValueKind kind, const char* kind_name) {
  const Property* property = find(name);
  const bool is_whole_number = kind == ValueKind::number && property && property->kind == ValueKind::integer;
  if (property && property->kind != kind && !is_whole_number)
    fail(property->place, quoted(name) + " of " + this->name() + " must be <" + kind_name + ">");
  return property;
}

double ObjectReader::number(std::string_view name, double fallback) {
  const Property* property = find(name, ValueKind::number, "float");
  return property ? property->number : fallback;
}

double ObjectReader::positive(std::string_view name, double fallback) {
  const double value = number(name, fallback);
  if (!(value > 0)) fail(place_of(name), quoted(name) + " must be over 0");
  return value;
}

int64_t ObjectReader::integer(std::string_view name, int64_t fallback) {
  const Property* property = find(name, ValueKind::integer, "integer");
  return property ? static_cast<int64_t>(property->number) : fallback;
}

bool ObjectReader::boolean(std::string_view name, bool fallback) {
  const Property* property = find(name, ValueKind::boolean, "boolean");
  return property ? property->boolean : fallback;
}

std::string ObjectReader::text(std::string_view name, const std::string& fallback) {
  const Property* property = find(name, ValueKind::text, "string");
  return property ? property->text : fallback;
}

Vec3d ObjectReader::vector(std::string_view name, const Vec3d& fallback) {
  const Property* property = find(name, ValueKind::vector, "point");
  return property ? property->vector : fallback;
}

Transform ObjectReader::transform(std::string_view name) {
  const Property* property = find(name, ValueKind::transform, "transform");
  return property ? property->transform : Transform();
}

std::vector<const Property*> ObjectReader::objects(std::string_view tag) {
  std::vector<const Property*> found;
  for (size_t i = 0; i < used_.size(); ++i) {
    const Property& property = object_.properties[i];
    if (property.kind != ValueKind::object || document_.objects[property.object].tag != tag) continue;
    used_[i] = true;
    found.push_back(&property);
  }
  return found;
}

void ObjectReader::ignore(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) find(name);
}

void ObjectReader::reject_unknown() const {
  for (size_t i = 0; i < used_.size(); ++i) {
    if (used_[i]) continue;
    const Property& property = object_.properties[i];
    if (property.kind == ValueKind::object && property.name.empty())
      fail(property.place, name() + " takes no " + document_.objects[property.object].tag);
    fail(property.place, name() + " has no parameter " + quoted(property.name) + suggestion(property.name, asked_));
  }
}

}  // namespace alhazen::impl::mitsuba
