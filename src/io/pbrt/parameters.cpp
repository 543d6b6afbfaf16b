#include "io/pbrt/parameters.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/pbrt/suggestions.h"

namespace alhazen::impl::pbrt {

namespace {

constexpr std::array<std::string_view, 14> type_names{"bool",   "float",   "integer",   "point2",  "vector2",
                                                      "point3", "vector3", "normal",    "string",  "texture",
                                                      "rgb",    "xyz",     "blackbody", "spectrum"};

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

/// Returns the single value of a parameter, or throws.
template <class Values>
typename Values::value_type single(const Parameter& parameter) {
  const auto& values = std::get<Values>(parameter.values);
  if (values.size() != 1)
    fail(parameter.place, in_quotes(parameter.name) + " takes one value, got " + std::to_string(values.size()));
  return values.front();
}

}  // namespace

std::string_view name_of(ParameterType type) { return type_names[static_cast<size_t>(type)]; }

size_t Parameter::count() const {
  return std::visit([](const auto& list) { return list.size(); }, values);
}

void ParameterList::add(Parameter parameter) {
  constexpr size_t limit = 1000;  // the search for duplicates is quadratic
  if (own_.size() == limit) fail(parameter.place, directive_ + " has over 1000 parameters");
  for (const Parameter& other : own_)
    if (other.name == parameter.name)
      fail(parameter.place, in_quotes(parameter.name) + " is given twice for " + directive_ + " (first in line " +
                                std::to_string(other.place.line) + "); remove one");
  own_.push_back(std::move(parameter));
}

const Place& ParameterList::place_of(std::string_view name) const {
  for (const Parameter& parameter : own_)
    if (parameter.name == name) return parameter.place;
  for (auto it = inherited_.rbegin(); it != inherited_.rend(); ++it)
    if ((*it)->name == name) return (*it)->place;
  return place_;
}

const Parameter* ParameterList::find(std::string_view name) {
  if (asked_.find(name) == asked_.end()) asked_.emplace(name);
  for (const Parameter& parameter : own_)
    if (parameter.name == name) return &parameter;
  for (auto it = inherited_.rbegin(); it != inherited_.rend(); ++it)
    if ((*it)->name == name) return it->get();
  return nullptr;
}

const Parameter* ParameterList::find(std::string_view name, std::initializer_list<ParameterType> types) {
  const Parameter* parameter = find(name);
  if (!parameter || std::find(types.begin(), types.end(), parameter->type) != types.end()) return parameter;
  std::string expected;
  for (const ParameterType* type = types.begin(); type != types.end(); ++type) {
    if (type != types.begin()) expected += type + 1 == types.end() ? " or " : ", ";
    expected += name_of(*type);
  }
  fail(parameter->place, in_quotes(name) + " of " + directive_ + ": expected " + expected + ", got " +
                             std::string(name_of(parameter->type)));
}

bool ParameterList::boolean(std::string_view name, bool fallback) {
  const Parameter* parameter = find(name, {ParameterType::boolean});
  return parameter ? single<Booleans>(*parameter) : fallback;
}

double ParameterList::number(std::string_view name, double fallback) {
  const Parameter* parameter = find(name, {ParameterType::number});
  return parameter ? single<Numbers>(*parameter) : fallback;
}

double ParameterList::positive(std::string_view name, double fallback) {
  const double value = number(name, fallback);
  if (!(value > 0)) fail(place_of(name), in_quotes(name) + " of " + directive_ + " must be over 0");
  return value;
}

int32_t ParameterList::integer(std::string_view name, int32_t fallback) {
  const Parameter* parameter = find(name, {ParameterType::integer});
  return parameter ? static_cast<int32_t>(single<Integers>(*parameter)) : fallback;
}

Vec3d ParameterList::point(std::string_view name, const Vec3d& fallback) {
  const Parameter* parameter = find(name, {ParameterType::point3, ParameterType::vector3});
  return parameter ? single<Points3>(*parameter) : fallback;
}

std::string ParameterList::string(std::string_view name, const std::string& fallback) {
  const Parameter* parameter = find(name, {ParameterType::string});
  return parameter ? single<Strings>(*parameter) : fallback;
}

template <class Values>
Values ParameterList::take(std::string_view name, ParameterType type) {
  const Parameter* parameter = find(name, {type});
  if (!parameter) return {};
  for (Parameter& candidate : own_)
    if (&candidate == parameter) return std::exchange(std::get<Values>(candidate.values), {});
  return std::get<Values>(parameter->values);
}

Numbers ParameterList::take_numbers(std::string_view name) { return take<Numbers>(name, ParameterType::number); }
Integers ParameterList::take_integers(std::string_view name) { return take<Integers>(name, ParameterType::integer); }
Points2 ParameterList::take_points2(std::string_view name) { return take<Points2>(name, ParameterType::point2); }
Points3 ParameterList::take_points3(std::string_view name) { return take<Points3>(name, ParameterType::point3); }
Normals ParameterList::take_normals(std::string_view name) { return take<Normals>(name, ParameterType::normal); }
Strings ParameterList::take_strings(std::string_view name, ParameterType type) { return take<Strings>(name, type); }

void ParameterList::ignore(std::initializer_list<std::string_view> names) { asked_.insert(names.begin(), names.end()); }

void ParameterList::ignore_all() { all_ignored_ = true; }

void ParameterList::reject_unknown() const {
  if (all_ignored_) return;
  for (const Parameter& parameter : own_)
    if (!asked_.contains(parameter.name))
      fail(parameter.place,
           "unknown parameter " + in_quotes(parameter.name) + " of " + directive_ + suggestion(parameter.name, asked_));
}

}  // namespace alhazen::impl::pbrt
