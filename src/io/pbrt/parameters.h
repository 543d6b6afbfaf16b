#pragma once

// The typed parameter lists of directives: `"float fov" [ 40 ]`. A parameter knows its location in the file, and a list
// knows which of its parameters have been looked up.

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/math/vec.h"
#include "io/pbrt/source.h"

namespace alhazen::impl::pbrt {

enum class ParameterType {
  boolean,
  number,
  integer,
  point2,
  vector2,
  point3,
  vector3,
  normal,
  string,
  texture,
  rgb,
  xyz,
  blackbody,
  spectrum,  ///< wavelength and value pairs, or the name of a spectrum
};

/// The name of a type as the format writes it.
std::string_view name_of(ParameterType type);

using Booleans = std::vector<bool>;
using Numbers = std::vector<double>;
/// Integers in two's complement, so that the indices of a mesh are moved without a copy.
using Integers = std::vector<uint32_t>;
using Points2 = std::vector<Vec2f>;
using Points3 = std::vector<Vec3d>;
using Normals = std::vector<Vec3f>;
using Strings = std::vector<std::string>;

struct Parameter {
  ParameterType type = ParameterType::number;
  std::string name;
  std::variant<Numbers, Booleans, Integers, Points2, Points3, Normals, Strings> values;
  std::string rgb_space = "srgb";  ///< for type rgb: the current colour space where the parameter is
  Place place;

  size_t count() const;
};

/// Defaults that `Attribute` sets for subsequent directives.
using InheritedParameters = std::vector<std::shared_ptr<const Parameter>>;

/// The parameters of a directive. Each look-up throws InputError if the parameter has another type or count.
class ParameterList {
 public:
  ParameterList() = default;
  ParameterList(std::string directive, Place place) : directive_(std::move(directive)), place_(std::move(place)) {}

  /// Throws if there is a parameter of that name already.
  void add(Parameter parameter);
  void inherit(const InheritedParameters& defaults) { inherited_ = defaults; }

  /// The directive as it appears in messages: `Shape "sphere"`.
  const std::string& directive() const { return directive_; }
  const Place& place() const { return place_; }
  /// The location of a parameter, or of the directive if it is absent.
  const Place& place_of(std::string_view name) const;
  const std::vector<Parameter>& own() const { return own_; }

  /// Null if it is absent. Counts as a look-up.
  const Parameter* find(std::string_view name);
  const Parameter* find(std::string_view name, std::initializer_list<ParameterType> types);
  bool has(std::string_view name) { return find(name) != nullptr; }

  bool boolean(std::string_view name, bool fallback);
  double number(std::string_view name, double fallback);
  double positive(std::string_view name, double fallback);
  int32_t integer(std::string_view name, int32_t fallback);
  Vec3d point(std::string_view name, const Vec3d& fallback);
  std::string string(std::string_view name, const std::string& fallback);

  // Whole arrays, which are moved out of the list; empty if absent.
  Numbers take_numbers(std::string_view name);
  Integers take_integers(std::string_view name);
  Points2 take_points2(std::string_view name);
  Points3 take_points3(std::string_view name);
  Normals take_normals(std::string_view name);
  Strings take_strings(std::string_view name, ParameterType type = ParameterType::string);

  /// Accepts parameters that pbrt-v4 knows but that have no effect here.
  void ignore(std::initializer_list<std::string_view> names);
  void ignore_all();
  /// Throws for the first parameter that has not been looked up.
  void reject_unknown() const;

 private:
  template <class Values>
  Values take(std::string_view name, ParameterType type);

  std::string directive_;
  Place place_;
  std::vector<Parameter> own_;
  InheritedParameters inherited_;
  std::set<std::string, std::less<>> asked_;
  bool all_ignored_ = false;
};

}  // namespace alhazen::impl::pbrt
