#pragma once

// Groups of lights, whose shares of the image are layers of their own.

#include <cstdint>
#include <string>
#include <vector>

namespace alhazen::impl {

struct LightGroup {
  std::string name;                   ///< of letters, digits, '_' and '-'
  std::vector<std::string> patterns;  ///< of names of lights, in which * stands for any characters and ? for any one
};

/// The group of what none of the others names.
inline constexpr const char* rest_of_lights = "rest";

/// Parses `NAME=PATTERN,PATTERN`, one text for each group. Throws InputError.
std::vector<LightGroup> parse_light_groups(const std::vector<std::string>& texts);

struct GroupedLights {
  std::vector<std::string> groups;  ///< their names, at most max_light_groups
  std::vector<uint32_t> group_of;   ///< by name: the index of its group
};

/// Gives lights of each of these names the first group one of whose patterns matches it, or else `rest`, which comes
/// last. Without groups, each name is one. `shines`, by name, is false where all lights of that name are black: they
/// may be named, and make no group. Throws InputError if a pattern matches no name, or if there would be more groups
/// than max_light_groups.
GroupedLights group_light_names(const std::vector<std::string>& names, const std::vector<bool>& shines,
                                const std::vector<LightGroup>& groups);

}  // namespace alhazen::impl
