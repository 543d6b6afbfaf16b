#include "io/pbrt/parameter_parser.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/pbrt/suggestions.h"

namespace alhazen::impl::pbrt {

namespace {

struct NamedType {
  std::string_view name;
  ParameterType type;
};

/// Includes the spellings of earlier versions of the format.
constexpr std::array<NamedType, 19> types{{{"bool", ParameterType::boolean},
                                           {"float", ParameterType::number},
                                           {"integer", ParameterType::integer},
                                           {"point2", ParameterType::point2},
                                           {"vector2", ParameterType::vector2},
                                           {"point3", ParameterType::point3},
                                           {"point", ParameterType::point3},
                                           {"vector3", ParameterType::vector3},
                                           {"vector", ParameterType::vector3},
                                           {"normal", ParameterType::normal},
                                           {"normal3", ParameterType::normal},
                                           {"string", ParameterType::string},
                                           {"texture", ParameterType::texture},
                                           {"rgb", ParameterType::rgb},
                                           {"color", ParameterType::rgb},
                                           {"xyz", ParameterType::xyz},
                                           {"blackbody", ParameterType::blackbody},
                                           {"spectrum", ParameterType::spectrum},
                                           {"spd", ParameterType::spectrum}}};

std::optional<ParameterType> type_named(std::string_view name) {
  for (const NamedType& candidate : types)
    if (candidate.name == name) return candidate.type;
  return {};
}

/// Splits `type name` and starts a parameter.
Parameter declared(const Lexer& lexer, const Token& token, const std::string& directive) {
  const std::string text = unquoted(lexer, token);
  const size_t type_begin = text.find_first_not_of(" \t");
  const size_t type_end = text.find_first_of(" \t", type_begin);
  const size_t name_begin = text.find_first_not_of(" \t", type_end);
  if (type_begin == std::string::npos || type_end == std::string::npos || name_begin == std::string::npos)
    fail(lexer.place(token), "expected a parameter as \"type name\" (or the next directive) after " + directive +
                                 ", got " + described(token));
  const std::string type_name = text.substr(type_begin, type_end - type_begin);
  const auto type = type_named(type_name);
  if (!type) {
    std::vector<std::string_view> names;
    for (const NamedType& candidate : types) names.push_back(candidate.name);
    fail(lexer.place(token), "unknown parameter type \"" + type_name + "\"" + suggestion(type_name, names));
  }
  Parameter parameter;
  parameter.type = *type;
  parameter.name = text.substr(name_begin, text.find_first_of(" \t", name_begin) - name_begin);
  parameter.place = lexer.place(token);
  return parameter;
}

/// Calls `read_item` for each item of a bracketed list or for a single item without brackets. `read_item` consumes one
/// item, which may take several tokens.
template <class ReadItem>
void for_each_item(Lexer& lexer, const Parameter& parameter, bool tuple, ReadItem read_item) {
  if (lexer.peek().kind != TokenKind::open_bracket) {
    const TokenKind kind = lexer.peek().kind;
    if (kind != TokenKind::word && kind != TokenKind::string)
      fail(lexer.place(lexer.peek()),
           "expected a value for \"" + parameter.name + "\", got " + described(lexer.peek()));
    if (tuple) fail(lexer.place(lexer.peek()), "the values of \"" + parameter.name + "\" belong in brackets: [ ... ]");
    read_item();
    return;
  }
  const Token open = lexer.next();
  while (lexer.peek().kind != TokenKind::close_bracket) {
    if (lexer.peek().kind == TokenKind::end)
      fail(lexer.place(open), "the list of \"" + parameter.name + "\" is not closed; put a ] at its end");
    if (lexer.peek().kind == TokenKind::open_bracket)
      fail(lexer.place(lexer.peek()), "lists cannot be nested; is a ] missing before?");
    read_item();
  }
  lexer.next();
}

[[noreturn]] void wrong_value(const Lexer& lexer, const Parameter& parameter) {
  fail(lexer.place(lexer.peek()), "\"" + parameter.name + "\": expected " + std::string(name_of(parameter.type)) +
                                      ", got " + described(lexer.peek()));
}

double next_number(Lexer& lexer, const Parameter& parameter) {
  if (lexer.peek().kind != TokenKind::word) wrong_value(lexer, parameter);
  const double value = number_of(lexer, lexer.peek());
  lexer.next();
  return value;
}

/// Reads one number of a tuple; it is an error of the parameter if the list ends within a tuple.
double tuple_number(Lexer& lexer, const Parameter& parameter, const char* size) {
  if (lexer.peek().kind == TokenKind::close_bracket)
    fail(parameter.place, "\"" + parameter.name + "\": the number of values is not a multiple of " + size);
  return next_number(lexer, parameter);
}

/// Normals and texture coordinates are stored in single precision.
float tuple_float(Lexer& lexer, const Parameter& parameter, const char* size) {
  const Place place = lexer.place(lexer.peek());
  const auto value = static_cast<float>(tuple_number(lexer, parameter, size));
  if (!std::isfinite(value)) fail(place, "the number is too large for single precision");
  return value;
}

Numbers read_numbers(Lexer& lexer, const Parameter& parameter) {
  Numbers list;
  for_each_item(lexer, parameter, false, [&] { list.push_back(next_number(lexer, parameter)); });
  return list;
}

Integers read_integers(Lexer& lexer, const Parameter& parameter) {
  Integers list;
  for_each_item(lexer, parameter, false, [&] {
    if (lexer.peek().kind != TokenKind::word) wrong_value(lexer, parameter);
    list.push_back(static_cast<uint32_t>(integer_of(lexer, lexer.peek())));
    lexer.next();
  });
  return list;
}

Points2 read_points2(Lexer& lexer, const Parameter& parameter) {
  Points2 list;
  for_each_item(lexer, parameter, true, [&] {
    const float x = tuple_float(lexer, parameter, "2");
    list.push_back({x, tuple_float(lexer, parameter, "2")});
  });
  return list;
}

Points3 read_points3(Lexer& lexer, const Parameter& parameter) {
  Points3 list;
  for_each_item(lexer, parameter, true, [&] {
    const double x = tuple_number(lexer, parameter, "3"), y = tuple_number(lexer, parameter, "3");
    list.push_back({x, y, tuple_number(lexer, parameter, "3")});
  });
  return list;
}

Normals read_normals(Lexer& lexer, const Parameter& parameter) {
  Normals list;
  for_each_item(lexer, parameter, true, [&] {
    const float x = tuple_float(lexer, parameter, "3"), y = tuple_float(lexer, parameter, "3");
    list.push_back({x, y, tuple_float(lexer, parameter, "3")});
  });
  return list;
}

/// `true` and `false`, also in quotes as in earlier versions.
Booleans read_booleans(Lexer& lexer, const Parameter& parameter) {
  Booleans list;
  for_each_item(lexer, parameter, false, [&] {
    const Token token = lexer.peek();
    const std::string text = token.kind == TokenKind::string ? unquoted(lexer, token) : std::string(token.text);
    if (text != "true" && text != "false") wrong_value(lexer, parameter);
    list.push_back(text == "true");
    lexer.next();
  });
  return list;
}

Strings read_strings(Lexer& lexer, const Parameter& parameter) {
  Strings list;
  for_each_item(lexer, parameter, false, [&] {
    if (lexer.peek().kind != TokenKind::string) wrong_value(lexer, parameter);
    list.push_back(unquoted(lexer, lexer.peek()));
    lexer.next();
  });
  return list;
}

/// Numbers or names; the first item determines which.
void read_spectrum_values(Lexer& lexer, Parameter& parameter) {
  Strings names;
  Numbers numbers;
  for_each_item(lexer, parameter, false, [&] {
    const bool is_name = lexer.peek().kind == TokenKind::string;
    if ((is_name && !numbers.empty()) || (!is_name && !names.empty())) wrong_value(lexer, parameter);
    if (is_name) {
      names.push_back(unquoted(lexer, lexer.peek()));
      lexer.next();
    } else {
      numbers.push_back(next_number(lexer, parameter));
    }
  });
  if (names.empty())
    parameter.values = std::move(numbers);
  else
    parameter.values = std::move(names);
}

void read_values(Lexer& lexer, Parameter& parameter) {
  switch (parameter.type) {
    case ParameterType::boolean:
      parameter.values = read_booleans(lexer, parameter);
      break;
    case ParameterType::integer:
      parameter.values = read_integers(lexer, parameter);
      break;
    case ParameterType::number:
    case ParameterType::rgb:
    case ParameterType::xyz:
    case ParameterType::blackbody:
      parameter.values = read_numbers(lexer, parameter);
      break;
    case ParameterType::point2:
    case ParameterType::vector2:
      parameter.values = read_points2(lexer, parameter);
      break;
    case ParameterType::point3:
    case ParameterType::vector3:
      parameter.values = read_points3(lexer, parameter);
      break;
    case ParameterType::normal:
      parameter.values = read_normals(lexer, parameter);
      break;
    case ParameterType::string:
    case ParameterType::texture:
      parameter.values = read_strings(lexer, parameter);
      break;
    case ParameterType::spectrum:
      read_spectrum_values(lexer, parameter);
      break;
  }
}

}  // namespace

void parse_parameters(Lexer& lexer, const std::string& rgb_space, ParameterList& list) {
  while (lexer.peek().kind == TokenKind::string) {
    const Token declaration = lexer.next();
    Parameter parameter = declared(lexer, declaration, list.directive());
    parameter.rgb_space = rgb_space;
    read_values(lexer, parameter);
    if (parameter.count() == 0) fail(parameter.place, "\"" + parameter.name + "\" has no values");
    list.add(std::move(parameter));
  }
}

}  // namespace alhazen::impl::pbrt
