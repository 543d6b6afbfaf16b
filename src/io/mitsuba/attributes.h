#pragma once

// The attributes of elements: their texts with parameters replaced, and numbers in them.

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "io/mitsuba/xml.h"

namespace alhazen::impl::mitsuba {

/// The values of $NAME in attributes.
class Definitions {
 public:
  /// `given` are NAME=VALUE of the command line.
  explicit Definitions(const std::vector<std::string>& given);

  /// Sets a value unless there is one.
  void set_default(const std::string& name, const std::string& value) { values_.emplace(name, value); }
  /// Replaces every $NAME, of several names that fit by the longest. Throws InputError for one that is not defined, and
  /// for texts that grow without measure, as values may contain others twice.
  std::string replace(const std::string& text, const Place& place);
  /// Throws InputError if the scene has no use for a value that was given.
  void require_use(const std::string& scene) const;

 private:
  /// Counts a text that has been replaced.
  void count(size_t bytes, const Place& place);

  std::map<std::string, std::string, std::less<>> values_;
  std::set<std::string> given_, used_;
  size_t replaced_bytes_ = 0;  ///< of all texts with $NAME so far
};

/// Throws if the element has other attributes than these, or lacks one whose name begins with '!'.
void check_attributes(const Element& element, std::initializer_list<std::string_view> known);

/// The words of a list; blanks and commas separate them.
std::vector<std::string_view> words_of(std::string_view text);

/// A finite number; `what` names it in the error.
double parse_finite(std::string_view text, const Place& place, const std::string& what);

/// One or three numbers; one stands for all three.
Vec3d parse_three(std::string_view text, const Place& place, const std::string& what);

}  // namespace alhazen::impl::mitsuba
