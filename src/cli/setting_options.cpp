#include "cli/setting_options.h"

namespace alhazen::impl {

namespace {

CommandOption add(Command& command, Settings& settings, const SettingEntry& entry) {
  std::string flags = "--" + std::string(entry.name);
  if (*entry.other_flags != '\0') flags += "," + std::string(entry.other_flags);
  if (*entry.value_name == '\0')
    return command.add_flag(
        flags, [&] { entry.set(settings, ""); }, entry.help);
  const auto set = [&](const std::string& text) { entry.set(settings, text); };
  CommandOption option = entry.is_list ? command.add_repeatable_option(flags, set, entry.help)
                                       : command.add_option(flags, set, entry.help);
  if (*entry.implied != '\0') option.implied(entry.implied);
  return option.value_name(entry.value_name);
}

}  // namespace

void add_setting_option(Command& command, Settings& settings, std::string_view name) {
  add(command, settings, setting_entry(name));
}

void add_setting_options(Command& command, Settings& settings, SettingGroup group, const std::string& heading) {
  for (const SettingEntry& entry : setting_table())
    if (entry.group == group) {
      CommandOption option = add(command, settings, entry).group(heading);
      if (entry.is_common) option.common();
    }
}

}  // namespace alhazen::impl
