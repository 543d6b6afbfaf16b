#include "io/pbrt/transforms.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "io/pbrt/suggestions.h"

namespace alhazen::impl::pbrt {

namespace {

template <size_t count>
std::array<double, count> read_numbers(Lexer& lexer, const char* directive) {
  std::array<double, count> values{};
  for (size_t i = 0; i < count; ++i) {
    const Token token = lexer.peek();
    if (token.kind != TokenKind::word)
      fail(lexer.place(token), std::string(directive) + " takes " + std::to_string(count) + " numbers, got " +
                                   std::to_string(i) + " and then " + described(token));
    values[i] = number_of(lexer, token);
    lexer.next();
  }
  return values;
}

/// Reads sixteen numbers in brackets, column by column.
Matrix4 read_matrix(Lexer& lexer, const char* directive) {
  if (lexer.peek().kind != TokenKind::open_bracket)
    fail(lexer.place(lexer.peek()),
         std::string(directive) + " takes a matrix [ 16 numbers ], got " + described(lexer.peek()));
  lexer.next();
  const auto values = read_numbers<16>(lexer, directive);
  if (lexer.peek().kind != TokenKind::close_bracket)
    fail(lexer.place(lexer.peek()),
         std::string(directive) + " takes 16 numbers and then ], got " + described(lexer.peek()));
  lexer.next();
  Matrix4 matrix{};
  for (size_t row = 0; row < 4; ++row)
    for (size_t column = 0; column < 4; ++column) matrix[row][column] = values[4 * column + row];
  return matrix;
}

bool is_finite(const Transform& transform) {
  for (const Transform& side : {transform, transform.inverse()})
    for (const auto& row : side.matrix())
      for (const double value : row)
        if (!std::isfinite(value)) return false;
  return true;
}

/// Changes the active ones of the two matrices: `change` maps the old one to the new one.
template <class Change>
void change_active(Build& build, const Place& place, Change change) {
  GraphicsState& state = build.state;
  try {
    if (state.start_active) state.ctm_start = change(state.ctm_start);
    if (state.end_active) state.ctm_end = change(state.ctm_end);
  } catch (const std::domain_error& error) {
    fail(place, std::string("the transformation is not usable: ") + error.what());
  }
  if (!is_finite(state.ctm_start) || !is_finite(state.ctm_end))
    fail(place, "the transformation exceeds double precision; check its scale");
}

}  // namespace

void set_identity(Build& build, Lexer&, const Place& place) {
  change_active(build, place, [](const Transform&) { return Transform(); });
}

void translate(Build& build, Lexer& lexer, const Place& place) {
  const auto v = read_numbers<3>(lexer, "Translate");
  change_active(build, place, [&](const Transform& ctm) { return ctm * Transform::translate({v[0], v[1], v[2]}); });
}

void scale(Build& build, Lexer& lexer, const Place& place) {
  const auto v = read_numbers<3>(lexer, "Scale");
  change_active(build, place, [&](const Transform& ctm) { return ctm * Transform::scale({v[0], v[1], v[2]}); });
}

void rotate(Build& build, Lexer& lexer, const Place& place) {
  const auto v = read_numbers<4>(lexer, "Rotate");
  change_active(build, place, [&](const Transform& ctm) { return ctm * Transform::rotate(v[0], {v[1], v[2], v[3]}); });
}

void look_at(Build& build, Lexer& lexer, const Place& place) {
  const auto v = read_numbers<9>(lexer, "LookAt");
  change_active(build, place, [&](const Transform& ctm) {
    return ctm * Transform::look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
  });
  build.look_at_up = {v[6], v[7], v[8]};
  build.after_look_at = build.state.ctm_start;
}

void set_transform(Build& build, Lexer& lexer, const Place& place) {
  const Matrix4 matrix = read_matrix(lexer, "Transform");
  change_active(build, place, [&](const Transform&) { return Transform(matrix); });
}

void concat_transform(Build& build, Lexer& lexer, const Place& place) {
  const Matrix4 matrix = read_matrix(lexer, "ConcatTransform");
  change_active(build, place, [&](const Transform& ctm) { return ctm * Transform(matrix); });
}

void name_coordinate_system(Build& build, Lexer& lexer, const Place&) {
  build.coordinate_systems[expect_string(lexer, "the name of a coordinate system")] = build.state.ctm();
}

void use_coordinate_system(Build& build, Lexer& lexer, const Place& place) {
  const std::string name = expect_string(lexer, "the name of a coordinate system");
  const auto found = build.coordinate_systems.find(name);
  if (found == build.coordinate_systems.end()) {
    std::vector<std::string> names;
    for (const auto& [known, ctm] : build.coordinate_systems) names.push_back(known);
    fail(place, "coordinate system \"" + name + "\" is not defined" + suggestion(name, names));
  }
  build.state.ctm_start = found->second.start;
  build.state.ctm_end = found->second.end;
}

void set_active_transform(Build& build, Lexer& lexer, const Place&) {
  const Token which = lexer.peek();
  if (which.text != "StartTime" && which.text != "EndTime" && which.text != "All")
    fail(lexer.place(which), "ActiveTransform takes StartTime, EndTime or All, got " + described(which));
  build.state.start_active = which.text != "EndTime";
  build.state.end_active = which.text != "StartTime";
  lexer.next();
}

void set_transform_times(Build& build, Lexer& lexer, const Place& place) {
  const auto v = read_numbers<2>(lexer, "TransformTimes");
  if (!(v[0] < v[1])) fail(place, "TransformTimes takes a start and a later end");
  build.scene.transform_start_time = v[0];
  build.scene.transform_end_time = v[1];
}

}  // namespace alhazen::impl::pbrt
