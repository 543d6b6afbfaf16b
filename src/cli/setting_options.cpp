#include "cli/setting_options.h"

namespace alhazen {

namespace {

CLI::Option* add(CLI::App& command, Settings& settings, const SettingEntry& entry) {
  std::string flags = "--" + std::string(entry.name);
  if (*entry.other_flags != '\0') flags += "," + std::string(entry.other_flags);
  if (*entry.value_name == '\0')
    return command.add_flag_function(
        flags, [&](int64_t) { entry.set(settings, ""); }, entry.help);
  CLI::Option* option = nullptr;
  if (entry.is_list) {
    const auto set_all = [&](const std::vector<std::string>& texts) {
      for (const std::string& text : texts) entry.set(settings, text);
    };
    option = command.add_option_function<std::vector<std::string>>(flags, set_all, entry.help)
                 ->expected(1)
                 ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  } else {
    option = command.add_option_function<std::string>(
        flags, [&](const std::string& text) { entry.set(settings, text); }, entry.help);
  }
  return option->type_name(entry.value_name);
}

}  // namespace

CLI::Option* add_setting_option(CLI::App& command, Settings& settings, std::string_view name) {
  return add(command, settings, setting_entry(name));
}

void add_setting_options(CLI::App& command, Settings& settings, SettingGroup group, const std::string& heading) {
  for (const SettingEntry& entry : setting_table())
    if (entry.group == group) add(command, settings, entry)->group(heading);
}

}  // namespace alhazen
