#include "io/mitsuba/attributes.h"

#include <algorithm>
#include <cmath>

#include "util/parse_numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

constexpr size_t max_value_bytes = size_t{1} << 20;
constexpr size_t max_replaced_bytes = size_t{1} << 26;

/// Throws if a text is too long with the values of its parameters.
void limit_value(size_t bytes, const Place& place) {
  if (bytes > max_value_bytes)
    fail(place, "with the values of its parameters ($NAME) an attribute has over 1 MiB; shorten the values");
}

}  // namespace

Definitions::Definitions(const std::vector<std::string>& given) {
  for (const std::string& definition : given) {
    const size_t equals = std::min(definition.find('='), definition.size());
    const std::string name = definition.substr(0, equals);
    if (name.empty() || equals == definition.size())
      throw InputError("the definition " + quoted(definition) + " is not NAME=VALUE");
    values_[name] = definition.substr(equals + 1);
    given_.insert(name);
  }
}

std::string Definitions::replace(const std::string& text, const Place& place) {
  size_t dollar = text.find('$');
  if (dollar == std::string::npos) return text;
  std::string replaced;
  size_t at = 0;
  for (; dollar != std::string::npos; dollar = text.find('$', at)) {
    replaced += text.substr(at, dollar - at);
    const std::string_view rest = std::string_view(text).substr(dollar + 1);
    const auto* best = static_cast<const std::pair<const std::string, std::string>*>(nullptr);
    for (const auto& entry : values_)
      if (rest.starts_with(entry.first) && (best == nullptr || entry.first.size() > best->first.size())) best = &entry;
    if (best == nullptr) {
      const std::string name(rest.substr(0, rest.find_first_of(" ,$")));
      fail(place, "the parameter " + quoted("$" + name) + " has no value: give -D " + printable(name) +
                      "=VALUE, or <default name=\"" + printable(name) + "\" value=\"...\"/> before this");
    }
    used_.insert(best->first);
    replaced += best->second;
    limit_value(replaced.size(), place);
    at = dollar + 1 + best->first.size();
  }
  replaced += text.substr(at);
  count(replaced.size(), place);
  return replaced;
}

void Definitions::count(size_t bytes, const Place& place) {
  limit_value(bytes, place);
  replaced_bytes_ += bytes;
  if (replaced_bytes_ > max_replaced_bytes)
    fail(place, "the attributes with parameters ($NAME) have over 64 MiB in all; use fewer or shorter values");
}

void Definitions::require_use(const std::string& scene) const {
  for (const std::string& name : given_)
    if (!used_.contains(name))
      throw InputError({scene}, "the scene has no " + quoted("$" + name) + ", which a definition gives a value");
}

void check_attributes(const Element& element, std::initializer_list<std::string_view> known) {
  for (const auto& attribute : element.attributes) {
    const std::string& name = attribute.first;
    const auto is_it = [&](std::string_view each) {
      return each == name || (each[0] == '!' && each.substr(1) == name);
    };
    if (!std::any_of(known.begin(), known.end(), is_it))
      fail(element.place, "<" + element.tag + "> has no attribute " + quoted(name));
  }
  for (std::string_view name : known)
    if (name[0] == '!' && element.find(name.substr(1)) == nullptr)
      fail(element.place, "<" + element.tag + "> lacks its attribute '" + std::string(name.substr(1)) + "'");
}

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view separators = " ,\t\r\n";
  std::vector<std::string_view> words;
  for (size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(separators, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return words;
}

double parse_finite(std::string_view text, const Place& place, const std::string& what) {
  const std::vector<std::string_view> words = words_of(text);
  double value = 0;
  if (words.size() != 1 || !parse_number(words[0], value) || !std::isfinite(value))
    fail(place, what + " must be a finite number, not " + quoted(text));
  return value;
}

Vec3d parse_three(std::string_view text, const Place& place, const std::string& what) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 1 && words.size() != 3) fail(place, what + " takes one or three numbers, not " + quoted(text));
  const double first = parse_finite(words[0], place, what);
  if (words.size() == 1) return splat(first);
  return {first, parse_finite(words[1], place, what), parse_finite(words[2], place, what)};
}

}  // namespace alhazen::impl::mitsuba
