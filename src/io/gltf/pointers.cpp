#include "io/gltf/pointers.h"

#include "util/numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

/// Splits a pointer at slashes and decodes ~1 to a slash and ~0 to ~.
std::vector<std::string> tokens_of(const std::string& pointer) {
  std::vector<std::string> tokens;
  for (size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/')
      tokens.emplace_back();
    else if (tokens.empty())
      return {};
    else if (pointer[i] == '~' && i + 1 < pointer.size())
      tokens.back() += pointer[++i] == '1' ? '/' : '~';
    else
      tokens.back() += pointer[i];
  }
  return tokens;
}

/// The member of `parent` with that name; absent optional members are added. Null if there can be none.
Json* step(Json& parent, const std::string& token) {
  if (parent.kind == JsonKind::array) {
    const std::optional<int64_t> index = parse_integer(token);
    if (!index || *index < 0 || static_cast<uint64_t>(*index) >= parent.items.size()) return nullptr;
    return &parent.items[static_cast<size_t>(*index)];
  }
  if (parent.kind == JsonKind::null) parent.kind = JsonKind::object;
  if (parent.kind != JsonKind::object) return nullptr;
  for (size_t i = 0; i < parent.keys.size(); ++i)
    if (parent.keys[i] == token) return &parent.items[i];
  Json member;
  member.line = parent.line;
  member.column = parent.column;
  parent.keys.push_back(token);
  parent.items.push_back(member);
  return &parent.items.back();
}

/// Animatable values are below an item of one of these arrays, and not deep.
bool may_be_animated(const Document& document, const std::vector<std::string>& tokens) {
  if (tokens.size() < 3 || tokens.size() > 16 || document.root().find(tokens[0]) == nullptr) return false;
  for (const char* name : {"nodes", "materials", "meshes", "cameras", "extensions"})
    if (tokens[0] == name) return true;
  return false;
}

void write(Json& value, const std::string& name, const std::vector<double>& numbers) {
  value.items.clear();
  value.keys.clear();
  if (name == "visible" && numbers.size() == 1) {
    value.kind = JsonKind::boolean;
    value.boolean = numbers[0] >= 0.5;
    return;
  }
  if (numbers.size() == 1 && name != "weights") {
    value.kind = JsonKind::number;
    value.number = numbers[0];
    return;
  }
  value.kind = JsonKind::array;
  for (const double number : numbers) {
    Json item;
    item.kind = JsonKind::number;
    item.number = number;
    item.line = value.line;
    item.column = value.column;
    value.items.push_back(item);
  }
}

}  // namespace

void write_pointed_values(Document& document, const std::vector<PointedValue>& values) {
  for (const PointedValue& value : values) {
    const std::vector<std::string> tokens = tokens_of(value.pointer);
    Json* place = may_be_animated(document, tokens) ? &document.mutable_root() : nullptr;
    for (size_t i = 0; i < tokens.size() && place != nullptr; ++i) place = step(*place, tokens[i]);
    if (place == nullptr) {
      document.warn(*value.channel, "the pointer " + quoted(value.pointer) + " of the animation refers to nothing");
      continue;
    }
    write(*place, tokens.back(), value.numbers);
  }
}

}  // namespace alhazen::impl::gltf
