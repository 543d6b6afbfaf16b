#include "api/option_names.h"

#include <algorithm>
#include <array>
#include <utility>

#include "render/setting_table.h"

namespace alhazen::impl {

namespace {

/// Options whose fields have other names; of all others, a hyphen is an underscore.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> renamed{
    {{"aov", "aovs"},
     {"light-group", "light_groups"},
     {"denoise", "denoiser"},
     {"spp", "samples_per_pixel"},
     {"size", "width' and 'height"},
     {"crop", "crop_window"},
     {"pixelbounds", "pixel_bounds"},
     {"environment-rotate", "environment_rotation"},
     {"define", "definitions"},
     {"search-path", "search_paths"},
     {"time", "animation_time"},
     {"fps", "frames_per_second"},
     {"cropwindow", "crop_window"},
     {"maxdepth", "max_depth"},
     {"nthreads", "threads"},
     {"tone-map", "tone_mapping"}}};

bool is_name_character(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; }

}  // namespace

std::string field_of_option(std::string_view option) {
  for (const auto& [name, field] : renamed)
    if (name == option) return std::string(field);
  const std::vector<SettingEntry>& table = setting_table();
  if (std::none_of(table.begin(), table.end(), [&](const SettingEntry& entry) { return entry.name == option; }))
    return {};
  std::string field(option);
  std::replace(field.begin(), field.end(), '-', '_');
  return field;
}

std::string with_field_names(const std::string& message) {
  std::string result;
  for (size_t i = 0; i < message.size();) {
    const bool may_begin = i == 0 || message[i - 1] == ' ' || message[i - 1] == '(';
    if (may_begin && message.compare(i, 2, "--") == 0) {
      size_t end = i + 2;
      while (end < message.size() && is_name_character(message[end])) ++end;
      const std::string field = field_of_option(std::string_view(message).substr(i + 2, end - i - 2));
      if (!field.empty()) {
        result += "'" + field + "'";
        i = end;
        continue;
      }
    }
    result += message[i++];
  }
  return result;
}

std::vector<Warning> with_field_names(std::vector<Warning> warnings) {
  for (Warning& warning : warnings) warning.message = with_field_names(warning.message);
  return warnings;
}

}  // namespace alhazen::impl
