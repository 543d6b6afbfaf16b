#include "compile/light_groups.h"

#include <algorithm>
#include <string_view>

#include "core/integrators/light_parts.h"
#include "util/diagnostics.h"
#include "util/quoted.h"
#include "util/suggestion.h"

namespace alhazen::impl {

namespace {

constexpr const char* form =
    "a light group must be NAME=LIGHT or NAME=LIGHT,LIGHT, the name of letters, digits, '_' and '-', for example "
    "key=sun,lamp*";

/// Characters that names of channels may have.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
}

/// The number of bytes of the first character of UTF-8 text.
size_t first_character(std::string_view text) {
  size_t size = 1;
  while (size < text.size() && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) ++size;
  return size;
}

/// Whether a name is that of the pattern, in which * stands for any characters and ? for any one.
bool matches(std::string_view pattern, std::string_view name) {
  std::string_view after_star, rest;  // what to go on with if the last * takes one character more
  bool has_star = false;
  while (!name.empty()) {
    if (!pattern.empty() && pattern[0] == '*') {
      pattern.remove_prefix(1);
      after_star = pattern, rest = name, has_star = true;
    } else if (!pattern.empty() && (pattern[0] == '?' || pattern[0] == name[0])) {
      name.remove_prefix(pattern[0] == '?' ? first_character(name) : 1);
      pattern.remove_prefix(1);
    } else if (has_star) {
      rest.remove_prefix(first_character(rest));
      pattern = after_star, name = rest;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*') == std::string_view::npos;
}

/// The first names, for messages.
std::string some_of(const std::vector<std::string>& names) {
  constexpr size_t most = 12;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + quoted(names[i]);
  return text + (names.size() > most ? " and " + std::to_string(names.size() - most) + " more" : "");
}

uint32_t group_of(const std::string& light, const std::vector<LightGroup>& groups) {
  for (size_t g = 0; g < groups.size(); ++g)
    for (const std::string& pattern : groups[g].patterns)
      if (matches(pattern, light)) return static_cast<uint32_t>(g);
  return static_cast<uint32_t>(groups.size());
}

/// A group for each name, as far as channels can have such names.
GroupedLights group_by_name(const std::vector<std::string>& names, const std::vector<bool>& shines) {
  const auto count = static_cast<size_t>(std::count(shines.begin(), shines.end(), true));
  if (count > max_light_groups)
    throw InputError("the lights have " + std::to_string(count) + " names, and a render tells apart at most " +
                     std::to_string(max_light_groups) + " groups: make groups of them, for example --light-group key=" +
                     names[0] + ". They are " + some_of(names));
  GroupedLights grouped;
  for (size_t i = 0; i < names.size(); ++i) {
    grouped.group_of.push_back(0);
    if (!shines[i]) continue;
    std::string plain = names[i];
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return !is_plain(c); }, '_');
    const std::string base = plain;
    for (int n = 2; std::find(grouped.groups.begin(), grouped.groups.end(), plain) != grouped.groups.end(); ++n)
      plain = base + "_" + std::to_string(n);
    grouped.group_of.back() = static_cast<uint32_t>(grouped.groups.size());
    grouped.groups.push_back(plain);
  }
  return grouped;
}

}  // namespace

std::vector<LightGroup> parse_light_groups(const std::vector<std::string>& texts) {
  std::vector<LightGroup> groups;
  for (const std::string& text : texts) {
    const size_t equals = std::min(text.find('='), text.size());
    LightGroup group{text.substr(0, equals), {}};
    for (size_t begin = equals + 1; begin <= text.size();) {
      const size_t end = std::min(text.find(',', begin), text.size());
      if (begin == end) throw InputError(std::string(form) + ", not " + quoted(text));
      group.patterns.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (group.patterns.empty() || group.name.empty() || !std::all_of(group.name.begin(), group.name.end(), is_plain))
      throw InputError(std::string(form) + ", not " + quoted(text));
    if (group.name == rest_of_lights)
      throw InputError("the light group 'rest' is that of the lights which no other group names: choose another name");
    for (const LightGroup& other : groups)
      if (other.name == group.name)
        throw InputError("there are two light groups '" + group.name + "': give their lights as one, with commas");
    groups.push_back(std::move(group));
  }
  if (groups.size() >= max_light_groups)
    throw InputError("there are " + std::to_string(groups.size()) + " light groups, and there may be " +
                     std::to_string(max_light_groups - 1));
  return groups;
}

GroupedLights group_light_names(const std::vector<std::string>& names, const std::vector<bool>& shines,
                                const std::vector<LightGroup>& groups) {
  if (groups.empty()) return group_by_name(names, shines);
  for (const LightGroup& group : groups)
    for (const std::string& pattern : group.patterns)
      if (std::none_of(names.begin(), names.end(), [&](const std::string& name) { return matches(pattern, name); }))
        throw InputError("no light is called " + quoted(pattern) + ", which the light group '" + group.name +
                         "' names" + suggestion(pattern, names) + ". " +
                         (names.empty() ? "The scene has no lights" : "There are " + some_of(names)));
  GroupedLights grouped;
  for (const LightGroup& group : groups) grouped.groups.push_back(group.name);
  bool has_rest = false;
  for (size_t i = 0; i < names.size(); ++i) {
    grouped.group_of.push_back(group_of(names[i], groups));
    if (grouped.group_of.back() < groups.size()) continue;
    has_rest |= shines[i];
  }
  if (has_rest) grouped.groups.push_back(rest_of_lights);
  return grouped;
}

}  // namespace alhazen::impl
