#pragma once

// The settings of a render (render/setting_table.h) as options of the command line.

#include <CLI/CLI.hpp>
#include <string_view>

#include "render/setting_table.h"

namespace alhazen {

/// `settings` must outlive the parsing. A bad value throws InputError from there.
CLI::Option* add_setting_option(CLI::App& command, Settings& settings, std::string_view name);

/// All settings of a group, under that heading of the help.
void add_setting_options(CLI::App& command, Settings& settings, SettingGroup group, const std::string& heading);

}  // namespace alhazen
