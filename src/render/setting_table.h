#pragma once

// The settings of a render in one table: each has its option's name, its help and its text form once. The command line,
// commands that are printed, the files of tuned engines and the fingerprint of checkpoints come from it.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/alhazen.h"
#include "render/settings.h"

namespace alhazen::impl {

/// Each has a heading of its own in the help (cli/render.cpp).
enum class SettingGroup { output, image, camera, light, scene, animation, engine, running };

struct SettingEntry {
  SettingGroup group;
  const char* name;         ///< of the option, without its dashes; the key in JSON
  const char* other_flags;  ///< with dashes and commas, in front of the name; or empty
  const char* value_name;   ///< what help calls the value; empty: a flag, which is off unless it is given
  std::string help;
  bool is_list = false;  ///< values parted by commas, and may be given more than once
  /// The value as the option takes it; empty where the setting is left open.
  std::function<std::string(const Settings&)> text;
  /// Parses such a text. Throws InputError that names the option and what it may be.
  std::function<void(Settings&, const std::string&)> set;
  /// Of settings that change the values of samples: the value that a render uses, as text. A checkpoint is resumed only
  /// with equal values.
  std::function<std::string(const RenderSettings&)> of_samples = {};
  const char* of_samples_name = "";  ///< what a checkpoint calls it; empty: `name`
  const char* implied = "";          ///< what the option means without a value; empty: it needs one
  bool is_common = false;            ///< --help lists it, not only --help-all
};

const std::vector<SettingEntry>& setting_table();

/// `name` must be in the table.
const SettingEntry& setting_entry(std::string_view name);

/// Throws InputError as `set` of the entry does if the value is none that the option takes: programs check nothing.
void check_setting(const Settings& settings, std::string_view name);

/// The value of one setting as text.
inline std::string setting_text(const Settings& settings, std::string_view name) {
  return setting_entry(name).text(settings);
}

}  // namespace alhazen::impl
