#pragma once

// The settings of a render (render/setting_table.h) as options of the command line.

#include <string>
#include <string_view>

#include "cli/command.h"
#include "render/setting_table.h"

namespace alhazen::impl {

/// `settings` must outlive the parsing. A bad value throws InputError from there.
void add_setting_option(Command& command, Settings& settings, std::string_view name);

/// All settings of a group, under that heading of the help.
void add_setting_options(Command& command, Settings& settings, SettingGroup group, const std::string& heading);

}  // namespace alhazen::impl
